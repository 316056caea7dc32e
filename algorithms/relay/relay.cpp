// SPDX-License-Identifier: MIT
#include "algorithms/relay/relay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "algorithms/admission.hpp"
#include "algorithms/finite_rows.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "algorithms/fitting/joint_front.hpp"
#include "algorithms/relay/collapse.hpp"
#include "algorithms/relay/index_fit.hpp"
#include "algorithms/relay/log_rows.hpp"
#include "algorithms/relay/product_search.hpp"
#include "algorithms/relay/relation_search.hpp"

namespace tribench {
namespace {

using relay::Columns;
using relay::LogRows;

// In the order in which they run: where time is short, the one that finds most alone comes first.
constexpr std::array kMembers = {"pysr", "udsr", "parfam"};
// Rows that the searches for structure look at.
constexpr std::size_t kSearchedRows = 512;
constexpr std::size_t kMostCollapses = 3;
constexpr std::size_t kColumns = 500;  // of the search for relations, a round
constexpr std::size_t kLongSum = 16;   // nodes
constexpr std::size_t kOrders = 1500;  // of the search for fewer variables, a round

constexpr std::string_view kByProduct = "a product of powers";
constexpr std::string_view kBySum = "a sum of products";
constexpr std::string_view kByCollapse = "fewer variables";

// One fit: what it has found so far.
class Run {
 public:
  explicit Run(FitContext& context)
      : context_(context),
        rows_(context.data),
        admission_(context),
        joint_(rows_.table(), rows_.target) {}

  bool has_rows() const { return rows_.rows() > 0; }
  bool has_formula() const { return !joint_.formulas().empty(); }
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
    joint_.add(std::array{std::move(formula)}, 0);
    if (joint_.is_explained() && explained_by_.empty()) explained_by_ = found_by;
  }

  // Each round looks at more than the one before, up to eight times as much.
  void search_structure(const Regressor& solver, int round) {
    const LogRows rows(rows_, kSearchedRows);
    if (rows.rows() == 0 || round > 3) return;
    Budget part = context_.budget.share(context_.budget.remaining() / 4);
    const auto smooth = find_structure(rows, round, part);
    context_.budget.settle(part);
    if (smooth && !is_done()) search_collapsed(*smooth, solver);
  }

  // Sums of products with waves and differences: many, and seldom what a law is.
  void search_wide_sums(int round) {
    const LogRows rows(rows_, kSearchedRows);
    if (rows.rows() == 0 || round > 3) return;
    Budget part = context_.budget.share(context_.budget.remaining() / 4);
    offer(relay::find_relation(rows, context_.operators, Columns::with_factors,
                               3 * kColumns << round, part),
          kBySum);
    context_.budget.settle(part);
  }

  void run_member(const std::string& name, const Regressor& method, std::uint64_t evaluations) {
    Budget part = context_.budget.share(evaluations);
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
  }

  std::uint64_t remaining() const { return context_.budget.remaining(); }

  FitResult result() && {
    if (joint_.formulas().empty()) return FitResult::unsupported(std::move(note_));
    if (!explained_by_.empty()) {
      note_ += fmt::format("{}explained by {}", note_.empty() ? "" : "; ", explained_by_);
    }
    return {joint_.formulas(), joint_.chosen(),
            context_.budget.exhausted() ? StopReason::budget : StopReason::converged,
            std::move(note_)};
  }

 private:
  // g as a problem of one input.
  struct Reduced {
    std::vector<double> argument;
    std::vector<double> target;
    Input input;
  };
  Reduced reduced(const relay::Collapse& collapse) const;
  // What is exact is offered; the return is a problem of fewer variables that was not solved.
  std::optional<relay::Collapse> find_structure(const LogRows& rows, int round, Budget& budget);
  void solve_collapsed(const relay::Collapse& collapse, Budget& budget);
  void search_collapsed(const relay::Collapse& collapse, const Regressor& solver);

