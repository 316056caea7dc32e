// SPDX-License-Identifier: MIT
#include "algorithms/udsr/pruning.hpp"

#include <cmath>
#include <limits>

#include "algorithms/fitting/symmetric_system.hpp"

namespace tribench::udsr {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

bool is_sum(Op op) { return op == Op::add || op == Op::sub; }

std::vector<std::size_t> parents_of(const Expression& formula) {
  std::vector<std::size_t> parents(formula.size(), kNone);
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const int children = arity(formula.node(i).op);
    if (children >= 1) parents[formula.last_child(i)] = i;
    if (children == 2) parents[formula.left_child(i)] = i;
  }
  return parents;
}

// Whether a subtree already has, or will have, a constant for its scale.
bool is_scaled(const Expression& formula, std::size_t place) {
  const Node& node = formula.node(place);
  if (node.is_constant()) return true;
  if (node.op == Op::neg) return is_scaled(formula, formula.last_child(place));
  if (is_sum(node.op)) {
    // Every term of a sum is or will be scaled; a factor before the sum would be one too many.
    return true;
  }
  if (node.op == Op::mul) {
    return is_scaled(formula, formula.left_child(place)) ||
           is_scaled(formula, formula.last_child(place));
  }
  return node.op == Op::div && is_scaled(formula, formula.left_child(place));
}

// Where a term is a term: an operand of a sum, the argument of a function, or the formula; not a
// sum itself. The factors of a product are not scaled apart, their sums are.
bool takes_scale(const Expression& formula, std::size_t place, std::size_t parent) {
  if (is_scaled(formula, place)) return false;
  if (parent == kNone) return true;
  const Op above = formula.node(parent).op;
  return is_sum(above) || (arity(above) == 1 && above != Op::neg);
}

// Whether a constant is among the terms of the sum at `place`.
bool has_offset(const Expression& formula, std::size_t place) {
  const Node& node = formula.node(place);
  if (node.is_constant()) return true;
  return is_sum(node.op) && (has_offset(formula, formula.left_child(place)) ||
                             has_offset(formula, formula.last_child(place)));
}

// Where a sum ends, and at the top. Inside exp an offset would be the scale of what stands outside.
bool takes_offset(const Expression& formula, std::size_t place, std::size_t parent) {
  if (has_offset(formula, place)) return false;
  if (parent == kNone) return true;
  const Op above = formula.node(parent).op;
  return is_sum(formula.node(place).op) && !is_sum(above) && above != Op::exp;
}

// The term that a constant scales: the top of the chain of products above it, where that is an
// operand of a sum; kNone otherwise.
std::size_t term_of(const Expression& formula, const std::vector<std::size_t>& parents,
                    std::size_t constant) {
  std::size_t place = constant;
  while (parents[place] != kNone) {
    const std::size_t parent = parents[place];
    const Op above = formula.node(parent).op;
    if (is_sum(above)) return place;
    const bool numerator = above == Op::div && formula.left_child(parent) == place;
    if (above != Op::mul && above != Op::neg && !numerator) return kNone;
    place = parent;
  }
  return kNone;
}

}  // namespace

std::vector<std::size_t> movable_constants(const Expression& formula) {
  const std::vector<std::size_t> parents = parents_of(formula);
  std::vector<std::size_t> places;
  for (const std::size_t place : constant_positions(formula)) {
    const std::size_t parent = parents[place];
    const bool exponent = parent != kNone && formula.node(parent).op == Op::pow &&
                          formula.last_child(parent) == place;
    if (!exponent) places.push_back(place);
  }
  return places;
}

Expression with_constants(const Expression& formula) {
  const std::vector<std::size_t> parents = parents_of(formula);
  std::vector<Node> tape;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    tape.push_back(formula.node(i));
    if (takes_scale(formula, i, parents[i])) {
      tape.push_back(Node::constant(1));
      tape.push_back({0, 0, 0, Op::mul});
    }
    if (takes_offset(formula, i, parents[i])) {
      tape.push_back(Node::constant(0));
      tape.push_back({0, 0, 0, Op::add});
    }
  }
  return Expression(std::move(tape));
}

