// SPDX-License-Identifier: MIT
#include "algorithms/relay/part_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "algorithms/admission.hpp"
#include "algorithms/expression/build.hpp"
#include "algorithms/finite_rows.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "algorithms/fitting/evidence_pruning.hpp"
#include "algorithms/fitting/joint_front.hpp"
#include "algorithms/relay/product_search.hpp"
#include "algorithms/relay/relation_search.hpp"
#include "foundation/elementary.hpp"

namespace tribench::relay {
namespace {

using namespace build;

constexpr double kSaysNothing = 0.1;    // error of a sum of polynomials that says nothing
constexpr double kClearly = 0.5;        // of the error of one polynomial in all inputs
constexpr double kNearPower = 1e-4;     // of a part's square in logarithms
constexpr std::size_t kPartRows = 300;  // that what is likely is told from
constexpr std::size_t kFewColumns = 60;
constexpr std::size_t kColumns = 150;
constexpr std::size_t kCommonTerms = 40;  // of a polynomial in the inputs of two parts
constexpr std::size_t kFitted = 12;       // of the likely ones
constexpr std::size_t kTaken = 3;         // of a part's formulas
constexpr double kOfSolver = 0.8;         // of the seconds; the rest is for leaving out numbers
constexpr int kMostDepth = 2;             // of parts of parts

using Pair = std::pair<std::size_t, std::size_t>;  // of parts

std::vector<Pair> pairs_of(const Parts& parts) {
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < parts.size(); ++a) {
    for (std::size_t b = a + 1; b < parts.size(); ++b) pairs.emplace_back(a, b);
  }
  return pairs;
}

Parts with_together(Parts parts, const Pair& pair) {
  std::vector<std::size_t>& one = parts[pair.first];
  one.insert(one.end(), parts[pair.second].begin(), parts[pair.second].end());
  std::ranges::sort(one);
  parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(pair.second));
  return parts;
}

// The two parts of whose inputs a polynomial explains most of what the sum of all parts leaves.
Pair most_in_common(const LogRows& rows, const Parts& parts, const Surrogate& sum,
                    const std::vector<double>& target, Budget& budget) {
  std::vector<double> left = target;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    for (std::size_t r = 0; r < left.size(); ++r) left[r] -= sum.part(k)[r];
  }
  return std::ranges::min(pairs_of(parts), {}, [&](const Pair& pair) {
    std::vector<Factor> inputs;
    for (const std::size_t j : parts[pair.first]) inputs.push_back(rows.inputs()[j]);
    for (const std::size_t j : parts[pair.second]) inputs.push_back(rows.inputs()[j]);
    return Surrogate(inputs, left, kCommonTerms, budget).error();
  });
}

// The same, by the terms of a polynomial in all inputs.
Pair most_in_common(const Parts& parts, const Surrogate& whole) {
  return std::ranges::max(pairs_of(parts), {}, [&](const Pair& pair) {
    double most = 0;
    for (const std::size_t i : parts[pair.first]) {
      for (const std::size_t j : parts[pair.second]) most = std::max(most, whole.shared(i, j));
    }
    return most;
  });
}

// What all other parts leave of the target.
std::vector<double> own_target(const Separation& separation, std::size_t own) {
  std::vector<double> left = separation.target;
  for (std::size_t k = 0; k < separation.parts.size(); ++k) {
    if (k == own) continue;
    for (std::size_t r = 0; r < left.size(); ++r) left[r] -= separation.values[k][r];
  }
  if (separation.form == TargetForm::logarithm) {
    for (double& z : left) z = elementary::exp(z);
  }
  return left;
}

// A sum without its constant, which any other part may have as well.
Expression without_constant(const Expression& sum) {
  const std::size_t root = sum.size() - 1;
  if (sum.node(root).op != Op::add) return sum;
  const Expression right = subtree(sum, root - 1);
  const Expression left = subtree(sum, root - 1 - right.size());
  if (left.size() == 1 && left.node(0).is_constant()) return without_constant(right);
  if (right.size() == 1 && right.node(0).is_constant()) return without_constant(left);
  return without_constant(left) + right;
}

double squared_correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const auto n = static_cast<double>(a.size());
  const double mean_a = std::accumulate(a.begin(), a.end(), 0.0) / n;
  const double mean_b = std::accumulate(b.begin(), b.end(), 0.0) / n;
  double aa = 0, ab = 0, bb = 0;
  for (std::size_t r = 0; r < a.size(); ++r) {
    aa += (a[r] - mean_a) * (a[r] - mean_a);
    ab += (a[r] - mean_a) * (b[r] - mean_b);
    bb += (b[r] - mean_b) * (b[r] - mean_b);
  }
  return aa > 0 && bb > 0 ? ab * ab / (aa * bb) : 0;
}

