// SPDX-License-Identifier: MIT
//
// A problem's rows as the policy's first state: what the policy writes first may then depend on the
// data, before it has been rewarded for anything. A set encoder: one layer on every row, the mean
// over rows, one linear layer. The order of the rows does not matter.
//
//   z = mean_r tanh(A x_r + a)        x_r: standardised inputs and target, zero beyond the inputs
//   (hidden, cell) = B z + b          the LSTM's state before its first step
//
// Source: deep sets, Zaheer et al. 2017, eq. 2. That pre-training may condition on the data is in
// Landajuela et al. 2022, section 3.4, where the encoder is a set transformer; ours is a thousand
// parameters. An option, off by default: README.md says what it is worth.
#pragma once

#include <Eigen/Core>
#include <span>

#include "algorithms/expression/evaluate.hpp"
#include "foundation/random.hpp"

namespace tribench::udsr {

class DataEncoder {
 public:
  static constexpr int kInputs = 8;  // further inputs are not seen
  static constexpr int kFeatures = kInputs + 1;
  static constexpr int kUnits = 16;
  static constexpr int kMostRows = 200;  // spread evenly where there are more

  // B and b start at zero: an untrained encoder changes nothing.
  explicit DataEncoder(RandomStream random);

  // kFeatures x rows. Inputs over their largest magnitude, so that signs and zero keep their
  // places; the target less its mean over its deviation. All values are to be finite.
  static Eigen::MatrixXd features(const Inputs& inputs, std::span<const double> target);

  // 2 Policy::kHidden numbers: the hidden state, then the cell.
  Eigen::VectorXd encode(const Eigen::MatrixXd& features) const;

  // Adds the gradient of a loss whose derivative with respect to encode(features) is given.
  void add_gradient(const Eigen::MatrixXd& features, const Eigen::VectorXd& d_state,
                    Eigen::VectorXd& gradient) const;

  const Eigen::VectorXd& parameters() const { return parameters_; }
  Eigen::VectorXd& parameters() { return parameters_; }
  static Eigen::Index size();

 private:
  Eigen::MatrixXd activations(const Eigen::MatrixXd& features) const;

  Eigen::VectorXd parameters_;  // A, a, B, b, each column by column
};

}  // namespace tribench::udsr
