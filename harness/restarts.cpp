// SPDX-License-Identifier: MIT
#include "harness/restarts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "algorithms/expression/complexity.hpp"
#include "algorithms/finite_rows.hpp"
#include "algorithms/fitting/evidence.hpp"
#include "algorithms/fitting/exact_choice.hpp"

namespace tribench {
namespace {

class Rounds {
 public:
  Rounds(FitResult first, const TrainingData& data) : rows_(data), result_(std::move(first)) {
    for (const double y : rows_.target) zero_loss_ += y * y / static_cast<double>(rows_.rows());
  }

  bool is_explained() {
    return simplest_exact(result_.front, rows_.table(), rows_.target).has_value();
  }

  void add(const FitResult& round) {
    const Expression ours = result_.front[result_.chosen];
    const Expression& theirs = round.front[round.chosen];
    const Expression chosen = against(theirs) < against(ours) ? theirs : ours;
    for (const Expression& formula : round.front) {
      if (std::ranges::count(result_.front, formula) == 0) result_.front.push_back(formula);
    }
    keep_the_front(chosen);
  }

  FitResult take() {
    if (const auto exact = simplest_exact(result_.front, rows_.table(), rows_.target)) {
      result_.chosen = *exact;
    }
    return std::move(result_);
  }

 private:
  double mean_square(const Expression& formula) {
    const ErrorSum sum = evaluator_.sum_squared_errors(formula, rows_.table(), rows_.target);
    if (sum.status != ErrorSumStatus::complete) return HUGE_VAL;
    return sum.sum / static_cast<double>(rows_.rows());
  }
  double against(const Expression& formula) {
    const double error = mean_square(formula);
    if (std::isinf(error)) return error;
    return evidence_against(formula, error, zero_loss_, rows_.rows());
  }

  // By increasing complexity, each with less error than all before it; the chosen one stays.
  void keep_the_front(const Expression& chosen) {
    struct Member {
      int complexity;
      double error;
      Expression formula;
    };
    std::vector<Member> all;
    for (Expression& formula : result_.front) {
      all.push_back({paper_complexity(formula), mean_square(formula), std::move(formula)});
    }
    std::ranges::stable_sort(all, [](const Member& a, const Member& b) {
      return a.complexity != b.complexity ? a.complexity < b.complexity : a.error < b.error;
    });
    result_.front.clear();
    double best = HUGE_VAL;
    for (Member& member : all) {
      const bool is_chosen = member.formula == chosen;
      if (!(member.error < best) && !is_chosen) continue;
      best = std::min(best, member.error);
      if (is_chosen) result_.chosen = result_.front.size();
      result_.front.push_back(std::move(member.formula));
    }
  }

  FiniteRows rows_;
  Evaluator evaluator_;
  FitResult result_;
  double zero_loss_ = 0;
};

}  // namespace

FitResult fit_until_spent(FitResult first, const FitRound& round, const TrainingData& data,
                          const Budget& budget, const RandomStream& random) {
  if (first.front.empty()) return first;
  std::vector<Expression> before = first.front;
  Rounds rounds(std::move(first), data);
  int count = 0;
  while (!rounds.is_explained() && budget.remaining() > 0 && budget.remaining_seconds() > 0 &&
         !budget.out_of_time()) {
    const std::uint64_t spent = budget.spent();
    const FitResult next = round(random.split(static_cast<std::uint64_t>(count)));
    if (next.front.empty() || budget.spent() == spent) break;
    ++count;
    rounds.add(next);
    if (std::exchange(before, next.front) == next.front) break;
  }
  FitResult result = rounds.take();
  if (count > 0) {
    result.reason = budget.exhausted() ? StopReason::budget : StopReason::converged;
    result.note += fmt::format("{}{} restart{}", result.note.empty() ? "" : "; ", count,
                               count == 1 ? "" : "s");
  }
  return result;
}

}  // namespace tribench
