// SPDX-License-Identifier: MIT
#include "algorithms/relay/answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <utility>

#include "algorithms/expression/complexity.hpp"
#include "algorithms/expression/singularity.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "algorithms/fitting/cross_validation.hpp"
#include "algorithms/fitting/evidence_pruning.hpp"

namespace tribench::relay {
namespace {

constexpr std::size_t kShort = 14;    // nodes of an exact formula
constexpr std::size_t kShortest = 7;  // of one that no other search is asked to shorten
// How long a shorter explanation is looked for: of what had been spent, and at the least.
constexpr std::uint64_t kLookOfSpent = 2;
constexpr std::uint64_t kLeastLook = 1'000'000'000;
constexpr std::size_t kLikelyFitted = 25;  // of those that structure proposes under noise
constexpr std::size_t kLikelyTaken = 5;    // of these
constexpr std::size_t kAskedAgainstRival = 3;
constexpr std::string_view kByLikely = "what is likely under noise";
constexpr double kLate = 0.1;  // of all seconds

// Inserts a formula where it belongs; its place.
std::size_t place_by_complexity(const Expression& formula, std::vector<Expression>& front) {
  const int size = paper_complexity(formula);
  const auto next = std::ranges::find_if(
      front, [size](const Expression& other) { return paper_complexity(other) >= size; });
  const auto place = static_cast<std::size_t>(next - front.begin());
  front.insert(next, formula);
  return place;
}

}  // namespace

Answer::Answer(FitContext& context)
    : context_(context),
      rows_(context.data),
      admission_(context),
      joint_(rows_.table(), rows_.target, rows_.movement, input_box(context.data.inputs)),
      seconds_(context.budget.remaining_seconds()) {}

std::size_t Answer::chosen_nodes() { return joint_.formulas()[joint_.chosen()].size(); }

bool Answer::is_short() { return has_formula() && chosen_nodes() <= kShort; }

bool Answer::is_done() {
  if (context_.budget.remaining() == 0 || context_.budget.out_of_time() ||
      context_.budget.exhausted()) {
    return true;
  }
  if (!joint_.is_explained()) return false;
  return chosen_nodes() <= kShortest || context_.budget.spent() >= look_ends_;
}

void Answer::add_explaining(std::span<const Expression> front, std::optional<std::size_t> chosen,
                            std::string_view found_by) {
  const Expression before = is_explained() ? joint_.formulas()[joint_.chosen()] : Expression();
  joint_.add(front, chosen);
  if (!is_explained()) return;
  const std::uint64_t spent = context_.budget.spent();
  if (!look_ends_) look_ends_ = spent + std::max(kLookOfSpent * spent, kLeastLook);
  if (!(joint_.formulas()[joint_.chosen()] == before)) explained_by_ = found_by;
}

std::uint64_t Answer::left_to_look() const {
  const std::uint64_t spent = context_.budget.spent();
  return look_ends_ && *look_ends_ > spent ? *look_ends_ - spent : 0;
}

bool Answer::is_late() const { return context_.budget.remaining_seconds() < kLate * seconds_; }

void Answer::offer(std::optional<Expression> found, std::string_view found_by) {
  if (!found || !admission_.admits(*found)) return;
  Expression formula = std::move(*found);
  ConstantFitOptions options;
  options.function_tolerance = 1e-14;
  options.step_tolerance = 1e-15;  // else exact forms stop at 1e-12 of the target, as near ones do
  const ConstantFitResult fit =
      ConstantFitter().fit(formula, rows_.table(), rows_.target, {}, options);
  context_.budget.spend(fit.node_rows);
  if (fit.status == FitStatus::not_finite) return;
  add_explaining(std::array{std::move(formula)}, std::nullopt, found_by);
}

void Answer::offer_likeliest(std::span<const Expression> formulas, Budget& budget) {
  JointFront proposed(rows_.table(), rows_.target, rows_.movement, {});
  for (const Expression& formula : formulas) {
    if (admission_.admits(formula)) proposed.add(std::array{formula}, 0);
  }
  JointFront likely(rows_.table(), rows_.target, rows_.movement, {});
  ConstantFitter fitter;
  for (Expression& formula : proposed.likeliest(kLikelyFitted)) {
    if (!budget.in_time()) break;
    const ConstantFitResult fit = fitter.fit(formula, rows_.table(), rows_.target, {},
                                             {.exponents = FitExponents::not_simple});
    budget.spend(fit.node_rows);
    if (fit.status != FitStatus::not_finite) likely.add(std::array{std::move(formula)}, 0);
  }
  const InputBox box = input_box(context_.data.inputs);
  for (const Expression& formula : likely.likeliest(kLikelyTaken)) {
    if (!budget.in_time()) break;
    if (prove_free(formula, box).verdict == Verdict::refuted) continue;
    add_explaining(std::array{formula}, 0, kByLikely);
  }
}

void Answer::add(const FitResult& result, std::string_view found_by) {
  if (result.front.empty()) {
    if (!result.note.empty()) say(fmt::format("{}: {}", found_by, result.note));
    return;
  }
  add_explaining(result.front, result.chosen, found_by);
}

void Answer::prune(const Expression& formula, double of_seconds) {
  if (joint_.is_explained()) return;
  Budget part = context_.budget.share(context_.budget.remaining() / 4, of_seconds);
  Expression pruned = pruned_by_evidence(
      formula, rows_.table(), rows_.target, input_box(context_.data.inputs),
      [&part](std::uint64_t node_rows) { return part.spend(node_rows) && part.in_time(); });
  context_.budget.settle(part);
  if (pruned == formula || !admission_.admits(pruned)) return;
  joint_.add(std::array{std::move(pruned)}, 0);
}

void Answer::prune_likeliest(double of_seconds) {
  if (has_formula()) prune(joint_.likeliest(1)[0], of_seconds);
}

FitResult Answer::result() && {
  if (joint_.empty()) return FitResult::unsupported(std::move(note_));
  if (!explained_by_.empty()) say(fmt::format("explained by {}", explained_by_));
  FitResult result{joint_.formulas(), joint_.chosen(),
                   context_.budget.exhausted() ? StopReason::budget : StopReason::converged,
                   std::move(note_)};
  if (rival_) result.held_out_rows = std::min(rival_rows_, rows_.rows());
  const auto stands = best_against_rival(result.front, result.chosen);
  if (stands) {
    result.chosen = *stands;
    result.yields_to_plain_sum = true;
  } else {
    result.chosen = place_by_complexity(rival_->formula, result.front);
  }
  return result;
}

void Answer::set_rival(LongSum sum, std::size_t rows) {
  rival_ = std::move(sum);
  rival_rows_ = rows;
}

// The forms were found with all rows, the rival's terms without those held out: it need only be
// nearer to them. A shorter form stands where that may be chance. The chosen one is asked first,
// then those with the most evidence. None: the rival stands.
std::optional<std::size_t> Answer::best_against_rival(std::span<const Expression> front,
                                                      std::size_t chosen) {
  if (!rival_ || joint_.is_explained()) return chosen;
  std::vector<std::size_t> places = {chosen};
  for (const Expression& formula : joint_.likeliest(kAskedAgainstRival)) {
    const auto place = static_cast<std::size_t>(std::ranges::find(front, formula) - front.begin());
    if (place < front.size() && place != chosen) places.push_back(place);
  }
  const int rival_length = paper_complexity(rival_->formula);
  for (const std::size_t place : places) {
    const std::vector<double> errors = held_out_errors(front[place], rows_, rival_rows_);
    const double mean =
        std::reduce(errors.begin(), errors.end()) / static_cast<double>(errors.size());
    const bool is_shorter = paper_complexity(front[place]) < rival_length;
    if (mean <= rival_->mean_held_out() || (is_shorter && as_good(errors, rival_->held_out))) {
      return place;
    }
  }
  return std::nullopt;
}

void Answer::say(std::string_view what) {
  if (!note_.empty()) note_ += "; ";
  note_ += what;
}

}  // namespace tribench::relay
