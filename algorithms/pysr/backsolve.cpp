// SPDX-License-Identifier: MIT
#include "algorithms/pysr/backsolve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <unordered_set>

#include "algorithms/fitting/linear_least_squares.hpp"
#include "algorithms/pysr/simplify.hpp"
#include "algorithms/pysr/tape_edit.hpp"
#include "foundation/elementary.hpp"

namespace tribench::pysr {
namespace {

constexpr std::size_t kMostCandidates = 500;
constexpr std::size_t kMostTermsOfSum = 4;
constexpr double kWorthwhile = 0.999;  // a term must lower the sum of squares below this share
constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

// x with op(x, other) = target, or op(other, x) = target where x is on the right. `current` tells
// the branch of an even power.
double invert_binary(Op op, double target, double other, bool on_right, double current) {
  switch (op) {
    case Op::add:
      return target - other;
    case Op::sub:
      return on_right ? other - target : target + other;
    case Op::mul:
      return target / other;
    case Op::div:
      return on_right ? other / target : target * other;
    case Op::pow: {
      if (on_right) return elementary::log(target) / elementary::log(other);
      if (std::fmod(other, 2) == 0)
        return std::copysign(elementary::pow(target, 1 / other), current);
      if (std::floor(other) == other) {
        return std::copysign(elementary::pow(std::abs(target), 1 / other), target);
      }
      return elementary::pow(target, 1 / other);
    }
    default:
      return kUndefined;
  }
}

double invert_unary(Op op, double target, double current) {
  switch (op) {
    case Op::neg:
      return -target;
    case Op::exp:
      return elementary::log(target);
    case Op::log:
      return elementary::exp(target);
    case Op::sqrt:
      return target < 0 ? kUndefined : target * target;
    case Op::abs:
      return target < 0 ? kUndefined : std::copysign(target, current);
    case Op::tanh:
      return elementary::atanh(target);
    case Op::atan:
      return std::abs(target) < std::numbers::pi / 2 ? elementary::tan(target) : kUndefined;
    default:
      return kUndefined;
  }
}

// The nodes from the root down to `place`, both included.
std::vector<std::size_t> path_to(const Expression& formula, std::size_t place) {
  std::vector<std::size_t> path = {place};
  while (path.back() != formula.root()) path.push_back(parent_of(formula, path.back()));
  std::ranges::reverse(path);
  return path;
}

// Different subtrees of the population, in its order.
std::vector<Expression> candidates_of(std::span<const Member> population) {
  std::vector<Expression> candidates;
  std::unordered_set<std::uint64_t> seen;  // never iterated
  for (const Member& member : population) {
    for (std::size_t i = 0; i < member.formula.size(); ++i) {
      if (member.formula.node(i).is_constant()) continue;
      Expression part = subtree(member.formula, i);
      if (!seen.insert(structure_hash(part)).second) continue;
      candidates.push_back(std::move(part));
      if (candidates.size() == kMostCandidates) return candidates;
    }
  }
  return candidates;
}

// Values of formulas on the rows of a demand.
struct Library {
  std::vector<Expression> formulas;
  std::vector<std::vector<double>> columns;
};

Library evaluate_on(std::vector<Expression> formulas, const Rows& rows, const Demand& demand,
                    Evaluator& evaluator) {
  Library library;
  std::vector<double> values(rows.size());
  for (Expression& formula : formulas) {
    evaluator.evaluate(formula, rows.inputs(), values);
    std::vector<double> column;
    for (const std::size_t row : demand.rows) column.push_back(values[row]);
    if (!std::ranges::all_of(column, [](double x) { return std::isfinite(x); })) continue;
    library.formulas.push_back(std::move(formula));
    library.columns.push_back(std::move(column));
  }
  return library;
}

struct TermChoice {
  std::vector<std::size_t> chosen;
  LinearFit fit;
};

// Greedy forward choice of terms that fit into the nodes.
TermChoice select_terms(const Library& library, std::span<const double> target, std::size_t nodes) {
  const std::vector<double> ones(target.size(), 1.0);
  std::vector<const double*> columns = {ones.data()};
  TermChoice choice{{}, solve_least_squares(columns, target)};
  std::size_t used = 1;
  while (choice.chosen.size() < kMostTermsOfSum) {
    std::optional<std::size_t> best;
    LinearFit best_fit = choice.fit;
    for (std::size_t k = 0; k < library.formulas.size(); ++k) {
      // c * t and the sum.
      if (used + library.formulas[k].size() + 3 > nodes) continue;
      columns.push_back(library.columns[k].data());
      LinearFit fit = solve_least_squares(columns, target);
      columns.pop_back();
      if (!(fit.sum_squares < best_fit.sum_squares)) continue;
      best = k;
      best_fit = std::move(fit);
    }
    if (!best || !(best_fit.sum_squares < kWorthwhile * choice.fit.sum_squares)) break;
    used += library.formulas[*best].size() + 3;
    columns.push_back(library.columns[*best].data());
    choice.chosen.push_back(*best);
    choice.fit = std::move(best_fit);
  }
  return choice;
}

Expression sum_of(const Library& library, const TermChoice& choice) {
  Expression sum = Expression::constant(choice.fit.coefficients[0]);
  for (std::size_t k = 0; k < choice.chosen.size(); ++k) {
    sum = Expression::binary(
        Op::add, sum,
        Expression::binary(Op::mul, Expression::constant(choice.fit.coefficients[k + 1]),
                           library.formulas[choice.chosen[k]]));
  }
  return sum;
}

}  // namespace

Demand demand_at(const Expression& formula, std::size_t place, const Rows& rows,
                 Evaluator& evaluator) {
  Demand demand{rows.target, {}};
  const std::vector<std::size_t> path = path_to(formula, place);
  std::vector<double> current(rows.size());
  std::vector<double> other(rows.size());
  for (std::size_t step = 0; step + 1 < path.size(); ++step) {
    const std::size_t node = path[step];
    const std::size_t below = path[step + 1];
    const Op op = formula.node(node).op;
    const Children children = children_of(formula, node);
    evaluator.evaluate(subtree(formula, below), rows.inputs(), current);
    const bool on_right = children.count == 2 && children.place[1] == below;
    if (children.count == 2) {
      evaluator.evaluate(subtree(formula, children.place[on_right ? 0 : 1]), rows.inputs(), other);
    }
    for (std::size_t r = 0; r < rows.size(); ++r) {
      demand.values[r] = children.count == 2
                             ? invert_binary(op, demand.values[r], other[r], on_right, current[r])
                             : invert_unary(op, demand.values[r], current[r]);
    }
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (std::isfinite(demand.values[r])) {
      demand.rows.push_back(r);
    } else {
      demand.values[r] = kUndefined;
    }
  }
  return demand;
}

std::optional<Expression> backsolve(const Expression& parent, std::span<const Member> population,
                                    const Rows& rows, std::size_t max_nodes, RandomStream& random,
                                    Budget& budget) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i + 1 < parent.size(); ++i) {
    if (!is_exponent(parent, i)) places.push_back(i);
  }
  if (places.empty()) return std::nullopt;
  const std::size_t place = places[random.below(places.size())];
  const std::size_t kept = parent.size() - parent.node(place).length;
  std::vector<Expression> formulas = candidates_of(population);
  std::uint64_t cost = 2 * node_rows(parent, rows.size());
  for (const Expression& formula : formulas) {
    // Its values, and a least squares with it in every round.
    cost += node_rows(formula, rows.size()) + kMostTermsOfSum * kMostTermsOfSum * rows.size();
  }
  if (kept >= max_nodes || !budget.spend(cost)) return std::nullopt;
  Evaluator evaluator;
  const Demand demand = demand_at(parent, place, rows, evaluator);
  if (demand.rows.size() < 2 * kMostTermsOfSum) return std::nullopt;
  const Library library = evaluate_on(std::move(formulas), rows, demand, evaluator);
  std::vector<double> target;
  for (const std::size_t row : demand.rows) target.push_back(demand.values[row]);
  const TermChoice choice = select_terms(library, target, max_nodes - kept);
  const Expression solved = sum_of(library, choice);
  Expression child = with_replaced(parent, place, solved.nodes());
  if (structure_hash(simplified(child)) == structure_hash(simplified(parent))) return std::nullopt;
  return child;
}

}  // namespace tribench::pysr
