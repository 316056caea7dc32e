// SPDX-License-Identifier: MIT
#include "algorithms/relay/relay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "algorithms/admission.hpp"
#include "algorithms/expression/singularity.hpp"
#include "algorithms/finite_rows.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "algorithms/fitting/evidence_pruning.hpp"
#include "algorithms/fitting/joint_front.hpp"
#include "algorithms/relay/collapse.hpp"
#include "algorithms/relay/index_fit.hpp"
#include "algorithms/relay/log_rows.hpp"
#include "algorithms/relay/product_search.hpp"
#include "algorithms/relay/reduced_problem.hpp"
#include "algorithms/relay/relation_search.hpp"
#include "algorithms/relay/scaled_function.hpp"

namespace tribench {
namespace {

using relay::Columns;
using relay::LogRows;
using relay::ReducedProblem;
using relay::Reduction;

// In the order in which they run: where time is short, the one that finds most alone comes first.
constexpr std::array kMembers = {"pysr", "udsr", "parfam"};
// Rows that the searches for structure look at.
constexpr std::size_t kSearchedRows = 512;
constexpr std::size_t kMostCollapses = 3;
constexpr std::size_t kFewRows = 300;        // that tell a sum of six among 700 columns
constexpr std::size_t kLikelyColumns = 150;  // under noise, where the best of many fits it
constexpr std::size_t kLikelyWaves = 400;
constexpr std::size_t kLikelyTaken = 5;          // of these
constexpr std::size_t kColumns = 500;            // of the search for relations, a round
constexpr std::size_t kMoreColumns = 700;        // with waves
constexpr std::size_t kLongSum = 16;             // nodes
constexpr std::size_t kOrders = 1500;            // of the search for fewer variables, a round
constexpr std::uint64_t kReduced = 500'000'000;  // node-rows for reductions, half a second
constexpr std::size_t kShort = 14;     // nodes of an exact formula: another way is hardly shorter
constexpr std::size_t kTried = 60;     // of reductions, most of them not true
constexpr std::size_t kMoreWays = 5;   // that are looked at when one has explained the rows
constexpr std::size_t kProblems = 16;  // in fewer variables that are looked at
constexpr std::size_t kMostDepth = 3;  // of reductions
// A surrogate's error, of the target's spread, below which noise is no matter.
constexpr double kSurelyExact = 3e-3;
constexpr double kQuarter = 0.25;      // of the seconds that are left, for a search for structure
constexpr double kMost = 0.6;          // for reductions, which end by themselves
constexpr double kOfAMember = 0.9;     // the rest is for what is done with its choice
constexpr double kHalf = 0.5;          // for a method on fewer variables
constexpr std::size_t kFewInputs = 3;  // with which waves and differences are tried at once

// What can be left out, to see what it is worth; the members besides, by their names.
constexpr std::string_view kNothing = "nothing";
constexpr std::string_view kProducts = "products";
constexpr std::string_view kSums = "sums";
constexpr std::string_view kCollapses = "collapses";
constexpr std::string_view kReductions = "reductions";
constexpr std::string_view kGuesses = "guesses";
constexpr std::string_view kWideSums = "wide_sums";
constexpr std::string_view kLikely = "likely";
constexpr std::string_view kPruning = "pruning";

constexpr std::string_view kByProduct = "a product of powers";
constexpr std::string_view kBySum = "a sum of products";
constexpr std::string_view kByRoot = "a root of a quadratic equation";
constexpr std::string_view kByReduction = "fewer variables";

enum class Width { narrow, wide };  // wide: with factors (factors.hpp)

// One fit: what it has found so far.
class Run {
 public:
  Run(FitContext& context, std::string_view without)
      : context_(context),
        without_(without),
        rows_(context.data),
        admission_(context),
        joint_(rows_.table(), rows_.target, rows_.movement, input_box(context.data.inputs)) {}

