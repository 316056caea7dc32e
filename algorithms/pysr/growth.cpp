// SPDX-License-Identifier: MIT
#include "algorithms/pysr/growth.hpp"

#include <algorithm>
#include <cmath>

#include "algorithms/expression/column_kernels.hpp"
#include "algorithms/fitting/cholesky.hpp"
#include "algorithms/pysr/simplify.hpp"
#include "algorithms/pysr/tape_edit.hpp"

namespace tribench::pysr {
namespace {

// A direction that keeps less than this share of its square outside J is no new one.
constexpr double kDependent = 1e-8;

bool is_sum(Op op) { return op == Op::add || op == Op::sub || op == Op::neg; }
bool is_product(Op op) { return op == Op::mul || op == Op::div || op == Op::neg; }

void remove_projection(std::span<double> vector, std::span<const double> unit) {
  const double along = columns::dot(vector.data(), unit.data(), vector.size());
  for (std::size_t r = 0; r < vector.size(); ++r) vector[r] -= along * unit[r];
}

double square_of(std::span<const double> vector) {
  return columns::dot(vector.data(), vector.data(), vector.size());
}

Expression constant_of(double value) { return Expression::constant(value); }

}  // namespace

std::vector<Grower::Probe> Grower::probes_of(const Expression& formula) const {
  std::vector<Probe> probes;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (is_exponent(formula, i)) continue;
    const Node& node = formula.node(i);
    const std::size_t parent = parent_of(formula, i);
    const bool is_root = parent == formula.size();
    // A sum is grown as a whole, not each of its parts; so is a product.
    const bool additive = is_root || !is_sum(formula.node(parent).op);
    const bool multiplicative =
        !node.is_constant() && (is_root || !is_product(formula.node(parent).op));
    if (additive || multiplicative) probes.push_back({i, additive, multiplicative});
  }
  return probes;
}

bool Grower::differentiate(const Expression& formula, std::span<const Probe> probes,
                           const Rows& rows, Budget& budget) {
  // Each probed value x becomes x * 1 + 0; the derivatives with respect to these two constants are
  // the value times the adjoint, and the adjoint.
  std::vector<Node> tape;
  std::vector<std::size_t> wanted;
  std::vector<std::size_t> probed;
  std::size_t next = 0;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (formula.node(i).is_constant() && !is_exponent(formula, i)) wanted.push_back(tape.size());
    tape.push_back(formula.node(i));
    if (next < probes.size() && probes[next].place == i) {
      tape.push_back(Node::constant(1));
      probed.push_back(tape.size() - 1);
      tape.push_back({0, 1, 0, Op::mul});
      tape.push_back(Node::constant(0));
      probed.push_back(tape.size() - 1);
      tape.push_back({0, 1, 0, Op::add});
      ++next;
    }
  }
  constants_ = wanted.size();
  wanted.insert(wanted.end(), probed.begin(), probed.end());
  const Expression augmented(std::move(tape));
  // Three passes for all derivatives, one for what is done with them.
  if (!budget.spend(4 * node_rows(augmented, rows.size()))) return false;
  differentiator_.prepare(augmented, wanted);
  jacobian_.resize(wanted.size() * rows.size());
  residual_.resize(rows.size());
  differentiator_.jacobian(rows.inputs(), residual_, jacobian_);
  columns::sub(rows.target.data(), residual_.data(), residual_.data(), rows.size());
  return std::isfinite(square_of(residual_));
}

void Grower::orthonormalise(std::size_t rows) {
  basis_.resize(constants_ * rows);
  basis_size_ = 0;
  for (std::size_t k = 0; k < constants_; ++k) {
    const std::span<double> unit = std::span(basis_).subspan(basis_size_ * rows, rows);
    std::ranges::copy(column(k, rows), unit.begin());
    const double before = square_of(unit);
    for (std::size_t b = 0; b < basis_size_; ++b) {
      remove_projection(unit, std::span(basis_).subspan(b * rows, rows));
    }
    const double after = square_of(unit);
    if (!std::isfinite(after) || !(after > kDependent * before)) continue;
    columns::mul(unit.data(), 1 / std::sqrt(after), unit.data(), rows);
    ++basis_size_;
    remove_projection(residual_, unit);
  }
}

Grower::Candidate Grower::rate(const Expression&, std::size_t probe, std::size_t term,
                               bool multiplicative, std::size_t rows) {
  const std::span<const double> slope =
      column(constants_ + 2 * probe + (multiplicative ? 0 : 1), rows);
  direction_.resize(rows);
  columns::mul(slope.data(), library_->terms[term].values.data(), direction_.data(), rows);
  const double before = square_of(direction_);
  for (std::size_t b = 0; b < basis_size_; ++b) {
    remove_projection(direction_, std::span(basis_).subspan(b * rows, rows));
  }
  const double after = square_of(direction_);
  if (!std::isfinite(after) || !(after > kDependent * before))
    return {probe, term, multiplicative, 0, 0};
  const double along = columns::dot(direction_.data(), residual_.data(), rows);
  return {probe, term, multiplicative, along / after, along * along / after};
}

