// SPDX-License-Identifier: MIT
#include "harness/finished_front.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "algorithms/admission.hpp"
#include "algorithms/expression/complexity.hpp"
#include "algorithms/finite_rows.hpp"
#include "algorithms/fitting/crossed_rows.hpp"
#include "algorithms/fitting/evaluation_error.hpp"
#include "algorithms/fitting/evidence.hpp"
#include "algorithms/fitting/exact_choice.hpp"
#include "algorithms/fitting/finish.hpp"
#include "algorithms/fitting/free_constants.hpp"
#include "algorithms/fitting/held_out_choice.hpp"
#include "algorithms/fitting/shape_dimension.hpp"

namespace tribench {
namespace {

// In its place by complexity.
void choose(Expression formula, FitResult& fit) {
  const int size = paper_complexity(formula);
  const auto place = std::ranges::find_if(
      fit.front, [size](const Expression& other) { return paper_complexity(other) >= size; });
  fit.chosen = static_cast<std::size_t>(place - fit.front.begin());
  fit.front.insert(place, std::move(formula));
}

// Shortened, a long formula may be the shortest. The chosen one stays chosen.
void sort_by_complexity(FitResult& fit) {
  std::vector<std::pair<int, std::size_t>> order;  // complexity, place before
  for (std::size_t i = 0; i < fit.front.size(); ++i) {
    order.emplace_back(paper_complexity(fit.front[i]), i);
  }
  std::ranges::sort(order);
  std::vector<Expression> sorted;
  std::size_t chosen = 0;
  for (const auto& [complexity, before] : order) {
    if (before == fit.chosen) chosen = sorted.size();
    sorted.push_back(std::move(fit.front[before]));
  }
  fit.front = std::move(sorted);
  fit.chosen = chosen;
}

// How many times the mean square of what strays the rest may have and still be as good: a power
// that fits the noise of a row wins a few hundredths (docs/settled.md).
constexpr double kAsGood = 4;

// Infinite where a value is not finite.
std::vector<double> mean_squares(std::span<const Expression> front, const FiniteRows& rows) {
  Evaluator evaluator;
  std::vector<double> squares;
  for (const Expression& formula : front) {
    const ErrorSum sum = evaluator.sum_squared_errors(formula, rows.table(), rows.target);
    squares.push_back(sum.status == ErrorSumStatus::complete
                          ? sum.sum / static_cast<double>(rows.rows())
                          : std::numeric_limits<double>::infinity());
  }
  return squares;
}

// The place of the one with the most evidence.
std::size_t likeliest(std::span<const Expression> front, const FiniteRows& rows) {
  double zero_loss = 0;
  for (const double y : rows.target) zero_loss += y * y / static_cast<double>(rows.rows());
  const std::vector<double> squares = mean_squares(front, rows);
  std::vector<double> against;
  for (std::size_t i = 0; i < front.size(); ++i) {
    against.push_back(evidence_against(front[i], squares[i], zero_loss, rows.rows()));
  }
  return static_cast<std::size_t>(std::ranges::min_element(against) - against.begin());
}

// Formulas whose value is lost in rounding go, and those that nobody would want between the rows
// where a simpler one is as good on them, unless nothing else is there. A choice that goes gives
// way to what has the most evidence of the rest.
void drop_strays(const FiniteRows& rows, const InputBox& box, FitResult& fit) {
  if (rows.rows() == 0) return;
  CrossedRows crossed(rows.table(), rows.target, box);
  const std::vector<double> squares = mean_squares(fit.front, rows);
  bool is_choice_lost = false;
  std::vector<Expression> kept;
  std::optional<std::size_t> chosen;
  double least = std::numeric_limits<double>::infinity();  // of what is kept
  for (std::size_t i = 0; i < fit.front.size(); ++i) {
    const bool is_lost = loses_its_digits(fit.front[i], rows.table(), rows.target);
    if (i == fit.chosen && is_lost) is_choice_lost = true;
    const bool has_equal = least <= kAsGood * squares[i];
    if (is_lost || (has_equal && crossed.strays(fit.front[i]))) continue;
    if (i == fit.chosen) chosen = kept.size();
    least = std::min(least, squares[i]);
    kept.push_back(fit.front[i]);
  }
  const std::size_t strays = fit.front.size() - kept.size();
  if (strays == 0 || kept.empty()) return;
  fit.front = std::move(kept);
  fit.chosen = chosen ? *chosen : likeliest(fit.front, rows);
  if (chosen) return;
  fit.note +=
      fmt::format("{}another choice: {}", fit.note.empty() ? "" : "; ",
                  is_choice_lost ? "the value of the search's is lost in rounding"
                                 : "with inputs as in the rows, combined otherwise, that of "
                                   "the search is ten times the target's range away");
}

}  // namespace

void leave_saturated(const FiniteRows& rows, FitResult& fit) {
  constexpr std::size_t kRowsANumber = 2;
  const auto is_saturated = [&](const Expression& formula) {
    return kRowsANumber * (shape_dimension(formula) + free_exponents(formula)) > rows.rows();
  };
  if (!is_saturated(fit.front[fit.chosen])) return;
  std::vector<Expression> rest;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < fit.front.size(); ++i) {
    if (is_saturated(fit.front[i])) continue;
    rest.push_back(fit.front[i]);
    places.push_back(i);
  }
  if (rest.empty()) return;
  fit.chosen = places[likeliest(rest, rows)];
  constexpr std::string_view kWhy =
      "another choice: that of the search has a number for every other row";
  if (fit.note.find(kWhy) != std::string::npos) return;
  fit.note += fmt::format("{}{}", fit.note.empty() ? "" : "; ", kWhy);
}

void finish_front(const TrainingData& data, const OperatorSet& operators, Budget& budget,
                  FitResult& fit) {
  // With states, a formula's numbers stand in the laws too: it is left as it is.
  if (fit.keeps_form || fit.front.empty() || !fit.states.empty()) return;
  const FiniteRows rows(data);
  const InputBox box = input_box(data.inputs);
  FormulaFinisher finisher(rows.table(), rows.target, box,
                           [&](const Expression& formula) { return operators.admits(formula); });
  std::vector<Expression> finished;
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < fit.front.size(); ++i) {
    Expression formula = finisher.finish(fit.front[i]);
    if (!keeps_priors(formula, data.inputs)) formula = fit.front[i];
    const auto same = std::ranges::find(finished, formula);
    if (i == fit.chosen) chosen = static_cast<std::size_t>(same - finished.begin());
    if (same == finished.end()) finished.push_back(std::move(formula));
  }
  fit.front = std::move(finished);
  fit.chosen = chosen;
  sort_by_complexity(fit);
  if (fit.keeps_choice) return;
  if (const auto exact = simplest_exact(fit.front, rows.table(), rows.target)) {
    fit.chosen = *exact;
    return;
  }
  drop_strays(rows, box, fit);
  const auto in_time = [&budget] { return budget.in_time(); };
  fit.chosen =
      held_out_choice(fit.front, fit.chosen, rows.table(), rows.target, rows.movement, in_time);
  leave_saturated(rows, fit);
  if (!fit.yields_to_plain_sum) return;
  if (auto sum = plain_sum_instead(fit.front[fit.chosen], rows.table(), rows.target, rows.movement,
                                   in_time);
      sum && operators.admits(*sum)) {
    choose(std::move(*sum), fit);
  }
}

}  // namespace tribench