  bool has_rows() const { return rows_.rows() > 0; }
  bool has_formula() const { return !joint_.empty(); }
  bool is_short() { return has_formula() && joint_.formulas()[joint_.chosen()].size() <= kShort; }
  bool is_done() const {
    return joint_.is_explained() || context_.budget.remaining() == 0 ||
           context_.budget.out_of_time() || context_.budget.exhausted();
  }

  // Fits the constants of a formula, if there is one, to all rows and adds it.
  void offer(std::optional<Expression> found, std::string_view found_by) {
    if (!found || !admission_.admits(*found)) return;
    Expression formula = std::move(*found);
    ConstantFitOptions options;
    options.function_tolerance = 1e-14;
    const ConstantFitResult fit =
        ConstantFitter().fit(formula, rows_.table(), rows_.target, {}, options);
    context_.budget.spend(fit.node_rows);
    if (fit.status == FitStatus::not_finite) return;
    joint_.add(std::array{std::move(formula)}, std::nullopt);
    if (joint_.is_explained() && explained_by_.empty()) explained_by_ = found_by;
  }

  // What structure is likely under noise: weighed beside the members' choices.
  void search_likely(int round) {
    const LogRows rows(rows_, kFewRows);
    if (round > 0 || is_done() || rows.rows() == 0 || !has(kLikely)) return;
    if (roughness_ < kSurelyExact) return;
    Budget part = context_.budget.share(context_.budget.remaining() / 4, kQuarter);
    std::vector<Expression> likely = relay::likely_products(rows, context_.operators, part);
    for (const auto& [columns, most] : {std::pair(Columns::powers_alone, kLikelyColumns),
                                        std::pair(Columns::with_factors, kLikelyWaves)}) {
      std::ranges::move(relay::likely_relations(rows, context_.operators, columns, most, part),
                        std::back_inserter(likely));
    }
    offer_likeliest(std::move(likely), part);
    context_.budget.settle(part);
  }

  // Of formulas whose constants are still to be fitted those with the most evidence; a pole in the
  // ranges of the inputs is noise that was fitted.
  void offer_likeliest(std::vector<Expression> formulas, Budget& budget) {
    JointFront likely(rows_.table(), rows_.target, rows_.movement, {});
    ConstantFitter fitter;
    for (Expression& formula : formulas) {
      if (!budget.in_time()) break;
      if (!admission_.admits(formula)) continue;
      const ConstantFitResult fit = fitter.fit(formula, rows_.table(), rows_.target);
      budget.spend(fit.node_rows);
      if (fit.status != FitStatus::not_finite) likely.add(std::array{std::move(formula)}, 0);
    }
    const InputBox box = input_box(context_.data.inputs);
    for (const Expression& formula : likely.likeliest(kLikelyTaken)) {
      if (!budget.in_time()) break;
      if (prove_free(formula, box).verdict == Verdict::refuted) continue;
      joint_.add(std::array{formula}, 0);
    }
  }

  // The same formula with fewer numbers, where the rows do not mind.
  void prune(const Expression& formula) {
    if (joint_.is_explained() || !has(kPruning)) return;
    Budget part = context_.budget.share(context_.budget.remaining() / 4, kHalf);
    Expression pruned = pruned_by_evidence(
        formula, rows_.table(), rows_.target, input_box(context_.data.inputs),
        [&part](std::uint64_t node_rows) { return part.spend(node_rows) && part.in_time(); });
    context_.budget.settle(part);
    if (pruned == formula || !admission_.admits(pruned)) return;
    joint_.add(std::array{std::move(pruned)}, 0);
  }
  void prune_likeliest() {
    if (has_formula()) prune(joint_.likeliest(1)[0]);
  }

  // Each round looks at more than the one before, up to eight times as much.
  void search_structure(const Regressor& solver, int round) {
    const LogRows rows(rows_, kSearchedRows);
    if (rows.rows() == 0 || round > 3) return;
    Budget part = context_.budget.share(context_.budget.remaining() / 4, kQuarter);
    auto simpler = find_structure(rows, round, part);
    context_.budget.settle(part);
    if (has(kReductions)) {
      auto reduced = reduce(round, relay::Guesses::no);
      if (reduced && !simpler) simpler = std::move(reduced);
    }
    if (round == 0 && has(kSums) && !is_done()) search_waves();
    if (simpler && !is_done()) search(*simpler, solver);
  }

