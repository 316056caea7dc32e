// SPDX-License-Identifier: MIT
//
// The policy's probabilities of given sequences, its loss, and back-propagation through time.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "algorithms/expression/column_kernels.hpp"
#include "algorithms/udsr/policy.hpp"
#include "foundation/elementary.hpp"

namespace tribench::udsr {
namespace {

using Eigen::ArrayXXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using ConstMatrix = Eigen::Map<const MatrixXd>;

constexpr Index kWidth = Policy::kHidden;

// Log-softmax of each column; forbidden entries (-inf) stay -inf.
void log_softmax(MatrixXd& logits) {
  for (Index j = 0; j < logits.cols(); ++j) logits.col(j).array() -= logits.col(j).maxCoeff();
  MatrixXd weights = logits;
  columns::exp(weights.data(), weights.data(), static_cast<std::size_t>(weights.size()));
  VectorXd sums = weights.colwise().sum().transpose();
  columns::log(sums.data(), sums.data(), static_cast<std::size_t>(sums.size()));
  logits.rowwise() -= sums.transpose();
}

double entropy_of(const Eigen::Ref<const VectorXd>& log_p, const Eigen::Ref<const VectorXd>& p) {
  double entropy = 0;
  for (Index i = 0; i < log_p.size(); ++i) {
    if (log_p[i] > kForbidden) entropy -= p[i] * log_p[i];
  }
  return entropy;
}

// Places of the sequences, longest first: those that last beyond a step are then the first ones.
std::vector<std::size_t> longest_first(std::span<const Sequence* const> sequences) {
  std::vector<std::size_t> order(sequences.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::ranges::greater{},
                           [&](std::size_t i) { return sequences[i]->size(); });
  return order;
}

void keep_first(MatrixXd& columns, Index count) {
  columns.conservativeResize(Eigen::NoChange, count);
}

// Sequences that end here have no error from later.
void extend_by_zero(MatrixXd& columns, Index count) {
  const Index before = columns.cols();
  columns.conservativeResize(Eigen::NoChange, count);
  columns.rightCols(count - before).setZero();
}

}  // namespace

// One teacher-forced pass over a batch, step by step; columns are the sequences that are as long,
// n of them, longest first.
struct Policy::Unrolled {
  MatrixXd first;                        // 2 kWidth x sequences: hidden, cell
  std::vector<std::vector<int>> parent;  // [step][sequence]: input columns
  std::vector<std::vector<int>> sibling;
  std::vector<MatrixXd> gates;   // activations, 4 kWidth x n
  std::vector<MatrixXd> cell;    // kWidth x n
  std::vector<MatrixXd> hidden;  // kWidth x n
  std::vector<MatrixXd> log_p;   // outputs x n
};

// What flows back through one step: derivatives of the loss, and the loss itself so far.
struct Policy::StepErrors {
  std::vector<const WeightedSequence*> batch;  // longest first
  double gamma = 1;
  double loss = 0;
  MatrixXd hidden;     // kWidth x n
  MatrixXd cell;       // kWidth x n
  MatrixXd recurrent;  // kWidth x 4 kWidth: the recurrent weights, transposed
};

void Policy::unroll(std::span<const Sequence* const> sequences, const MatrixXd& first,
                    const Prior& prior, Unrolled& run) const {
  auto n = static_cast<Index>(sequences.size());
  const std::size_t longest = sequences.empty() ? 0 : sequences.front()->size();
  std::vector<Traversal> traversals(sequences.size(), Traversal(*library_));
  run.first = first;
  MatrixXd hidden = first.topRows(kWidth);
  MatrixXd cell = first.bottomRows(kWidth);
  for (std::size_t t = 0; t < longest; ++t) {
    while (sequences[static_cast<std::size_t>(n - 1)]->size() <= t) --n;
    keep_first(cell, n);
    keep_first(hidden, n);
    MatrixXd gates(4 * kWidth, n);
    std::vector<int> parent;
    std::vector<int> sibling;
    MatrixXd shift = MatrixXd::Zero(shape_.outputs(), n);
    for (std::size_t j = 0; j < static_cast<std::size_t>(n); ++j) {
      const auto column = static_cast<Index>(j);
      parent.push_back(shape_.parent_column(traversals[j].parent()));
      sibling.push_back(shape_.sibling_column(traversals[j].left_sibling()));
      set_gate_input(traversals[j], gates.col(column));
      prior.add_to(traversals[j], {shift.col(column).data(), library_->size()});
      traversals[j].push((*sequences[j])[t]);
    }
    step(gates, cell, hidden);
    MatrixXd log_p = logits(hidden) + shift;
    log_softmax(log_p);
    run.parent.push_back(std::move(parent));
    run.sibling.push_back(std::move(sibling));
    run.gates.push_back(std::move(gates));
    run.cell.push_back(cell);
    run.hidden.push_back(hidden);
    run.log_p.push_back(std::move(log_p));
  }
}

std::vector<double> Policy::log_probabilities(std::span<const Sequence* const> sequences,
                                              const Prior& prior) const {
  const std::vector<std::size_t> order = longest_first(sequences);
  std::vector<const Sequence*> sorted;
  for (const std::size_t i : order) sorted.push_back(sequences[i]);
  Unrolled run;
  unroll(sorted, start_.replicate(1, static_cast<Index>(sorted.size())), prior, run);
  std::vector<double> sums(sequences.size(), 0.0);
  for (std::size_t j = 0; j < sorted.size(); ++j) {
    for (std::size_t t = 0; t < sorted[j]->size(); ++t) {
      sums[order[j]] += run.log_p[t]((*sorted[j])[t], static_cast<Index>(j));
    }
  }
  return sums;
}

// The loss of step t, and its way back through the softmax and the output layer.
void Policy::add_output_gradient(const Unrolled& run, std::size_t t, StepErrors& errors,
                                 VectorXd& gradient) const {
  const PolicyShape::Layout at = shape_.layout();
  Eigen::Map<MatrixXd> d_output(gradient.data() + at.output, shape_.outputs(), kWidth);
  Eigen::Map<VectorXd> d_output_bias(gradient.data() + at.output_bias, shape_.outputs());
  const ConstMatrix output(parameters_.data() + at.output, shape_.outputs(), kWidth);
  const double discount = elementary::pow(errors.gamma, static_cast<double>(t));
  const MatrixXd& log_p = run.log_p[t];
  MatrixXd p(log_p.rows(), log_p.cols());
  columns::exp(log_p.data(), p.data(), static_cast<std::size_t>(p.size()));
  MatrixXd d_logits = MatrixXd::Zero(log_p.rows(), log_p.cols());
  for (Index j = 0; j < log_p.cols(); ++j) {
    const WeightedSequence& item = *errors.batch[static_cast<std::size_t>(j)];
    const TokenId token = (*item.sequence)[t];
    const double entropy = entropy_of(log_p.col(j), p.col(j));
    const double entropy_weight = item.entropy * discount;
    errors.loss -= item.advantage * log_p(token, j) + entropy_weight * entropy;
    for (Index k = 0; k < shape_.outputs(); ++k) {
      if (log_p(k, j) == kForbidden) continue;
      d_logits(k, j) = item.advantage * (p(k, j) - (k == token ? 1.0 : 0.0)) +
                       entropy_weight * p(k, j) * (log_p(k, j) + entropy);
    }
  }
  d_output.noalias() += d_logits * run.hidden[t].transpose();
  d_output_bias += d_logits.rowwise().sum();
  errors.hidden.noalias() += output.transpose() * d_logits;
}

// Back through the cell of step t; leaves the errors of step t - 1.
void Policy::add_cell_gradient(const Unrolled& run, std::size_t t, StepErrors& errors,
                               VectorXd& gradient) const {
  const PolicyShape::Layout at = shape_.layout();
  Eigen::Map<MatrixXd> d_input(gradient.data() + at.input, 4 * kWidth, shape_.inputs());
  Eigen::Map<VectorXd> d_gate_bias(gradient.data() + at.gate_bias, 4 * kWidth);
  const Index n = errors.hidden.cols();
  const MatrixXd& gates = run.gates[t];
  const auto in = gates.topRows(kWidth).array();
  const auto forget = gates.middleRows(kWidth, kWidth).array();
  const auto candidate = gates.middleRows(2 * kWidth, kWidth).array();
  const auto out = gates.bottomRows(kWidth).array();
  MatrixXd tanh_cell = run.cell[t];
  columns::tanh(tanh_cell.data(), tanh_cell.data(), static_cast<std::size_t>(tanh_cell.size()));
  const ArrayXXd previous = t > 0 ? ArrayXXd(run.cell[t - 1].leftCols(n).array())
                                  : ArrayXXd(run.first.bottomRows(kWidth).array());
  errors.cell.array() += errors.hidden.array() * out * (1 - tanh_cell.array().square());
  MatrixXd d_gates(4 * kWidth, n);
  d_gates.topRows(kWidth).array() = errors.cell.array() * candidate * in * (1 - in);
  d_gates.middleRows(kWidth, kWidth).array() =
      errors.cell.array() * previous * forget * (1 - forget);
  d_gates.middleRows(2 * kWidth, kWidth).array() =
      errors.cell.array() * in * (1 - candidate.square());
  d_gates.bottomRows(kWidth).array() = errors.hidden.array() * tanh_cell.array() * out * (1 - out);
  d_gate_bias += d_gates.rowwise().sum();
  for (Index j = 0; j < n; ++j) {
    const auto sequence = static_cast<std::size_t>(j);
    d_input.col(run.parent[t][sequence]) += d_gates.col(j);
    d_input.col(run.sibling[t][sequence]) += d_gates.col(j);
  }
  if (t > 0 || !run.first.isZero(0)) {
    const MatrixXd before = t > 0 ? MatrixXd(run.hidden[t - 1].leftCols(n).transpose())
                                  : MatrixXd(run.first.topRows(kWidth).transpose());
    columns::add_product(d_gates.data(), before.data(), 4 * kWidth, static_cast<std::size_t>(n),
                         kWidth, gradient.data() + at.recurrent);
  }
  errors.hidden.setZero();
  columns::add_product(errors.recurrent.data(), d_gates.data(), kWidth, 4 * kWidth,
                       static_cast<std::size_t>(n), errors.hidden.data());
  errors.cell.array() *= forget;
}

double Policy::loss(std::span<const WeightedSequence> batch, const Prior& prior, double gamma,
                    VectorXd& gradient, MatrixXd* start_gradient) const {
  std::vector<const Sequence*> given;
  for (const WeightedSequence& item : batch) given.push_back(item.sequence);
  StepErrors errors;
  errors.gamma = gamma;
  std::vector<const Sequence*> sequences;
  const std::vector<std::size_t> order = longest_first(given);
  MatrixXd first(2 * kWidth, static_cast<Index>(order.size()));
  for (const std::size_t i : order) {
    first.col(static_cast<Index>(sequences.size())) = batch[i].start ? *batch[i].start : start_;
    errors.batch.push_back(&batch[i]);
    sequences.push_back(given[i]);
  }
  Unrolled run;
  unroll(sequences, first, prior, run);
  const PolicyShape::Layout at = shape_.layout();
  gradient = VectorXd::Zero(at.size);
  errors.hidden.resize(kWidth, 0);
  errors.cell.resize(kWidth, 0);
  errors.recurrent = ConstMatrix(parameters_.data() + at.recurrent, 4 * kWidth, kWidth).transpose();
  for (std::size_t t = run.log_p.size(); t-- > 0;) {
    extend_by_zero(errors.hidden, run.log_p[t].cols());
    extend_by_zero(errors.cell, run.log_p[t].cols());
    add_output_gradient(run, t, errors, gradient);
    add_cell_gradient(run, t, errors, gradient);
  }
  if (start_gradient != nullptr) {
    start_gradient->resize(2 * kWidth, static_cast<Index>(order.size()));
    for (std::size_t j = 0; j < order.size(); ++j) {
      const auto column = static_cast<Index>(order[j]);
      start_gradient->col(column).head(kWidth) = errors.hidden.col(static_cast<Index>(j));
      start_gradient->col(column).tail(kWidth) = errors.cell.col(static_cast<Index>(j));
    }
  }
  return errors.loss;
}

}  // namespace tribench::udsr
