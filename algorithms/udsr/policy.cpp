// SPDX-License-Identifier: MIT
#include "algorithms/udsr/policy.hpp"

#include <algorithm>
#include <cmath>

#include "algorithms/expression/column_kernels.hpp"
#include "foundation/elementary.hpp"

namespace tribench::udsr {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using ConstMatrix = Eigen::Map<const MatrixXd>;
using ConstVector = Eigen::Map<const VectorXd>;

constexpr Index kH = Policy::kHidden;

void apply_tanh(MatrixXd& x) {
  columns::tanh(x.data(), x.data(), static_cast<std::size_t>(x.size()));
}

// weights: unnormalised probabilities; u in [0, 1).
TokenId draw(const Eigen::Ref<const VectorXd>& weights, double u) {
  double left = u * weights.sum();
  Index last = 0;
  for (Index i = 0; i < weights.size(); ++i) {
    if (weights[i] == 0) continue;
    last = i;
    left -= weights[i];
    if (left < 0) break;
  }
  return static_cast<TokenId>(last);
}

}  // namespace

PolicyShape::PolicyShape(const TokenLibrary& library)
    : operations_(static_cast<int>(library.operations())),
      tokens_(static_cast<int>(library.size())) {}

PolicyShape::Layout PolicyShape::layout() const {
  Layout at;
  at.recurrent = at.input + 4 * kH * inputs();
  at.gate_bias = at.recurrent + 4 * kH * kH;
  at.output = at.gate_bias + 4 * kH;
  at.output_bias = at.output + outputs() * kH;
  at.size = at.output_bias + outputs();
  return at;
}

Policy::Policy(const TokenLibrary& library, RandomStream random)
    : library_(&library), shape_(library), start_(VectorXd::Zero(2 * kH)) {
  const PolicyShape::Layout at = shape_.layout();
  parameters_ = VectorXd::Zero(at.size);
  parameters_.segment(at.gate_bias + kH, kH).setOnes();  // forget gate
  const double limit = std::sqrt(6.0 / static_cast<double>(kH + shape_.outputs()));
  for (Index i = at.output; i < at.output_bias; ++i) parameters_[i] = random.uniform(-limit, limit);
}

void Policy::set_gate_input(const Traversal& traversal, Eigen::Ref<VectorXd> gates) const {
  const PolicyShape::Layout at = shape_.layout();
  const ConstMatrix input(parameters_.data() + at.input, 4 * kH, shape_.inputs());
  const ConstVector bias(parameters_.data() + at.gate_bias, 4 * kH);
  gates = bias + input.col(shape_.parent_column(traversal.parent())) +
          input.col(shape_.sibling_column(traversal.left_sibling()));
}

void Policy::step(MatrixXd& gates, MatrixXd& cell, MatrixXd& hidden) const {
  columns::add_product(parameters_.data() + shape_.layout().recurrent, hidden.data(), 4 * kH, kH,
                       static_cast<std::size_t>(hidden.cols()), gates.data());
  // The logistic function of x is (1 + tanh(x / 2)) / 2: one pass serves all four gates.
  gates.topRows(2 * kH) *= 0.5;
  gates.bottomRows(kH) *= 0.5;
  apply_tanh(gates);
  gates.topRows(2 * kH).array() = 0.5 + 0.5 * gates.topRows(2 * kH).array();
  gates.bottomRows(kH).array() = 0.5 + 0.5 * gates.bottomRows(kH).array();
  cell = (gates.middleRows(kH, kH).array() * cell.array() +
          gates.topRows(kH).array() * gates.middleRows(2 * kH, kH).array())
             .matrix();
  hidden = cell;
  apply_tanh(hidden);
  hidden.array() *= gates.bottomRows(kH).array();
}

MatrixXd Policy::logits(const MatrixXd& hidden) const {
  const PolicyShape::Layout at = shape_.layout();
  const ConstMatrix output(parameters_.data() + at.output, shape_.outputs(), kH);
  const ConstVector bias(parameters_.data() + at.output_bias, shape_.outputs());
  MatrixXd result = bias.replicate(1, hidden.cols());
  result.noalias() += output * hidden;
  return result;
}

std::vector<Sequence> Policy::sample(std::size_t count, const Prior& prior,
                                     const RandomStream& random) const {
  std::vector<Sequence> sequences(count);
  std::vector<Traversal> traversals(count, Traversal(*library_));
  std::vector<RandomStream> streams;
  std::vector<std::size_t> active(count);
  for (std::size_t i = 0; i < count; ++i) {
    streams.push_back(random.split(i));
    active[i] = i;
  }
  MatrixXd hidden = start_.head(kH).replicate(1, static_cast<Index>(count));
  MatrixXd cell = start_.tail(kH).replicate(1, static_cast<Index>(count));
  while (!active.empty()) {
    const auto n = static_cast<Index>(active.size());
    MatrixXd gates(4 * kH, n);
    for (Index j = 0; j < n; ++j) {
      set_gate_input(traversals[active[static_cast<std::size_t>(j)]], gates.col(j));
    }
    step(gates, cell, hidden);
    MatrixXd weights = logits(hidden);
    for (Index j = 0; j < n; ++j) {
      const std::size_t i = active[static_cast<std::size_t>(j)];
      prior.add_to(traversals[i], {weights.col(j).data(), library_->size()});
      weights.col(j).array() -= weights.col(j).maxCoeff();
    }
    columns::exp(weights.data(), weights.data(), static_cast<std::size_t>(weights.size()));
    std::size_t kept = 0;
    for (Index j = 0; j < n; ++j) {
      const std::size_t i = active[static_cast<std::size_t>(j)];
      const TokenId token = draw(weights.col(j), streams[i].uniform());
      sequences[i].push_back(token);
      traversals[i].push(token);
      if (traversals[i].complete()) continue;
      active[kept] = i;
      cell.col(static_cast<Index>(kept)) = cell.col(j);
      hidden.col(static_cast<Index>(kept)) = hidden.col(j);
      ++kept;
    }
    active.resize(kept);
    cell.conservativeResize(Eigen::NoChange, static_cast<Index>(kept));
    hidden.conservativeResize(Eigen::NoChange, static_cast<Index>(kept));
  }
  return sequences;
}

void Adam::step(const VectorXd& gradient, VectorXd& parameters) {
  constexpr double kMeanDecay = 0.9;
  constexpr double kSquareDecay = 0.999;
  constexpr double kEpsilon = 1e-8;
  ++steps_;
  mean_ = kMeanDecay * mean_ + (1 - kMeanDecay) * gradient;
  square_ = kSquareDecay * square_ + (1 - kSquareDecay) * gradient.cwiseAbs2();
  const double mean_scale = 1 / (1 - elementary::pow(kMeanDecay, steps_));
  const double square_scale = 1 / (1 - elementary::pow(kSquareDecay, steps_));
  parameters.array() -= learning_rate_ * (mean_scale * mean_.array()) /
                        ((square_scale * square_.array()).sqrt() + kEpsilon);
}

}  // namespace tribench::udsr