  // The same where no slope says so, by trial: dear, and seldom needed.
  void search_guesses(const Regressor& solver, int round) {
    if (!has(kGuesses)) return;
    const auto simpler = reduce(round, relay::Guesses::yes);
    if (simpler && !is_done()) search(*simpler, solver);
  }

  // Sums of products with waves and differences: many, and seldom what a law is.
  void search_wide_sums(int round) {
    const LogRows rows(rows_, kSearchedRows);
    if (rows.rows() == 0 || round > 3 || !has(kWideSums)) return;
    Budget part = context_.budget.share(context_.budget.remaining() / 4, kQuarter);
    offer(relay::find_relation(rows, context_.operators, Columns::with_factors,
                               3 * kColumns << round, part),
          kBySum);
    if (!is_done()) {
      offer(relay::find_root(rows, context_.operators, Columns::with_factors, 2 * kColumns << round,
                             part),
            kByRoot);
    }
    context_.budget.settle(part);
  }

  void run_member(const std::string& name, const Regressor& method, std::uint64_t evaluations) {
    Budget part = context_.budget.share(evaluations, kOfAMember);
    FitContext turn{context_.data,    context_.operators, part, context_.random.split(name),
                    context_.threads, context_.progress};
    const FitResult result = method.fit(turn);
    context_.budget.settle(part);
    if (result.front.empty()) {
      if (result.note.empty()) return;
      note_ += fmt::format("{}{}: {}", note_.empty() ? "" : "; ", name, result.note);
      return;
    }
    joint_.add(result.front, result.chosen);
    if (joint_.is_explained() && explained_by_.empty()) explained_by_ = name;
    prune(result.front[result.chosen]);
  }

  std::uint64_t remaining() const { return context_.budget.remaining(); }

  FitResult result() && {
    if (joint_.empty()) return FitResult::unsupported(std::move(note_));
    if (!explained_by_.empty()) {
      note_ += fmt::format("{}explained by {}", note_.empty() ? "" : "; ", explained_by_);
    }
    FitResult result{joint_.formulas(), joint_.chosen(),
                     context_.budget.exhausted() ? StopReason::budget : StopReason::converged,
                     std::move(note_)};
    result.yields_to_plain_sum = true;
    return result;
  }

 private:
  // What is exact is offered; the return is a problem of fewer variables that was not solved.
  std::optional<ReducedProblem> find_structure(const LogRows& rows, int round, Budget& budget);
  void search_waves();
  // The reduced problem with the fewest inputs that was not solved.
  std::optional<ReducedProblem> reduce(int round, relay::Guesses guesses);
  // What is exact is offered.
  void solve(const ReducedProblem& problem, Width width, Budget& budget);
  void search(const ReducedProblem& problem, const Regressor& solver);
  ReducedProblem whole() const { return {context_.data.inputs, rows_}; }
  ReducedProblem collapsed(const relay::Collapse& collapse) const {
    return {whole(), Reduction{relay::TargetForm::plain, false, collapse.outer, {collapse.inner}}};
  }

  bool has(std::string_view part) const { return without_ != part; }