void Grower::build(const Expression& formula, const Candidate& candidate,
                   std::span<const Probe> probes, std::vector<Proposal>& proposals) const {
  const std::size_t place = probes[candidate.probe].place;
  const Expression below = formula.subtree(place);
  const Term& term = library_->terms[candidate.term];
  Expression step = constant_of(candidate.coefficient);
  if (candidate.term != 0) step = Expression::binary(Op::mul, step, term.formula);
  const auto offer = [&](const Expression& grown) {
    proposals.push_back({with_replaced(formula, place, grown.nodes()), candidate.decrease});
  };
  if (!candidate.multiplicative) {
    offer(Expression::binary(Op::add, below, step));
    return;
  }
  // To first order 1 + c t and exp(c t) are the same; which one fits shows only when both are
  // tried. A function of exp is grown inside instead.
  offer(Expression::binary(Op::mul, below, Expression::binary(Op::add, constant_of(1), step)));
  if (operators_->allows(Op::exp) && formula.node(place).op != Op::exp) {
    offer(Expression::binary(Op::mul, below, Expression::unary(Op::exp, step)));
  }
}

std::vector<Proposal> Grower::grow(const Expression& formula, const Rows& rows, std::size_t samples,
                                   std::size_t count, RandomStream& random, Budget& budget) {
  std::vector<Proposal> proposals;
  std::vector<Probe> probes = probes_of(formula);
  constexpr std::size_t kMostProbes = 8;  // of a sampled move; the rest gets its turn another time
  if (samples > 0 && probes.size() > kMostProbes) {
    random.shuffle(std::span(probes));
    probes.resize(kMostProbes);
    std::ranges::sort(probes, {}, &Probe::place);
  }
  if (!differentiate(formula, probes, rows, budget)) return proposals;
  orthonormalise(rows.size());
  std::vector<Candidate> candidates;
  const auto consider = [&](std::size_t probe, std::size_t term, bool multiplicative) {
    if (multiplicative ? (!probes[probe].multiplicative || term == 0) : !probes[probe].additive)
      return;
    const Candidate candidate = rate(formula, probe, term, multiplicative, rows.size());
    if (candidate.decrease > 0) candidates.push_back(candidate);
  };
  const std::size_t terms = library_->terms.size();
  if (samples == 0 || samples >= 2 * probes.size() * terms) {
    for (std::size_t i = 0; i < 2 * probes.size() * terms; ++i) {
      consider(i / 2 / terms, i / 2 % terms, i % 2 != 0);
    }
  } else {
    for (std::size_t i = 0; i < samples; ++i) {
      const std::size_t probe = random.below(probes.size());
      const std::size_t term = random.below(terms);
      consider(probe, term, random.chance(0.5));
    }
  }
  std::ranges::stable_sort(candidates, std::ranges::greater{}, &Candidate::decrease);
  for (const Candidate& candidate : candidates) {
    if (proposals.size() >= count) break;
    build(formula, candidate, probes, proposals);
  }
  return proposals;
}

std::vector<Proposal> Grower::prune(const Expression& formula, const Rows& rows, Budget& budget) {
  std::vector<Proposal> proposals;
  if (!differentiate(formula, {}, rows, budget) || constants_ == 0) return proposals;
  const std::size_t p = constants_;
  std::vector<double> curvature(p * p);
  for (std::size_t k = 0; k < p; ++k) {
    for (std::size_t l = 0; l <= k; ++l) {
      curvature[k * p + l] =
          columns::dot(column(k, rows.size()).data(), column(l, rows.size()).data(), rows.size());
    }
    // Redundant constants make J'J singular; a trace of ridge makes them the cheapest to remove.
    curvature[k * p + k] *= 1 + kDependent;
    if (!(curvature[k * p + k] > 0)) curvature[k * p + k] = 1;
  }
  if (!cholesky_factor(curvature, p)) return proposals;
  std::vector<double> unit(p);
  std::size_t k = 0;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (!formula.node(i).is_constant() || is_exponent(formula, i)) continue;
    std::ranges::fill(unit, 0.0);
    unit[k] = 1;
    cholesky_solve(curvature, p, unit);
    for (const double value : {0.0, 1.0}) {
      Expression pruned = formula;
      const double change = formula.node(i).value - value;
      pruned.set_constant(i, value);
      pruned = simplified(pruned);
      if (pruned.size() < formula.size()) {
        proposals.push_back({std::move(pruned), -change * change / unit[k]});
      }
    }
    ++k;
  }
  std::ranges::stable_sort(proposals, std::ranges::greater{}, &Proposal::decrease);
  return proposals;
}

}  // namespace tribench::pysr
