// SPDX-License-Identifier: MIT
//
// The policy: a recurrent network that writes formulas token by token. One LSTM layer over the
// one-hot parent and left sibling of the next place, a linear layer to logits, the prior added
// before the softmax.
//
// Source: Petersen et al. 2021 (DSR), section 3.1; the LSTM of Hochreiter & Schmidhuber 1997 with
// forget bias 1. Gradients are exact back-propagation through time.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "algorithms/udsr/prior.hpp"
#include "algorithms/udsr/token.hpp"
#include "foundation/random.hpp"

namespace tribench::udsr {

// A sequence and what its terms weigh in the loss:
//   loss = sum_i  -advantage_i log p(sequence_i) - entropy_i sum_t gamma^t H(pi_t)
struct WeightedSequence {
  const Sequence* sequence = nullptr;
  double advantage = 0;
  double entropy = 0;
  const Eigen::VectorXd* start = nullptr;  // this sequence's own first state; see begin_from
};

// Where everything lies in the parameters of a policy over these tokens.
class PolicyShape {
 public:
  static constexpr int kHidden = 32;

  explicit PolicyShape(const TokenLibrary& library);

  // Columns of the input layer: operations as parent, then none, tokens as sibling, then none.
  int inputs() const { return operations_ + tokens_ + 2; }
  int outputs() const { return tokens_; }
  int parent_column(int parent) const { return parent >= 0 ? parent : operations_; }
  int sibling_column(int sibling) const {
    return operations_ + 1 + (sibling >= 0 ? sibling : tokens_);
  }

  // The gates are stacked input, forget, cell, output.
  struct Layout {
    Eigen::Index input = 0;      // 4 kHidden x inputs()
    Eigen::Index recurrent = 0;  // 4 kHidden x kHidden
    Eigen::Index gate_bias = 0;  // 4 kHidden
    Eigen::Index output = 0;     // outputs() x kHidden
    Eigen::Index output_bias = 0;
    Eigen::Index size = 0;
  };
  Layout layout() const;

 private:
  int operations_;
  int tokens_;
};

class Policy {
 public:
  static constexpr int kHidden = PolicyShape::kHidden;

  // Recurrent weights start at zero, the output layer Glorot-uniform, as in the original.
  Policy(const TokenLibrary& library, RandomStream random);

  // The state before the first step, for all sequences that bring none of their own: the hidden
  // state, then the cell, 2 kHidden numbers. Zero unless a data encoder says otherwise.
  void begin_from(const Eigen::VectorXd& start) { start_ = start; }

  // Draws `count` sequences; sequence i depends on random.split(i) alone.
  std::vector<Sequence> sample(std::size_t count, const Prior& prior,
                               const RandomStream& random) const;

  // log p of each sequence under the policy and the prior.
  std::vector<double> log_probabilities(std::span<const Sequence* const> sequences,
                                        const Prior& prior) const;

  // The loss above and its gradient with respect to parameters(); start_gradient, where wanted, is
  // that with respect to each sequence's first state, a column each. Cost: O(sum of lengths).
  double loss(std::span<const WeightedSequence> batch, const Prior& prior, double gamma,
              Eigen::VectorXd& gradient, Eigen::MatrixXd* start_gradient = nullptr) const;

  const Eigen::VectorXd& parameters() const { return parameters_; }
  Eigen::VectorXd& parameters() { return parameters_; }
  const TokenLibrary& library() const { return *library_; }

  const PolicyShape& shape() const { return shape_; }

 private:
  struct Unrolled;
  struct StepErrors;
  // first: 2 kHidden x sequences, the states before the first step.
  void unroll(std::span<const Sequence* const> sequences, const Eigen::MatrixXd& first,
              const Prior& prior, Unrolled& run) const;
  // What the place after `traversal` adds to the gates; bias included.
  void set_gate_input(const Traversal& traversal, Eigen::Ref<Eigen::VectorXd> gates) const;
  // gates: their inputs, bias included, on entry; activations on return. Columns are sequences.
  void step(Eigen::MatrixXd& gates, Eigen::MatrixXd& cell, Eigen::MatrixXd& hidden) const;
  Eigen::MatrixXd logits(const Eigen::MatrixXd& hidden) const;
  void add_output_gradient(const Unrolled& run, std::size_t t, StepErrors& errors,
                           Eigen::VectorXd& gradient) const;
  void add_cell_gradient(const Unrolled& run, std::size_t t, StepErrors& errors,
                         Eigen::VectorXd& gradient) const;

  const TokenLibrary* library_;
  PolicyShape shape_;
  Eigen::VectorXd parameters_;
  Eigen::VectorXd start_;
};

// Kingma & Ba 2015, with their defaults.
class Adam {
 public:
  explicit Adam(Eigen::Index size, double learning_rate)
      : learning_rate_(learning_rate),
        mean_(Eigen::VectorXd::Zero(size)),
        square_(Eigen::VectorXd::Zero(size)) {}
  void step(const Eigen::VectorXd& gradient, Eigen::VectorXd& parameters);

 private:
  double learning_rate_;
  Eigen::VectorXd mean_;
  Eigen::VectorXd square_;
  int steps_ = 0;
};

}  // namespace tribench::udsr