  FitContext& context_;
  std::string_view without_;
  FiniteRows rows_;
  Admission admission_;
  JointFront joint_;
  std::string note_;
  std::string explained_by_;
  double roughness_ = HUGE_VAL;  // of the whole problem's surrogates: no more noise than this
};

// Sums and roots with waves: many columns, of fewer rows.
void Run::search_waves() {
  const LogRows rows(rows_, kFewRows);
  Budget budget = context_.budget.share(context_.budget.remaining() / 4, kQuarter);
  const OperatorSet& operators = context_.operators;
  offer(relay::find_root(rows, operators, Columns::with_factors, kColumns, budget), kByRoot);
  if (!is_done()) {
    offer(relay::find_relation(rows, operators, Columns::with_factors, kMoreColumns, budget),
          kBySum);
  }
  context_.budget.settle(budget);
}

std::optional<ReducedProblem> Run::find_structure(const LogRows& rows, int round, Budget& budget) {
  const std::size_t width = std::size_t{1} << round;
  const OperatorSet& operators = context_.operators;
  if (round == 0) {
    if (has(kProducts)) offer(relay::find_product(rows, operators, budget), kByProduct);
    if (is_done()) return std::nullopt;
    std::optional<Expression> sum;
    if (has(kSums)) {
      sum = relay::find_relation(rows, operators, Columns::powers_alone, kColumns, budget);
    }
    offer(sum, kBySum);
    // A long sum of powers may be a short one of differences.
    if (sum && sum->size() > kLongSum) {
      offer(relay::find_relation(rows, operators, Columns::with_factors, kColumns, budget), kBySum);
    }
    if (is_done()) return std::nullopt;
    if (!is_done() && context_.data.inputs.size() == 1) solve(whole(), Width::narrow, budget);
    if (is_done()) return std::nullopt;
  }
  if (!has(kCollapses)) return std::nullopt;
  const auto collapses =
      relay::find_collapses(rows, operators, kOrders * width, kMostCollapses, budget);
  for (const relay::Collapse& collapse : collapses) {
    solve(collapsed(collapse), Width::narrow, budget);
    if (is_done()) return std::nullopt;
  }
  if (collapses.empty() || !collapses[0].is_smooth) return std::nullopt;
  return collapsed(collapses[0]);
}

// g among products, short sums and known functions.
void Run::solve(const ReducedProblem& problem, Width width, Budget& budget) {
  const FiniteRows all(problem.data());
  const LogRows rows(all, kSearchedRows);
  if (rows.rows() == 0) return;
  const OperatorSet& operators = context_.operators;
  const auto try_g = [&](const std::optional<Expression>& g) {
    if (g) offer(problem.restored(*g), kByReduction);
  };
  try_g(relay::find_product(rows, operators, budget));
  // All: the front's choice takes the shortest, and tells tanh x from x - x^3/3 where x is small.
  try_g(relay::find_relation(rows, operators, Columns::powers_alone, kColumns, budget));
  if (problem.inputs() == 1) {
    try_g(relay::find_function(rows, operators, budget));
    if (!is_done()) try_g(relay::find_scaled_function(rows, operators, budget));
  }
  if (width == Width::narrow || problem.inputs() > kFewInputs || is_done()) return;
  const std::size_t columns = problem.inputs() == 1 ? kColumns / 5 : 2 * kColumns;
  try_g(relay::find_relation(rows, operators, Columns::with_factors, columns, budget));
}

// g by another method.
void Run::search(const ReducedProblem& problem, const Regressor& solver) {
  const TrainingData data = problem.data();
  Budget part = context_.budget.share(context_.budget.remaining() / 4, kHalf);
  FitContext turn{
      data, context_.operators, part, context_.random.split("reduced"), context_.threads, nullptr};
  const FitResult found = solver.fit(turn);
  context_.budget.settle(part);
  for (const Expression& g : found.front) offer(problem.restored(g), kByReduction);
}

// What slopes say before guesses, and of these the problem with the fewest inputs: it is looked at
// next, and reduced further.
std::optional<ReducedProblem> Run::reduce(int round, relay::Guesses guesses) {
  const OperatorSet& operators = context_.operators;
  const bool is_possible = operators.allows(Op::mul) && operators.allows(Op::div);
  if ((is_done() && is_short()) || round > 0 || !is_possible || rows_.rows() == 0)
    return std::nullopt;
  const std::uint64_t most = guesses == relay::Guesses::yes ? 3 * kReduced : kReduced;
  Budget budget = context_.budget.share(std::min(context_.budget.remaining() / 4, most), kMost);
  std::vector<ReducedProblem> open;
  open.push_back(whole());
  std::vector<ReducedProblem> seen;
  std::size_t tried = 0;
  std::size_t after = 0;  // looked at since the rows were explained: there may be a shorter way
  while (!open.empty() && seen.size() < kProblems && tried < kTried && after < kMoreWays &&
         !budget.exhausted()) {
    const auto next = std::ranges::min_element(open, {}, [](const ReducedProblem& problem) {
      return std::pair(problem.is_guess(), problem.inputs());
    });
    ReducedProblem problem = std::move(*next);
    open.erase(next);
    const auto is_same = [&](const ReducedProblem& other) { return other.is_same_as(problem); };
    if (std::ranges::any_of(seen, is_same)) continue;
    ++tried;
    const FiniteRows all(problem.data());
    const LogRows rows(all, kSearchedRows);
    relay::Reductions further = relay::find_reductions(rows, guesses, budget);
    if (!(further.roughness <= problem.most_roughness())) continue;
    problem.set_roughness(further.roughness);
    if (problem.depth() == 0) roughness_ = further.roughness;
    if (problem.depth() > 0) solve(problem, Width::wide, budget);
    for (Reduction& each : further.list) {
      if (problem.depth() < kMostDepth) open.emplace_back(problem, std::move(each));
    }
    seen.push_back(std::move(problem));
    if (is_done() && seen.back().depth() > 0) ++after;
  }
  context_.budget.settle(budget);
  const auto fewest = std::ranges::min_element(seen, {}, &ReducedProblem::inputs);
  if (fewest == seen.end() || fewest->depth() == 0) return std::nullopt;
  return std::move(*fewest);
}

class Relay : public Regressor {
 public:
  Relay(int round, std::string without, const MakeMethod& other)
      : round_(round), without_(std::move(without)), solver_(other("pysr", 0)) {
    for (const char* name : kMembers) {
      if (without_ != name) members_.push_back({name, other(name, round)});
    }
  }

