// SPDX-License-Identifier: MIT
#include "algorithms/pysr/growth.hpp"

#include <algorithm>
#include <cmath>

#include "algorithms/expression/column_kernels.hpp"
#include "algorithms/fitting/cholesky.hpp"
#include "algorithms/fitting/evidence.hpp"
#include "algorithms/fitting/shape_dimension.hpp"
#include "algorithms/pysr/tape_edit.hpp"
#include "foundation/elementary.hpp"

namespace tribench::pysr {
namespace {

// A direction that keeps less than this share of its square outside J is no new one.
constexpr double kDependent = 1e-8;

// Two decreases closer than this are of directions that are the same outside J.
constexpr double kSameDecrease = 1e-6;

// No share of the residual larger than this is believed of a first-order estimate.
constexpr double kAllExplained = 0.99;

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
  for (std::size_t part = 0; part < form_->parts(); ++part) {
    const std::size_t root = form_->place(formula, part);
    for (std::size_t i = formula.begin(root); i <= root; ++i) {
      if (is_exponent(formula, i)) continue;
      const bool is_root = i == root;
      const Op above = is_root ? Op::constant : formula.node(parent_of(formula, i)).op;
      // A sum is grown as a whole, not each of its terms; so is a product.
      const bool additive = is_root || !is_sum(above);
      const bool multiplicative = !formula.node(i).is_constant() && (is_root || !is_product(above));
      if (additive || multiplicative) {
        probes.push_back({i, &(*libraries_)[part], additive, multiplicative});
      }
    }
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

void Grower::load_probe(std::size_t probe, bool multiplicative, std::size_t rows) {
  // With u = slope * t the products q'u, e'u and u'u are products of q * slope, e * slope and
  // slope^2 with t and t^2: formed once for all terms.
  const std::span<const double> slope =
      column(constants_ + 2 * probe + (multiplicative ? 0 : 1), rows);
  const std::size_t count = basis_size_ + 2;
  loaded_.resize((count + 3) / 4 * 4 * rows);
  for (std::size_t b = 0; b < basis_size_; ++b) {
    columns::mul(slope.data(), basis_.data() + b * rows, loaded_.data() + b * rows, rows);
  }
  columns::mul(slope.data(), residual_.data(), loaded_.data() + basis_size_ * rows, rows);
  columns::mul(slope.data(), slope.data(), loaded_.data() + (basis_size_ + 1) * rows, rows);
}

Grower::Candidate Grower::rate(std::size_t probe, const Term& term, bool multiplicative,
                               std::size_t rows) const {
  const double before =
      columns::dot(loaded_.data() + (basis_size_ + 1) * rows, term.squares.data(), rows);
  double after = before;
  double along = 0;
  for (std::size_t first = 0; first <= basis_size_; first += 4) {
    const double* block[4];
    double sums[4];
    for (std::size_t k = 0; k < 4; ++k) {
      block[k] = loaded_.data() + std::min(first + k, basis_size_) * rows;
    }
    columns::dot4(term.values.data(), block, rows, sums);
    for (std::size_t k = 0; k < 4 && first + k <= basis_size_; ++k) {
      if (first + k == basis_size_) {
        along = sums[k];
      } else {
        after -= sums[k] * sums[k];
      }
    }
  }
  if (!std::isfinite(after) || !(after > kDependent * before)) {
    return {probe, &term, multiplicative, 0, 0, 0};
  }
  return {probe, &term, multiplicative, along / after, along * along / after, 0};
}

void Grower::build(const Expression& formula, const Candidate& candidate,
                   std::span<const Probe> probes, std::vector<Proposal>& proposals) const {
  const std::size_t place = probes[candidate.probe].place;
  const Expression below = subtree(formula, place);
  const Term& term = *candidate.term;
  Expression step = constant_of(candidate.coefficient);
  if (!term.is_one()) step = Expression::binary(Op::mul, step, term.formula);
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
  for (const Candidate& candidate : distinct(ranked(probes, samples, rows.size(), random))) {
    if (proposals.size() >= count) break;
    build(formula, candidate, probes, proposals);
  }
  return proposals;
}

std::vector<Grower::Candidate> Grower::ranked(std::span<const Probe> probes, std::size_t samples,
                                              std::size_t rows, RandomStream& random) {
  std::vector<Candidate> candidates;
  // Each term has the same chance at each place.
  std::size_t pairs = 0;
  for (const Probe& probe : probes) pairs += 2 * probe.library->terms.size();
  const double share = samples == 0 ? 1 : static_cast<double>(samples) / static_cast<double>(pairs);
  for (std::size_t probe = 0; probe < probes.size(); ++probe) {
    for (const bool multiplicative : {false, true}) {
      if (multiplicative ? !probes[probe].multiplicative : !probes[probe].additive) continue;
      bool loaded = false;
      const std::vector<Term>& terms = probes[probe].library->terms;
      for (std::size_t term = multiplicative ? 1 : 0; term < terms.size(); ++term) {
        if (share < 1 && !random.chance(share)) continue;
        if (!loaded) load_probe(probe, multiplicative, rows);
        loaded = true;
        const Candidate candidate = rate(probe, terms[term], multiplicative, rows);
        if (candidate.decrease > 0) candidates.push_back(candidate);
      }
    }
  }
  return candidates;
}

std::vector<Grower::Candidate> Grower::distinct(std::vector<Candidate> candidates) const {
  std::ranges::stable_sort(candidates, std::ranges::greater{}, &Candidate::decrease);
  const auto n = static_cast<double>(residual_.size());
  const double before = square_of(residual_);
  std::vector<Candidate> kept;
  double last = 0;
  for (Candidate& candidate : candidates) {
    candidate.gain =
        -0.5 * n * elementary::log1p(-std::min(candidate.decrease / before, kAllExplained)) -
        price_of(candidate);
    // What explains the same is the same to first order; the cheapest stands for all.
    if (kept.empty() || candidate.decrease < (1 - kSameDecrease) * last) {
      kept.push_back(candidate);
      last = candidate.decrease;
    } else if (candidate.gain > kept.back().gain) {
      kept.back() = candidate;
    }
  }
  std::ranges::stable_sort(kept, std::ranges::greater{}, &Candidate::gain);
  return kept;
}

double Grower::price_of(const Candidate& candidate) const {
  const Expression& term = candidate.term->formula;
  // 1 + c t costs two nodes more than c t.
  double nodes = static_cast<double>(term.size()) + (candidate.multiplicative ? 5 : 3);
  if (candidate.term->is_one()) nodes = 2;
  const double constants =
      candidate.term->is_one() ? 1 : static_cast<double>(shape_dimension(term));
  return kNodePrice * nodes +
         0.5 * constants * elementary::log(static_cast<double>(residual_.size()));
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
      set_constant(pruned, i, value);
      pruned = simplified(*form_, pruned);
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