Expression without_term(const Expression& formula, std::size_t place) {
  const std::vector<std::size_t> parents = parents_of(formula);
  const std::size_t sum = parents[place];
  const bool is_left = formula.left_child(sum) == place;
  const std::size_t kept = is_left ? formula.last_child(sum) : formula.left_child(sum);
  Expression rest = subtree(formula, kept);
  // 0 - b is -1 * b: a factor of its own, that a fit can move.
  if (is_left && formula.node(sum).op == Op::sub) {
    rest = Expression::binary(Op::mul, Expression::constant(-1), rest);
  }
  Expression result = formula;
  result.replace(sum, rest.nodes());
  return result;
}

std::size_t Pruner::least_needed(const Expression& formula, const InTime& in_time,
                                 std::uint64_t& node_rows) {
  const std::vector<std::size_t> constants = movable_constants(formula);
  const std::vector<std::size_t> parents = parents_of(formula);
  differentiator_.prepare(formula, constants);
  NormalEquations normal;
  differentiator_.normal_equations(problem_->inputs(), problem_->target(), {}, normal, in_time);
  node_rows += 4 * tribench::node_rows(formula, problem_->rows());
  const auto p = static_cast<Eigen::Index>(constants.size());
  Eigen::MatrixXd curvature = Eigen::Map<const Eigen::MatrixXd>(normal.curvature.data(), p, p);
  if (p == 0 || !std::isfinite(normal.sum_squares) || !curvature.allFinite()) return formula.size();
  // Scaled to a unit diagonal; the ridge lets redundant terms be told apart at all.
  const Eigen::VectorXd scale = curvature.diagonal().cwiseSqrt().cwiseMax(1e-150);
  curvature = scale.cwiseInverse().asDiagonal() * curvature * scale.cwiseInverse().asDiagonal();
  curvature.diagonal().array() += 1e-10;
  const Eigen::MatrixXd inverse = inverse_symmetric(curvature);
  std::size_t least = formula.size();
  double smallest = std::numeric_limits<double>::infinity();
  for (Eigen::Index k = 0; k < p; ++k) {
    const std::size_t place = constants[static_cast<std::size_t>(k)];
    const std::size_t term = term_of(formula, parents, place);
    if (term == kNone) continue;
    const double value = formula.node(place).value * scale[k];
    const double increase = value * value / inverse(k, k);
    if (!(increase < smallest)) continue;
    smallest = increase;
    least = term;
  }
  return least;
}

std::vector<Pruner::Step> Pruner::path(Expression formula, std::size_t fewest, Budget& budget,
                                       Budget& clock) {
  std::vector<Step> steps;
  // Of hundreds of terms on thousands of rows a single step takes seconds.
  const InTime in_time = [&clock] { return clock.in_time(); };
  while (true) {
    const ConstantFitResult fit =
        fitter_.fit(formula, problem_->inputs(), problem_->target(), {}, {.in_time = in_time});
    std::uint64_t cost = fit.node_rows;
    if (fit.status == FitStatus::not_finite || fit.status == FitStatus::no_constants ||
        fit.status == FitStatus::out_of_time) {
      break;
    }
    const double mean = fit.sum_squares / static_cast<double>(problem_->rows());
    steps.push_back(
        {formula, std::sqrt(problem_->variance() > 0 ? mean / problem_->variance() : mean)});
    if (movable_constants(formula).size() <= fewest) break;
    const std::size_t term = least_needed(formula, in_time, cost);
    budget.spend(cost);
    if (!clock.in_time() || term == formula.size()) break;
    formula = without_term(formula, term);
  }
  return steps;
}

}  // namespace tribench::udsr