  FitResult fit(FitContext& context) const override {
    Run run(context, without_);
    if (!run.has_rows()) return FitResult::unsupported("no row has a finite target and inputs");
    run.search_structure(*solver_, round_);
    run.search_likely(round_);
    if (run.is_done() && run.has_formula() && !run.is_short()) {
      run.search_guesses(*solver_, round_);
    }
    for (std::size_t k = 0; k < members_.size(); ++k) {
      // The first runs whatever is left; the others where there is something to spend, and to find.
      if (run.is_done() && run.has_formula()) break;
      run.run_member(members_[k].name, *members_[k].method,
                     run.remaining() / (members_.size() - k));
      if (k > 0 || run.is_done()) continue;
      run.search_wide_sums(round_);
      run.search_guesses(*solver_, round_);
    }
    run.prune_likeliest();
    return std::move(run).result();
  }

 private:
  struct Member {
    std::string name;
    std::unique_ptr<Regressor> method;
  };
  int round_;
  std::string without_;
  std::unique_ptr<Regressor> solver_;  // of problems with one input
  std::vector<Member> members_;
};

}  // namespace

AlgorithmEntry relay_entry() {
  AlgorithmEntry entry;
  entry.name = "relay";
  entry.summary =
      "structure (products, sums, fewer variables), then pysr, udsr and parfam, on one front";
  std::vector<std::string> choices;
  for (const std::string_view part : {kNothing, kProducts, kSums, kCollapses, kReductions, kGuesses,
                                      kWideSums, kLikely, kPruning}) {
    choices.emplace_back(part);
  }
  choices.insert(choices.end(), kMembers.begin(), kMembers.end());
  entry.parameters = {
      {"round", "how wide the members search: 0 as by themselves", std::int64_t{0}, 0, 1000},
      {"without", "a part that is left out, to see what it is worth", std::string(kNothing), 0, 0,
       choices}};
  entry.make = [](const Parameters& parameters,
                  const MakeMethod& other) -> std::unique_ptr<Regressor> {
    return std::make_unique<Relay>(static_cast<int>(parameters.integer("round")),
                                   parameters.text("without"), other);
  };
  entry.widened = [](int round) {
    return std::map<std::string, ParameterValue>{{"round", std::int64_t{round}}};
  };
  return entry;
}

}  // namespace tribench