// `formula` with other inputs.
Expression over_inputs(const Expression& formula, const std::vector<std::size_t>& inputs) {
  std::vector<Node> nodes(formula.nodes().begin(), formula.nodes().end());
  for (Node& node : nodes) {
    if (node.is_variable())
      node.variable = static_cast<decltype(node.variable)>(inputs[node.variable]);
  }
  return Expression(std::move(nodes));
}

// All choices of one formula a part whose places add up to `left`.
void add_choices(const std::vector<std::vector<Expression>>& found, std::size_t left,
                 std::vector<std::size_t>& places, std::vector<std::vector<std::size_t>>& all) {
  const std::size_t next = places.size();
  if (next == found.size()) {
    if (left == 0) all.push_back(places);
    return;
  }
  for (std::size_t place = 0; place <= left && place < found[next].size(); ++place) {
    places.push_back(place);
    add_choices(found, left - place, places, all);
    places.pop_back();
  }
}

std::vector<Expression> fitted(std::vector<Expression> formulas, const FiniteRows& rows,
                               Budget& budget) {
  ConstantFitter fitter;
  std::vector<Expression> kept;
  for (Expression& formula : formulas) {
    if (!budget.in_time()) break;
    const ConstantFitResult fit = fitter.fit(formula, rows.table(), rows.target);
    budget.spend(fit.node_rows);
    if (fit.status != FitStatus::not_finite) kept.push_back(std::move(formula));
  }
  return kept;
}

}  // namespace

namespace {

// Of a product: powers divide out exactly elsewhere (reduction.hpp), and leave one part.
bool are_worth_it(const LogRows& rows, const Parts& parts, const Surrogate& sum) {
  std::size_t others = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const Factor& input = rows.inputs()[parts[k][0]];
    const bool is_power = parts[k].size() == 1 && input.has_logs() &&
                          1 - squared_correlation(sum.part(k), input.logs) <= kNearPower;
    if (!is_power) ++others;
  }
  return others >= 2;
}

Separation separation_of(TargetForm form, const std::vector<double>& target, const Parts& parts,
                         const Surrogate& sum) {
  Separation separation{form, {}, target, {}, sum.error()};
  std::vector<std::size_t> order(parts.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return parts[k].size(); });
  for (const std::size_t k : order) {
    separation.parts.push_back(parts[k]);
    separation.values.push_back(sum.part(k));
  }
  return separation;
}

}  // namespace

std::optional<Separation> find_separation(const LogRows& rows, Budget& budget) {
  const std::size_t inputs = rows.inputs().size();
  std::optional<Separation> best;
  const bool has_logs = rows.target().has_logs() && !rows.target().changes_sign;
  Parts alone;
  for (std::size_t j = 0; j < inputs; ++j) alone.push_back({j});
  for (const TargetForm form : {TargetForm::plain, TargetForm::logarithm}) {
    if (inputs < 2 || (form == TargetForm::logarithm && !has_logs)) continue;
    const std::vector<double> target = formed_target(rows.target().values, form);
    const Surrogate whole(rows, target, budget);
    if (!std::isfinite(whole.error())) continue;
    // Together comes what has most in common, from each input alone to two parts: by the terms of
    // `whole`, or by what the parts leave where it has too many inputs to tell.
    const bool by_terms = whole.error() <= kSaysNothing;
    for (Parts parts = alone;;) {
      const Surrogate sum(rows, target, parts, whole, budget);
      if (!std::isfinite(sum.error())) break;
      const double least = best ? best->error : std::min(kClearly * whole.error(), kSaysNothing);
      const bool is_sum = form == TargetForm::plain;
      if (sum.error() < least && (is_sum || are_worth_it(rows, parts, sum))) {
        best = separation_of(form, target, parts, sum);
      }
      if (parts.size() == 2) break;
      parts = with_together(parts, by_terms ? most_in_common(parts, whole)
                                            : most_in_common(rows, parts, sum, target, budget));
    }
  }
  return best;
}

std::vector<Expression> PartSearch::run(const LogRows& rows, const Separation& separation,
                                        Budget& budget) const {
  return joined(rows, separation, context_.data.inputs, 0, budget);
}

