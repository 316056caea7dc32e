// SPDX-License-Identifier: MIT
#include "algorithms/relay/structure_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "algorithms/expression/build.hpp"
#include "algorithms/fitting/cross_validation.hpp"
#include "algorithms/relay/enclosed_inputs.hpp"
#include "algorithms/relay/function_sum.hpp"
#include "algorithms/relay/index_fit.hpp"
#include "algorithms/relay/long_sum.hpp"
#include "algorithms/relay/part_search.hpp"
#include "algorithms/relay/power_law.hpp"
#include "algorithms/relay/product_search.hpp"
#include "algorithms/relay/relation_search.hpp"
#include "algorithms/relay/scaled_function.hpp"
#include "algorithms/relay/surrogate.hpp"
#include "algorithms/relay/wave_sum.hpp"
#include "algorithms/relay/waves.hpp"

namespace tribench::relay {
namespace {

constexpr int kLastRound = 3;  // that looks at more
// Rows that the searches for structure look at.
constexpr std::size_t kSearchedRows = 512;
constexpr std::size_t kMostCollapses = 3;
constexpr std::size_t kFewRows = 300;        // that tell a sum of six among 700 columns
constexpr std::size_t kLikelyColumns = 150;  // under noise, where the best of many fits it
constexpr std::size_t kLikelyWaves = 400;
constexpr std::size_t kColumns = 500;            // of the search for relations, a round
constexpr std::size_t kRootColumns = 300;        // with square roots
constexpr std::size_t kMoreColumns = 700;        // with waves
constexpr std::size_t kLongSum = 16;             // nodes
constexpr std::size_t kOrders = 1500;            // of the search for fewer variables, a round
constexpr std::uint64_t kReduced = 500'000'000;  // node-rows for reductions, half a second
constexpr std::size_t kTried = 60;               // of reductions, most of them not true
constexpr std::size_t kMoreWays = 5;   // that are looked at when one has explained the rows
constexpr std::size_t kProblems = 16;  // in fewer variables that are looked at
constexpr std::size_t kMostDepth = 3;  // of reductions
// A surrogate's error, of the target's spread, below which noise is no matter.
constexpr double kSurelyExact = 3e-3;
// On which a long sum is chosen: at once, and where there is time. Many rows tell more terms.
constexpr std::size_t kRivalRows[] = {4000, 32'000};
constexpr double kQuarter = 0.25;      // of the seconds that are left, for a search for structure
constexpr double kMost = 0.6;          // for reductions, which end by themselves
constexpr double kHalf = 0.5;          // for a method on fewer variables
constexpr std::size_t kFewInputs = 3;  // with which waves and differences are tried at once

constexpr std::string_view kByProduct = "a product of powers";
constexpr std::string_view kBySum = "a sum of products";
constexpr std::string_view kByFunctionSum = "a function whose sizes inputs set";
constexpr std::string_view kByRoot = "a root of a quadratic equation";
constexpr std::string_view kByReduction = "fewer variables";
constexpr std::string_view kByParts = "parts without a common input";

// Takes out of `open` what slopes say before guesses, and of these the problem with the fewest
// inputs; none where it was seen before, on another way.
std::optional<ReducedProblem> next_problem(std::vector<ReducedProblem>& open,
                                           const std::vector<ReducedProblem>& seen) {
  const auto next = std::ranges::min_element(open, {}, [](const ReducedProblem& problem) {
    return std::pair(problem.is_guess(), problem.inputs());
  });
  ReducedProblem problem = std::move(*next);
  open.erase(next);
  const auto is_same = [&](const ReducedProblem& other) { return other.is_same_as(problem); };
  if (std::ranges::any_of(seen, is_same)) return std::nullopt;
  return problem;
}

// A surrogate's error for a target on these rows (surrogate.hpp).
double roughness_of(const LogRows& rows, std::span<const double> target, Budget& budget) {
  Budget part = budget.share(budget.remaining() / 4, kQuarter);
  const double error = Surrogate(rows, target, part).error();
  budget.settle(part);
  return error;
}

ReducedProblem collapsed(const ReducedProblem& problem, const Collapse& collapse) {
  return {problem, Reduction{TargetForm::plain, false, collapse.outer, {collapse.inner}}};
}

}  // namespace

StructureSearch::StructureSearch(FitContext& context, Answer& answer, const Regressor& solver,
                                 int round, std::string_view without)
    : context_(context), answer_(answer), solver_(solver), round_(round), without_(without) {}

void StructureSearch::search() {
  const LogRows rows(answer_.rows(), kSearchedRows);
  if (rows.rows() == 0 || round_ > kLastRound) return;
  Budget part = context_.budget.share(context_.budget.remaining() / 4, kQuarter);
  auto simpler = find_structure(rows, part);
  context_.budget.settle(part);
  search_roots();
  find_parts(rows);
  const bool has_parts = parts_ && parts_->error < kSurelyExact;
  search_wave_sum();
  search_function_sum(SumTerms::few);
  if (!has_parts && !answer_.is_explained()) search_likely();
  if (is_noise_left_) return;
  if (has(kReductions)) {
    auto reduced = reduce(Guesses::no);
    if (reduced && !simpler) simpler = std::move(reduced);
  }
  // Fewer variables are as exact as the rows, parts are not.
  if (!simpler) search_parts();
  if (round_ == 0 && has(kSums) && !answer_.is_done()) search_waves();
  if (simpler && !is_over()) search_by_solver(*simpler);
  if (simpler) search_parts();
}

void StructureSearch::search_roots() {
  const LogRows rows(answer_.rows(), kFewRows);
  const bool is_possible = has(kSums) && context_.operators.allows(Op::sqrt);
  if (round_ > 0 || is_over() || rows.rows() == 0 || !is_possible) return;
  Budget budget = context_.budget.share(context_.budget.remaining() / 4, kQuarter);
  answer_.offer(find_relation(rows, context_.operators, Columns::with_roots, kRootColumns, budget),
                kBySum);
  context_.budget.settle(budget);
}

// Before the rest is judged: a fast wave looks like noise.
void StructureSearch::search_wave_sum() {
  const LogRows rows(answer_.rows(), kFewRows);
  if (round_ > 0 || answer_.is_done() || rows.rows() == 0 || !has(kSums)) return;
  Budget budget = context_.budget.share(context_.budget.remaining() / 4, kQuarter);
  answer_.offer(find_wave_sum(rows, context_.operators, budget), kBySum);
  context_.budget.settle(budget);
}

void StructureSearch::search_function_sum(SumTerms terms) {
  const LogRows rows(answer_.rows(), kFewRows);
  if (round_ > 0 || answer_.is_done() || rows.rows() == 0 || !has(kFunctionSums)) return;
  Budget budget = context_.budget.share(context_.budget.remaining() / 4, kHalf);
  for (Expression& sum : find_function_sums(rows, context_.operators, terms, budget)) {
    answer_.offer(std::move(sum), kByFunctionSum);
  }
  context_.budget.settle(budget);
}

void StructureSearch::search_likely() {
  const LogRows rows(answer_.rows(), kFewRows);
  if (round_ > 0 || answer_.is_done() || rows.rows() == 0 || !has(kLikely)) return;
  if (roughness_of(rows, rows.target().values, context_.budget) < kSurelyExact) return;
  Budget part = context_.budget.share(context_.budget.remaining() / 4, kQuarter);
  std::vector<Expression> likely = likely_power_laws(rows, context_.operators, part);
  std::ranges::move(likely_products(rows, context_.operators, part), std::back_inserter(likely));
  if (has(kFunctionSums)) {
    std::ranges::move(likely_function_sums(rows, context_.operators, part),
                      std::back_inserter(likely));
  }
  for (const auto& [columns, most] : {std::pair(Columns::powers_alone, kLikelyColumns),
                                      std::pair(Columns::with_factors, kLikelyWaves)}) {
    std::ranges::move(likely_relations(rows, context_.operators, columns, most, part),
                      std::back_inserter(likely));
  }
  context_.budget.settle(part);
  // A part of its own: listing may have taken all of the other one.
  Budget fits = context_.budget.share(context_.budget.remaining() / 4, kQuarter);
  answer_.offer_likeliest(likely, fits);
  context_.budget.settle(fits);
  if (!answer_.has_formula()) return;
  Budget look = context_.budget.share(context_.budget.remaining() / 4, kQuarter);
  is_noise_left_ = leaves_noise(answer_.likeliest(), LogRows(answer_.rows(), kSearchedRows), look);
  context_.budget.settle(look);
}

void StructureSearch::search_long_sum() {
  // Beyond the rows products of distances grow as they like.
  const bool stays_within =
      !reaches_beyond(answer_.rows().table(), input_box(context_.data.inputs));
  if (is_over() || !has(kLongSums) || !stays_within) return;
  Budget part = context_.budget.share(context_.budget.remaining() / 4, kQuarter);
  for (const std::size_t most_rows : kRivalRows) {
    auto sum = fit_long_sum(answer_.rows(), context_.operators, most_rows, part);
    if (!sum) break;
    answer_.set_rival(std::move(*sum), most_rows);
    if (answer_.rows().rows() <= most_rows) break;
  }
  context_.budget.settle(part);
}

void StructureSearch::search_guesses() {
  if (!has(kGuesses)) return;
  const auto simpler = reduce(Guesses::yes);
  if (simpler && !is_over()) search_by_solver(*simpler);
}

void StructureSearch::search_enclosed() {
  // A prior, a sign or a state is said of an input, and not of what is made of it.
  const bool is_plain = std::ranges::all_of(context_.data.inputs, [](const Input& input) {
    return !input.sign_of && input.max_degree == 0 && input.law.empty();
  });
  if (is_over() || !is_plain || !has(kEnclosed) || !answer_.has_formula()) return;
  auto reduction = enclosed_inputs(answer_.likeliest(), context_.data.inputs.size());
  if (!reduction) return;
  const ReducedProblem problem(whole(), std::move(*reduction));
  const TrainingData data = problem.data();
  Budget part = context_.budget.share(context_.budget.remaining() / 4, kHalf);
  FitContext turn{
      data, context_.operators, part, context_.random.split("enclosed"), context_.threads, nullptr};
  std::vector<Expression> found;
  for (const Expression& g : solver_.fit(turn).front) found.push_back(problem.restored(g));
  context_.budget.settle(part);
  answer_.offer_likeliest(found, context_.budget);
}

void StructureSearch::search_wide_sums() {
  search_function_sum(SumTerms::many);
  const LogRows rows(answer_.rows(), kSearchedRows);
  if (rows.rows() == 0 || round_ > kLastRound || !has(kWideSums)) return;
  Budget part = context_.budget.share(context_.budget.remaining() / 4, kQuarter);
  const OperatorSet& operators = context_.operators;
  answer_.offer(find_relation(rows, operators, Columns::with_factors, 3 * kColumns << round_, part),
                kBySum);
  if (!answer_.is_done()) {
    answer_.offer(find_root(rows, operators, Columns::with_factors, 2 * kColumns << round_, part),
                  kByRoot);
  }
  context_.budget.settle(part);
}

// Sums and roots with waves: many columns, of fewer rows.
void StructureSearch::search_waves() {
  const LogRows rows(answer_.rows(), kFewRows);
  Budget budget = context_.budget.share(context_.budget.remaining() / 4, kQuarter);
  const OperatorSet& operators = context_.operators;
  answer_.offer(find_root(rows, operators, Columns::with_factors, kColumns, budget), kByRoot);
  if (!answer_.is_done()) {
    answer_.offer(find_relation(rows, operators, Columns::with_factors, kMoreColumns, budget),
                  kBySum);
  }
  context_.budget.settle(budget);
}

void StructureSearch::find_parts(const LogRows& rows) {
  if (round_ > 0 || !has(kParts) || answer_.is_done()) return;
  Budget budget = context_.budget.share(context_.budget.remaining() / 4, kQuarter);
  parts_ = find_separation(rows, budget);
  context_.budget.settle(budget);
}

void StructureSearch::search_parts() {
  if (!parts_ || answer_.is_done()) return;
  Budget budget = context_.budget.share(context_.budget.remaining() / 4, kHalf);
  const std::vector<Expression> joined =
      PartSearch(context_, solver_).run(LogRows(answer_.rows(), kSearchedRows), *parts_, budget);
  context_.budget.settle(budget);
  for (const Expression& formula : joined) {
    if (answer_.is_done()) return;
    answer_.offer(formula, kByParts);
  }
}

void StructureSearch::find_products_and_sums(const LogRows& rows, Budget& budget) {
  const OperatorSet& operators = context_.operators;
  if (has(kProducts)) answer_.offer(find_product(rows, operators, budget), kByProduct);
  // No way to write a short product is shorter.
  if (answer_.is_explained() && answer_.is_short()) answer_.end_look();
  if (answer_.is_done()) return;
  std::optional<Expression> sum;
  if (has(kSums)) sum = find_relation(rows, operators, Columns::powers_alone, kColumns, budget);
  answer_.offer(sum, kBySum);
  // A long sum of powers may be a short one of differences.
  if (sum && sum->size() > kLongSum) {
    answer_.offer(find_relation(rows, operators, Columns::with_factors, kColumns, budget), kBySum);
  }
  if (answer_.is_done()) return;
  if (context_.data.inputs.size() == 1) solve(whole(), budget);
}

std::optional<ReducedProblem> StructureSearch::find_structure(const LogRows& rows, Budget& budget) {
  if (round_ == 0) {
    find_products_and_sums(rows, budget);
    if (!is_over()) find_angles(budget);
    if (answer_.is_done()) return std::nullopt;
  }
  if (!has(kCollapses)) return std::nullopt;
  const auto collapses =
      find_collapses(rows, context_.operators, kOrders << round_, kMostCollapses, budget);
  for (const Collapse& collapse : collapses) {
    solve(collapsed(whole(), collapse), budget);
    if (answer_.is_done()) return std::nullopt;
  }
  if (collapses.empty() || !collapses[0].is_smooth) return std::nullopt;
  return collapsed(whole(), collapses[0]);
}

void StructureSearch::find_angles(Budget& budget) {
  if (!context_.operators.allows(Op::atan)) return;
  std::vector<Expression> inputs;
  for (std::size_t j = 0; j < context_.data.inputs.size(); ++j) inputs.push_back(build::input(j));
  for (const TargetForm form : angle_forms(answer_.rows().target)) {
    Reduction angle{form, false, build::constant(1), inputs};
    solve({whole(), std::move(angle)}, budget);
    if (answer_.is_done()) return;
  }
}

// g among products, short sums and known functions.
void StructureSearch::solve(const ReducedProblem& problem, Budget& budget) {
  const FiniteRows all(problem.data());
  const LogRows rows(all, kSearchedRows);
  if (rows.rows() == 0) return;
  const OperatorSet& operators = context_.operators;
  const auto try_g = [&](const std::optional<Expression>& g) {
    if (g) answer_.offer(problem.restored(*g), kByReduction);
  };
  try_g(find_product(rows, operators, budget));
  // All: the front's choice takes the shortest, and tells tanh x from x - x^3/3 where x is small.
  try_g(find_relation(rows, operators, Columns::powers_alone, kColumns, budget));
  if (problem.inputs() == 1) {
    try_g(find_function(rows, operators, budget));
    if (!is_over()) try_g(find_scaled_function(rows, operators, budget));
    if (!is_over()) try_g(find_waves(rows, operators, budget));
  }
}

void StructureSearch::solve_with_factors(const ReducedProblem& problem, Budget& budget) {
  const FiniteRows all(problem.data());
  const LogRows rows(all, kSearchedRows);
  if (problem.inputs() > kFewInputs || rows.rows() == 0) return;
  const std::size_t columns = problem.inputs() == 1 ? kColumns / 5 : 2 * kColumns;
  const auto g = find_relation(rows, context_.operators, Columns::with_factors, columns, budget);
  if (g) answer_.offer(problem.restored(*g), kByReduction);
}

// g by another method.
void StructureSearch::search_by_solver(const ReducedProblem& problem) {
  const TrainingData data = problem.data();
  Budget part = context_.budget.share(context_.budget.remaining() / 4, kHalf);
  FitContext turn{
      data, context_.operators, part, context_.random.split("reduced"), context_.threads, nullptr};
  const FitResult found = solver_.fit(turn);
  context_.budget.settle(part);
  for (const Expression& g : found.front) answer_.offer(problem.restored(g), kByReduction);
}

std::optional<ReducedProblem> StructureSearch::reduce(Guesses guesses) {
  const OperatorSet& operators = context_.operators;
  const bool is_possible = operators.allows(Op::mul) && operators.allows(Op::div);
  if (answer_.is_done() || round_ > 0 || !is_possible || answer_.rows().rows() == 0) {
    return std::nullopt;
  }
  const std::uint64_t most = guesses == Guesses::yes ? 3 * kReduced : kReduced;
  Budget budget = context_.budget.share(std::min(context_.budget.remaining() / 4, most), kMost);
  std::vector<ReducedProblem> open;
  open.push_back(whole());
  std::vector<ReducedProblem> seen;
  std::size_t tried = 0;
  std::size_t after = 0;  // looked at since the rows were explained: there may be a shorter way
  while (!open.empty() && seen.size() < kProblems && tried < kTried && after < kMoreWays &&
         !budget.exhausted()) {
    std::optional<ReducedProblem> problem = next_problem(open, seen);
    if (!problem) continue;
    ++tried;
    if (!look_at(*problem, guesses, open, budget)) continue;
    seen.push_back(std::move(*problem));
    if (answer_.is_explained() && seen.back().depth() > 0) ++after;
  }
  for (const ReducedProblem& problem : seen) {
    if (is_over() || budget.exhausted()) break;
    if (problem.depth() > 0) solve_with_factors(problem, budget);
  }
  context_.budget.settle(budget);
  const auto fewest = std::ranges::min_element(seen, {}, &ReducedProblem::inputs);
  if (fewest == seen.end() || fewest->depth() == 0) return std::nullopt;
  return std::move(*fewest);
}

bool StructureSearch::look_at(ReducedProblem& problem, Guesses guesses,
                              std::vector<ReducedProblem>& open, Budget& budget) {
  const FiniteRows all(problem.data());
  const LogRows rows(all, kSearchedRows);
  if (rows.rows() == 0) return false;  // a factor that overflows leaves none
  Reductions further = find_reductions(rows, guesses, budget);
  if (!(further.roughness <= problem.most_roughness())) return false;
  problem.set_roughness(further.roughness);
  if (problem.depth() > 0) solve(problem, budget);
  for (Reduction& each : further.list) {
    if (problem.depth() < kMostDepth) open.emplace_back(problem, std::move(each));
  }
  return true;
}

}  // namespace tribench::relay
