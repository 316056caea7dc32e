// SPDX-License-Identifier: MIT
#include "algorithms/udsr/data_encoder.hpp"

#include <algorithm>
#include <cmath>

#include "algorithms/expression/column_kernels.hpp"
#include "algorithms/udsr/policy.hpp"

namespace tribench::udsr {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using ConstMatrix = Eigen::Map<const MatrixXd>;
using ConstVector = Eigen::Map<const VectorXd>;

constexpr Index kState = 2 * Policy::kHidden;
constexpr Index kFeatures = DataEncoder::kFeatures;
constexpr Index kUnits = DataEncoder::kUnits;

// Where each block lies in the parameters.
constexpr Index kRowBias = kUnits * kFeatures;
constexpr Index kOutput = kRowBias + kUnits;
constexpr Index kOutputBias = kOutput + kState * kUnits;
constexpr Index kSize = kOutputBias + kState;

}  // namespace

Index DataEncoder::size() { return kSize; }

DataEncoder::DataEncoder(RandomStream random) : parameters_(VectorXd::Zero(kSize)) {
  // Wider than Glorot's: of a row the layer sees nine numbers, most of them zero.
  for (Index i = 0; i < kOutput; ++i) parameters_[i] = random.normal();
}

MatrixXd DataEncoder::features(const Inputs& inputs, std::span<const double> target) {
  const std::size_t rows = target.size();
  const std::size_t kept = std::min<std::size_t>(rows, kMostRows);
  MatrixXd result = MatrixXd::Zero(kFeatures, static_cast<Index>(kept));
  const auto row = [&](std::size_t k) { return k * rows / kept; };
  const std::size_t seen = std::min<std::size_t>(inputs.columns.size(), kInputs);
  for (std::size_t j = 0; j < seen; ++j) {
    double largest = 0;
    for (std::size_t r = 0; r < rows; ++r) {
      largest = std::max(largest, std::abs(inputs.columns[j][r]));
    }
    if (!(largest > 0)) continue;
    for (std::size_t k = 0; k < kept; ++k) {
      result(static_cast<Index>(j), static_cast<Index>(k)) = inputs.columns[j][row(k)] / largest;
    }
  }
  double mean = 0;
  for (const double y : target) mean += y / static_cast<double>(rows);
  double variance = 0;
  for (const double y : target) variance += (y - mean) * (y - mean) / static_cast<double>(rows);
  if (!(variance > 0)) return result;
  const double deviation = std::sqrt(variance);
  for (std::size_t k = 0; k < kept; ++k) {
    result(kInputs, static_cast<Index>(k)) = (target[row(k)] - mean) / deviation;
  }
  return result;
}

MatrixXd DataEncoder::activations(const MatrixXd& features) const {
  const ConstMatrix a(parameters_.data(), kUnits, kFeatures);
  const ConstVector bias(parameters_.data() + kRowBias, kUnits);
  MatrixXd result = bias.replicate(1, features.cols());
  result.noalias() += a * features;
  columns::tanh(result.data(), result.data(), static_cast<std::size_t>(result.size()));
  return result;
}

VectorXd DataEncoder::encode(const MatrixXd& features) const {
  const ConstMatrix b(parameters_.data() + kOutput, kState, kUnits);
  const ConstVector bias(parameters_.data() + kOutputBias, kState);
  if (features.cols() == 0) return bias;
  return bias + b * activations(features).rowwise().mean();
}

void DataEncoder::add_gradient(const MatrixXd& features, const VectorXd& d_state,
                               VectorXd& gradient) const {
  Eigen::Map<VectorXd>(gradient.data() + kOutputBias, kState) += d_state;
  if (features.cols() == 0) return;
  const MatrixXd active = activations(features);
  const VectorXd mean = active.rowwise().mean();
  const ConstMatrix b(parameters_.data() + kOutput, kState, kUnits);
  Eigen::Map<MatrixXd>(gradient.data() + kOutput, kState, kUnits).noalias() +=
      d_state * mean.transpose();
  const VectorXd d_mean = b.transpose() * d_state / static_cast<double>(features.cols());
  const MatrixXd d_rows = ((1 - active.array().square()).colwise() * d_mean.array()).matrix();
  Eigen::Map<MatrixXd>(gradient.data(), kUnits, kFeatures).noalias() +=
      d_rows * features.transpose();
  Eigen::Map<VectorXd>(gradient.data() + kRowBias, kUnits) += d_rows.rowwise().sum();
}

}  // namespace tribench::udsr