std::vector<Expression> PartSearch::joined(const LogRows& rows, Separation separation,
                                           std::span<const Input> inputs, int depth,
                                           Budget& budget) const {
  const std::size_t parts = separation.parts.size();
  const bool is_sum = separation.form == TargetForm::plain;
  std::vector<std::vector<Expression>> found;
  for (std::size_t k = 0; k < parts; ++k) {
    std::vector<Input> own;
    std::vector<const double*> columns;
    for (const std::size_t j : separation.parts[k]) {
      own.push_back(inputs[j]);
      columns.push_back(rows.inputs()[j].values.data());
    }
    const double share = 1 / static_cast<double>(parts - k);
    Budget part = budget.share(budget.remaining() / (parts - k), share);
    const std::vector<double> target = own_target(separation, k);
    Solution solution = solved({own, columns, target, {}}, depth + 1, part);
    budget.settle(part);
    if (solution.formulas.empty()) return {};
    for (Expression& formula : solution.formulas) {
      if (is_sum) formula = without_constant(formula);
      formula = over_inputs(formula, separation.parts[k]);
    }
    if (solution.leaves_noise) {
      const Factor exact = factor_of(solution.formulas[0], rows);
      if (is_sum || exact.has_logs()) separation.values[k] = is_sum ? exact.values : exact.logs;
    }
    found.push_back(std::move(solution.formulas));
  }
  std::vector<std::vector<std::size_t>> choices;
  std::vector<std::size_t> places;
  for (std::size_t sum = 0; sum < kTaken; ++sum) add_choices(found, sum, places, choices);
  std::vector<Expression> all;
  for (const auto& choice : choices) {
    Expression formula = found[0][choice[0]];
    for (std::size_t k = 1; k < parts; ++k) {
      const Expression& part = found[k][choice[k]];
      formula = is_sum ? formula + part : formula * part;
    }
    if (is_sum) {
      formula = formula + constant(0);
    } else if (rows.target().values[0] < 0) {
      formula = constant(-1) * formula;
    }
    all.push_back(std::move(formula));
  }
  return all;
}

PartSearch::Solution PartSearch::solved(const TrainingData& data, int depth, Budget& budget) const {
  const FiniteRows all(data);
  const LogRows rows(all, kPartRows);
  JointFront front(all.table(), all.target, all.movement, {});
  if (rows.rows() == 0) return {};
  JointFront proposed(all.table(), all.target, all.movement, {});
  const auto propose = [&](const std::vector<Expression>& formulas) {
    for (const Expression& formula : formulas) {
      if (context_.operators.admits(formula)) proposed.add(std::array{formula}, 0);
    }
  };
  propose(likely_products(rows, context_.operators, budget));
  // Few columns first: of many all too many sums are nearly as good.
  for (const auto& [columns, most] : {std::pair(Columns::powers_alone, kFewColumns),
                                      std::pair(Columns::with_factors, kColumns)}) {
    propose(likely_relations(rows, context_.operators, columns, most, budget));
  }
  for (const Expression& formula : fitted(proposed.likeliest(kFitted), all, budget)) {
    front.add(std::array{formula}, 0);
  }
  if (!front.empty() && leaves_noise(front.likeliest(1)[0], rows, budget)) {
    return {front.likeliest(kTaken), true};
  }
  if (depth < kMostDepth) {
    if (const auto separation = find_separation(rows, budget)) {
      Budget half = budget.share(budget.remaining() / 2, 0.5);
      for (const Expression& formula :
           fitted(joined(rows, *separation, data.inputs, depth, half), all, budget)) {
        front.add(std::array{formula}, 0);
      }
      budget.settle(half);
    }
  }
  if (budget.in_time()) {
    Budget most = budget.share(budget.remaining() / 5 * 4, kOfSolver);
    FitContext turn{
        data, context_.operators, most, context_.random.split("part"), context_.threads, nullptr};
    const FitResult result = solver_.fit(turn);
    budget.settle(most);
    if (!result.front.empty()) front.add(result.front, result.chosen);
  }
  if (!front.empty()) {
    const Expression pruned = pruned_by_evidence(
        front.likeliest(1)[0], all.table(), all.target, input_box(data.inputs),
        [&](std::uint64_t node_rows) { return budget.spend(node_rows) && budget.in_time(); });
    if (context_.operators.admits(pruned)) front.add(std::array{pruned}, 0);
  }
  if (front.empty()) return {};
  return {front.likeliest(kTaken), leaves_noise(front.likeliest(1)[0], rows, budget)};
}

}  // namespace tribench::relay