  FitContext& context_;
  FiniteRows rows_;
  Admission admission_;
  JointFront joint_;
  std::string note_;
  std::string explained_by_;
};

// outer * g(inner).
Expression composed(const relay::Collapse& collapse, const Expression& g) {
  std::vector<Node> nodes(collapse.outer.nodes().begin(), collapse.outer.nodes().end());
  for (const Node& node : g.nodes()) {
    if (node.is_variable()) {
      const auto inner = collapse.inner.nodes();
      nodes.insert(nodes.end(), inner.begin(), inner.end());
    } else {
      nodes.push_back(node);
    }
  }
  nodes.push_back({0, 1, 0, Op::mul});
  return Expression(std::move(nodes));
}

Run::Reduced Run::reduced(const relay::Collapse& collapse) const {
  Reduced problem{std::vector<double>(rows_.rows()), std::vector<double>(rows_.rows()), {}};
  Evaluator evaluator;
  evaluator.evaluate(collapse.inner, rows_.table(), problem.argument);
  evaluator.evaluate(collapse.outer, rows_.table(), problem.target);
  for (std::size_t r = 0; r < rows_.rows(); ++r) {
    problem.target[r] = rows_.target[r] / problem.target[r];
    if (std::isfinite(problem.argument[r])) continue;
    problem.target[r] = problem.argument[r];  // no row of the problem: FiniteRows leaves it out
  }
  problem.input.name = "p";
  for (const double x : problem.argument) {
    if (!std::isfinite(x)) continue;
    problem.input.low = std::min(problem.input.low, x);
    problem.input.high = std::max(problem.input.high, x);
  }
  return problem;
}

std::optional<relay::Collapse> Run::find_structure(const LogRows& rows, int round, Budget& budget) {
  const std::size_t width = std::size_t{1} << round;
  const OperatorSet& operators = context_.operators;
  if (round == 0) {
    offer(relay::find_product(rows, operators, budget), kByProduct);
    if (is_done()) return std::nullopt;
    const auto sum = relay::find_relation(rows, operators, Columns::powers_alone, kColumns, budget);
    offer(sum, kBySum);
    // A long sum of powers may be a short one of differences.
    if (sum && sum->size() > kLongSum) {
      offer(relay::find_relation(rows, operators, Columns::with_factors, kColumns, budget), kBySum);
    }
    if (is_done()) return std::nullopt;
  }
  const auto collapses =
      relay::find_collapses(rows, operators, kOrders * width, kMostCollapses, budget);
  for (const relay::Collapse& collapse : collapses) {
    solve_collapsed(collapse, budget);
    if (is_done()) return std::nullopt;
  }
  if (collapses.empty() || !collapses[0].is_smooth) return std::nullopt;
  return collapses[0];
}

// g among known functions and short sums.
void Run::solve_collapsed(const relay::Collapse& collapse, Budget& budget) {
  const Reduced problem = reduced(collapse);
  const double* column = problem.argument.data();
  const FiniteRows all({{&problem.input, 1}, {&column, 1}, problem.target, {}});
  const LogRows rows(all, kSearchedRows);
  if (rows.rows() == 0) return;
  const auto try_g = [&](const std::optional<Expression>& g) {
    if (g) offer(composed(collapse, *g), kByCollapse);
  };
  // Both: tanh x is close to x - x^3/3 where x is small, and the front's choice tells them apart.
  try_g(relay::find_relation(rows, context_.operators, Columns::powers_alone, kColumns, budget));
  try_g(relay::find_function(rows, context_.operators, budget));
}

// g by another method.
void Run::search_collapsed(const relay::Collapse& collapse, const Regressor& solver) {
  const Reduced problem = reduced(collapse);
  const double* column = problem.argument.data();
  const TrainingData data{{&problem.input, 1}, {&column, 1}, problem.target, {}};
  Budget part = context_.budget.share(context_.budget.remaining() / 4);
  FitContext turn{
      data,   context_.operators, part, context_.random.split("collapsed"), context_.threads,
      nullptr};
  const FitResult found = solver.fit(turn);
  context_.budget.settle(part);
  for (const Expression& g : found.front) offer(composed(collapse, g), kByCollapse);
}

class Relay : public Regressor {
 public:
  Relay(int round, const MakeMethod& other) : round_(round), solver_(other("pysr", 0)) {
    for (const char* name : kMembers) members_.push_back({name, other(name, round)});
  }

  FitResult fit(FitContext& context) const override {
    Run run(context);
    if (!run.has_rows()) return FitResult::unsupported("no row has a finite target and inputs");
    run.search_structure(*solver_, round_);
    for (std::size_t k = 0; k < members_.size(); ++k) {
      // The first runs whatever is left; the others where there is something to spend, and to find.
      if (run.is_done() && run.has_formula()) break;
      run.run_member(members_[k].name, *members_[k].method,
                     run.remaining() / (members_.size() - k));
      if (k == 0 && !run.is_done()) run.search_wide_sums(round_);
    }
    return std::move(run).result();
  }

 private:
  struct Member {
    std::string name;
    std::unique_ptr<Regressor> method;
  };
  int round_;
  std::unique_ptr<Regressor> solver_;  // of problems with one input
  std::vector<Member> members_;
};

}  // namespace

AlgorithmEntry relay_entry() {
  AlgorithmEntry entry;
  entry.name = "relay";
  entry.summary =
      "structure (products, sums, fewer variables), then pysr, udsr and parfam, on one front";
  entry.parameters = {
      {"round", "how wide the members search: 0 as by themselves", std::int64_t{0}, 0, 1000}};
  entry.make = [](const Parameters& parameters,
                  const MakeMethod& other) -> std::unique_ptr<Regressor> {
    return std::make_unique<Relay>(static_cast<int>(parameters.integer("round")), other);
  };
  entry.widened = [](int round) {
    return std::map<std::string, ParameterValue>{{"round", std::int64_t{round}}};
  };
  return entry;
}

}  // namespace tribench
