// SPDX-License-Identifier: MIT
//
// relay's searches for structure in their order: products, short sums, one function of one product,
// fewer variables, waves and differences; by guesses where no slope speaks, and by evidence where
// there is noise. What is found is offered to the answer.
//
// Not for noise that is mistaken for structure: but for what is likely under noise a law is
// accepted only where it is exact to rounding. Each search may spend a quarter of what is left, and
// all are over at once where the answer is done.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "algorithms/regressor.hpp"
#include "algorithms/relay/answer.hpp"
#include "algorithms/relay/collapse.hpp"
#include "algorithms/relay/function_sum.hpp"
#include "algorithms/relay/log_rows.hpp"
#include "algorithms/relay/part_search.hpp"
#include "algorithms/relay/reduced_problem.hpp"
#include "algorithms/relay/reduction.hpp"

namespace tribench::relay {

// Searches that can be left out by their names, to see what each is worth.
inline constexpr std::string_view kProducts = "products";
inline constexpr std::string_view kSums = "sums";
inline constexpr std::string_view kFunctionSums = "function_sums";
inline constexpr std::string_view kCollapses = "collapses";
inline constexpr std::string_view kReductions = "reductions";
inline constexpr std::string_view kParts = "parts";
inline constexpr std::string_view kGuesses = "guesses";
inline constexpr std::string_view kWideSums = "wide_sums";
inline constexpr std::string_view kLikely = "likely";
inline constexpr std::string_view kLongSums = "long_sums";
inline constexpr std::string_view kEnclosed = "enclosed";
inline constexpr std::array kSearches = {kProducts,   kSums,     kFunctionSums, kCollapses,
                                         kReductions, kParts,    kGuesses,      kWideSums,
                                         kLikely,     kLongSums, kEnclosed};

class StructureSearch {
 public:
  // All are kept by reference. Problems of fewer variables that stay unsolved are the solver's; of
  // the rounds each looks at more than the one before, up to eight times as much.
  StructureSearch(FitContext& context, Answer& answer, const Regressor& solver, int round,
                  std::string_view without);

  // Cheap structure first; then, where no polynomial says that there is no noise, what structure is
  // likely under noise; then the more expensive ones, unless all that a likely formula leaves is
  // noise.
  void search();
  // A long sum of many products (long_sum.hpp), a rival of whatever is chosen.
  void search_long_sum();
  // Fewer variables where no slope says so, by trial: expensive, and seldom needed.
  void search_guesses();
  // The likeliest formula's inner quantities as inputs (enclosed_inputs.hpp), under noise.
  void search_enclosed();
  // Sums of products with waves and differences: many, and seldom what a law is.
  void search_wide_sums();

 private:
  // What structure is likely under noise: weighed beside the methods' choices.
  void search_likely();
  // What is exact is offered; the return is a problem of fewer variables that was not solved.
  std::optional<ReducedProblem> find_structure(const LogRows& rows, Budget& budget);
  // Where the target may be an angle: its sine, cosine and tangent.
  void find_angles(Budget& budget);
  void find_products_and_sums(const LogRows& rows, Budget& budget);
  void search_waves();
  void search_roots();  // sums with square roots
  void search_wave_sum();
  void search_function_sum(SumTerms terms);
  // A sum or a product of parts without a common input.
  void find_parts(const LogRows& rows);
  void search_parts();
  // The reduced problem with the fewest inputs that was not solved.
  std::optional<ReducedProblem> reduce(Guesses guesses);
  // False where the reduction that led to the problem was not true; else it is tried to be solved
  // and what it reduces to is put to those that are open.
  bool look_at(ReducedProblem& problem, Guesses guesses, std::vector<ReducedProblem>& open,
               Budget& budget);
  // What is exact is offered. With factors (factors.hpp): one search, as expensive as all of the
  // others together, for when these have looked at every problem.
  void solve(const ReducedProblem& problem, Budget& budget);
  void solve_with_factors(const ReducedProblem& problem, Budget& budget);
  void search_by_solver(const ReducedProblem& problem);
  ReducedProblem whole() const { return {context_.data.inputs, answer_.rows()}; }
  // What is as dear as all of the cheap searches is not worth it once the rows are explained.
  bool is_over() { return answer_.is_explained() || answer_.is_done(); }
  bool has(std::string_view search) const { return without_ != search; }

  FitContext& context_;
  Answer& answer_;
  const Regressor& solver_;
  int round_;
  std::string_view without_;
  std::optional<Separation> parts_;
  bool is_noise_left_ = false;  // and nothing else, of the likeliest formula
};

}  // namespace tribench::relay
