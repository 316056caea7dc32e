// SPDX-License-Identifier: MIT
#include "algorithms/udsr/policy.hpp"

#include <algorithm>
#include <cmath>

namespace tribench::udsr {
namespace {

using Eigen::ArrayXXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using ConstMatrix = Eigen::Map<const MatrixXd>;
using ConstVector = Eigen::Map<const VectorXd>;

constexpr Index kH = Policy::kHidden;

// In place: x -> 1 / (1 + exp(-x)).
void apply_logistic(Eigen::Ref<MatrixXd> x) { x = (1.0 + (-x.array()).exp()).inverse().matrix(); }

// Log-softmax of each column; forbidden entries (-inf) stay -inf.
void log_softmax(MatrixXd& logits) {
  for (Index j = 0; j < logits.cols(); ++j) {
    const double top = logits.col(j).maxCoeff();
    double sum = 0;
    for (Index i = 0; i < logits.rows(); ++i) sum += std::exp(logits(i, j) - top);
    logits.col(j).array() -= top + std::log(sum);
  }
}

double entropy_of(const Eigen::Ref<const VectorXd>& log_p) {
  double entropy = 0;
  for (Index i = 0; i < log_p.size(); ++i) {
    if (log_p[i] > kForbidden) entropy -= std::exp(log_p[i]) * log_p[i];
  }
  return entropy;
}

TokenId draw(const Eigen::Ref<const VectorXd>& log_p, double u) {
  Index last = 0;
  for (Index i = 0; i < log_p.size(); ++i) {
    if (log_p[i] == kForbidden) continue;
    last = i;
    u -= std::exp(log_p[i]);
    if (u < 0) break;
  }
  return static_cast<TokenId>(last);
}

}  // namespace

// One teacher-forced pass over a batch, step by step; columns are sequences.
struct Policy::Unrolled {
  std::vector<std::vector<int>> parent;  // [step][sequence]: input columns
  std::vector<std::vector<int>> sibling;
  std::vector<MatrixXd> gates;   // activations, 4 kH x n
  std::vector<MatrixXd> cell;    // kH x n
  std::vector<MatrixXd> hidden;  // kH x n
  std::vector<MatrixXd> log_p;   // outputs x n
};

Policy::Layout Policy::layout() const {
  Layout at;
  at.recurrent = at.input + 4 * kH * inputs();
  at.gate_bias = at.recurrent + 4 * kH * kH;
  at.output = at.gate_bias + 4 * kH;
  at.output_bias = at.output + outputs() * kH;
  at.size = at.output_bias + outputs();
  return at;
}

Policy::Policy(const TokenLibrary& library, RandomStream random) : library_(&library) {
  const Layout at = layout();
  parameters_ = VectorXd::Zero(at.size);
  parameters_.segment(at.gate_bias + kH, kH).setOnes();  // forget gate
  const double limit = std::sqrt(6.0 / static_cast<double>(kH + outputs()));
  for (Index i = at.output; i < at.output_bias; ++i) parameters_[i] = random.uniform(-limit, limit);
}

int Policy::parent_column(int parent) const {
  return parent >= 0 ? parent : static_cast<int>(library_->operations());
}

int Policy::sibling_column(int sibling) const {
  const int first = static_cast<int>(library_->operations()) + 1;
  return first + (sibling >= 0 ? sibling : static_cast<int>(library_->size()));
}

// gates <- activations; cell and hidden advance by one step.
void Policy::step(const MatrixXd& gate_inputs, MatrixXd& gates, MatrixXd& cell,
                  MatrixXd& hidden) const {
  const Layout at = layout();
  const ConstMatrix recurrent(parameters_.data() + at.recurrent, 4 * kH, kH);
  const ConstVector bias(parameters_.data() + at.gate_bias, 4 * kH);
  gates = gate_inputs;
  gates.noalias() += recurrent * hidden;
  gates.colwise() += bias;
  apply_logistic(gates.topRows(2 * kH));
  gates.middleRows(2 * kH, kH) = gates.middleRows(2 * kH, kH).array().tanh().matrix();
  apply_logistic(gates.bottomRows(kH));
  cell = (gates.middleRows(kH, kH).array() * cell.array() +
          gates.topRows(kH).array() * gates.middleRows(2 * kH, kH).array())
             .matrix();
  hidden = (gates.bottomRows(kH).array() * cell.array().tanh()).matrix();
}

std::vector<Sequence> Policy::sample(std::size_t count, const Prior& prior,
                                     const RandomStream& random) const {
  const Layout at = layout();
  const ConstMatrix input(parameters_.data() + at.input, 4 * kH, inputs());
  const ConstMatrix output(parameters_.data() + at.output, outputs(), kH);
  const ConstVector output_bias(parameters_.data() + at.output_bias, outputs());
  std::vector<Sequence> sequences(count);
  std::vector<Traversal> traversals(count, Traversal(*library_));
  std::vector<RandomStream> streams;
  std::vector<std::size_t> active(count);
  for (std::size_t i = 0; i < count; ++i) {
    streams.push_back(random.split(i));
    active[i] = i;
  }
  MatrixXd cell = MatrixXd::Zero(kH, static_cast<Index>(count));
  MatrixXd hidden = cell;
  MatrixXd gates;
  while (!active.empty()) {
    const auto n = static_cast<Index>(active.size());
    MatrixXd gate_inputs(4 * kH, n);
    for (Index j = 0; j < n; ++j) {
      const Traversal& traversal = traversals[active[static_cast<std::size_t>(j)]];
      gate_inputs.col(j) = input.col(parent_column(traversal.parent())) +
                           input.col(sibling_column(traversal.left_sibling()));
    }
    step(gate_inputs, gates, cell, hidden);
    MatrixXd logits = output * hidden;
    logits.colwise() += output_bias;
    std::size_t kept = 0;
    for (Index j = 0; j < n; ++j) {
      const std::size_t i = active[static_cast<std::size_t>(j)];
      prior.add_to(traversals[i], {logits.col(j).data(), library_->size()});
    }
    log_softmax(logits);
    for (Index j = 0; j < n; ++j) {
      const std::size_t i = active[static_cast<std::size_t>(j)];
      const TokenId token = draw(logits.col(j), streams[i].uniform());
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

void Policy::unroll(std::span<const Sequence* const> sequences, const Prior& prior,
                    Unrolled& run) const {
  const Layout at = layout();
  const ConstMatrix input(parameters_.data() + at.input, 4 * kH, inputs());
  const ConstMatrix output(parameters_.data() + at.output, outputs(), kH);
  const ConstVector output_bias(parameters_.data() + at.output_bias, outputs());
  const auto n = static_cast<Index>(sequences.size());
  std::size_t longest = 0;
  for (const Sequence* sequence : sequences) longest = std::max(longest, sequence->size());
  std::vector<Traversal> traversals(sequences.size(), Traversal(*library_));
  MatrixXd cell = MatrixXd::Zero(kH, n);
  MatrixXd hidden = cell;
  for (std::size_t t = 0; t < longest; ++t) {
    MatrixXd gate_inputs = MatrixXd::Zero(4 * kH, n);
    std::vector<int> parent(sequences.size(), -1);
    std::vector<int> sibling(sequences.size(), -1);
    MatrixXd shift = MatrixXd::Zero(outputs(), n);
    for (std::size_t j = 0; j < sequences.size(); ++j) {
      if (t >= sequences[j]->size()) continue;
      parent[j] = parent_column(traversals[j].parent());
      sibling[j] = sibling_column(traversals[j].left_sibling());
      const auto column = static_cast<Index>(j);
      gate_inputs.col(column) = input.col(parent[j]) + input.col(sibling[j]);
      prior.add_to(traversals[j], {shift.col(column).data(), library_->size()});
      traversals[j].push((*sequences[j])[t]);
    }
    MatrixXd gates;
    step(gate_inputs, gates, cell, hidden);
    MatrixXd logits = output * hidden + shift;
    logits.colwise() += output_bias;
    log_softmax(logits);
    run.parent.push_back(std::move(parent));
    run.sibling.push_back(std::move(sibling));
    run.gates.push_back(std::move(gates));
    run.cell.push_back(cell);
    run.hidden.push_back(hidden);
    run.log_p.push_back(std::move(logits));
  }
}

std::vector<double> Policy::log_probabilities(std::span<const Sequence* const> sequences,
                                              const Prior& prior) const {
  Unrolled run;
  unroll(sequences, prior, run);
  std::vector<double> sums(sequences.size(), 0.0);
  for (std::size_t j = 0; j < sequences.size(); ++j) {
    for (std::size_t t = 0; t < sequences[j]->size(); ++t) {
      sums[j] += run.log_p[t]((*sequences[j])[t], static_cast<Index>(j));
    }
  }
  return sums;
}

double Policy::loss(std::span<const WeightedSequence> batch, const Prior& prior, double gamma,
                    VectorXd& gradient) const {
  std::vector<const Sequence*> sequences;
  for (const WeightedSequence& item : batch) sequences.push_back(item.sequence);
  Unrolled run;
  unroll(sequences, prior, run);

  const Layout at = layout();
  gradient = VectorXd::Zero(at.size);
  Eigen::Map<MatrixXd> d_input(gradient.data() + at.input, 4 * kH, inputs());
  Eigen::Map<MatrixXd> d_recurrent(gradient.data() + at.recurrent, 4 * kH, kH);
  Eigen::Map<VectorXd> d_gate_bias(gradient.data() + at.gate_bias, 4 * kH);
  Eigen::Map<MatrixXd> d_output(gradient.data() + at.output, outputs(), kH);
  Eigen::Map<VectorXd> d_output_bias(gradient.data() + at.output_bias, outputs());
  const ConstMatrix recurrent(parameters_.data() + at.recurrent, 4 * kH, kH);
  const ConstMatrix output(parameters_.data() + at.output, outputs(), kH);

  const auto n = static_cast<Index>(batch.size());
  double total = 0;
  MatrixXd d_hidden = MatrixXd::Zero(kH, n);
  MatrixXd d_cell = MatrixXd::Zero(kH, n);
  for (std::size_t t = run.log_p.size(); t-- > 0;) {
    const double discount = std::pow(gamma, static_cast<double>(t));
    MatrixXd d_logits = MatrixXd::Zero(outputs(), n);
    for (Index j = 0; j < n; ++j) {
      const WeightedSequence& item = batch[static_cast<std::size_t>(j)];
      if (t >= item.sequence->size()) continue;
      const auto log_p = run.log_p[t].col(j);
      const TokenId token = (*item.sequence)[t];
      const double entropy = entropy_of(log_p);
      const double entropy_weight = item.entropy * discount;
      total -= item.advantage * log_p[token] + entropy_weight * entropy;
      for (Index k = 0; k < outputs(); ++k) {
        if (log_p[k] == kForbidden) continue;
        const double p = std::exp(log_p[k]);
        d_logits(k, j) = item.advantage * (p - (k == token ? 1.0 : 0.0)) +
                         entropy_weight * p * (log_p[k] + entropy);
      }
    }
    d_output.noalias() += d_logits * run.hidden[t].transpose();
    d_output_bias += d_logits.rowwise().sum();
    d_hidden.noalias() += output.transpose() * d_logits;

    const MatrixXd& gates = run.gates[t];
    const ArrayXXd in = gates.topRows(kH).array();
    const ArrayXXd forget = gates.middleRows(kH, kH).array();
    const ArrayXXd candidate = gates.middleRows(2 * kH, kH).array();
    const ArrayXXd out = gates.bottomRows(kH).array();
    const ArrayXXd tanh_cell = run.cell[t].array().tanh();
    const ArrayXXd previous = t > 0 ? run.cell[t - 1].array() : ArrayXXd(ArrayXXd::Zero(kH, n));
    d_cell.array() += d_hidden.array() * out * (1 - tanh_cell.square());
    MatrixXd d_gates(4 * kH, n);
    d_gates.topRows(kH) = (d_cell.array() * candidate * in * (1 - in)).matrix();
    d_gates.middleRows(kH, kH) = (d_cell.array() * previous * forget * (1 - forget)).matrix();
    d_gates.middleRows(2 * kH, kH) = (d_cell.array() * in * (1 - candidate.square())).matrix();
    d_gates.bottomRows(kH) = (d_hidden.array() * tanh_cell * out * (1 - out)).matrix();
    d_gate_bias += d_gates.rowwise().sum();
    for (Index j = 0; j < n; ++j) {
      const auto sequence = static_cast<std::size_t>(j);
      if (run.parent[t][sequence] < 0) continue;
      d_input.col(run.parent[t][sequence]) += d_gates.col(j);
      d_input.col(run.sibling[t][sequence]) += d_gates.col(j);
    }
    if (t > 0) d_recurrent.noalias() += d_gates * run.hidden[t - 1].transpose();
    d_hidden.noalias() = recurrent.transpose() * d_gates;
    d_cell = (d_cell.array() * forget).matrix();
  }
  return total;
}

void Adam::step(const VectorXd& gradient, VectorXd& parameters) {
  constexpr double kMeanDecay = 0.9;
  constexpr double kSquareDecay = 0.999;
  constexpr double kEpsilon = 1e-8;
  ++steps_;
  mean_ = kMeanDecay * mean_ + (1 - kMeanDecay) * gradient;
  square_ = kSquareDecay * square_ + (1 - kSquareDecay) * gradient.cwiseAbs2();
  const double mean_scale = 1 / (1 - std::pow(kMeanDecay, steps_));
  const double square_scale = 1 / (1 - std::pow(kSquareDecay, steps_));
  parameters.array() -= learning_rate_ * (mean_scale * mean_.array()) /
                        ((square_scale * square_.array()).sqrt() + kEpsilon);
}

}  // namespace tribench::udsr
