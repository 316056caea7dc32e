// SPDX-License-Identifier: MIT
#include "algorithms/fitting/joint_front.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "algorithms/expression/complexity.hpp"
#include "algorithms/fitting/cross_validation.hpp"
#include "algorithms/fitting/evidence.hpp"
#include "algorithms/fitting/exact_choice.hpp"
#include "algorithms/fitting/free_constants.hpp"
#include "algorithms/fitting/posterior_choice.hpp"
#include "foundation/elementary.hpp"

namespace tribench {
namespace {

// Of the target's size. Sums of a dozen terms come as near as 1e-12 to laws that they are not.
constexpr double kToRounding = 1e-13;
constexpr int kFrontFolds = 5;

}  // namespace

JointFront::JointFront(const Inputs& inputs, std::span<const double> target,
                       std::span<const int> movement, InputBox box)
    : inputs_(inputs), target_(target), movement_(movement), box_(std::move(box)) {
  for (const double y : target) zero_loss_ += y * y / static_cast<double>(target.size());
}

void JointFront::add(std::span<const Expression> front, std::optional<std::size_t> chosen) {
  for (std::size_t k = 0; k < front.size(); ++k) {
    const auto known = std::ranges::find(members_, front[k], &Member::formula);
    if (known != members_.end()) {
      known->is_choice = known->is_choice || chosen == k;
      continue;
    }
    const ErrorSum sum = evaluator_.sum_squared_errors(front[k], inputs_, target_);
    const double error = sum.status == ErrorSumStatus::complete
                             ? sum.sum / static_cast<double>(target_.size())
                             : HUGE_VAL;
    // An exponent that was fitted is a number as any other; searches price it as part of a form.
    const double exponents = 0.5 * static_cast<double>(free_exponents(front[k])) *
                             elementary::log(static_cast<double>(target_.size()));
    members_.push_back({front[k], paper_complexity(front[k]), error,
                        evidence_against(front[k], error, zero_loss_, target_.size()) + exponents,
                        chosen == k});
  }
  std::ranges::stable_sort(members_, [](const Member& a, const Member& b) {
    return a.complexity != b.complexity ? a.complexity < b.complexity : a.error < b.error;
  });
  // What is neither on the front nor a choice, and has no weight, is heard no more.
  double least = HUGE_VAL;
  for (const Member& member : members_) least = std::min(least, member.against);
  std::vector<Member> kept;
  for (std::size_t k = 0; k < members_.size(); ++k) {
    const Member& member = members_[k];
    if (member.is_choice || member.against <= least + kNegligibleNats || is_on_front(k)) {
      kept.push_back(member);
    }
  }
  members_ = std::move(kept);
  is_settled_ = false;
  is_explained_ = false;
  const double rounding = kToRounding * kToRounding * zero_loss_;
  if (std::ranges::none_of(members_, [=](const Member& m) { return m.error <= rounding; })) return;
  settle();
  is_explained_ = is_exact_ && members_[places_[chosen_]].error <= rounding;
}

bool JointFront::is_on_front(std::size_t place) const {
  const auto before = std::span(members_).first(place);
  const double error = members_[place].error;
  return std::isfinite(error) &&
         std::ranges::none_of(before, [=](const Member& other) { return other.error <= error; });
}

// What one search stands for another may have found shorter, nearer and with more evidence: the
// nearest of these; itself where there is none.
std::size_t JointFront::better_than(std::size_t place) const {
  const Member& member = members_[place];
  std::size_t best = place;
  for (std::size_t k = 0; k < place; ++k) {
    const Member& other = members_[k];
    if (other.error < members_[best].error && other.against <= member.against) best = k;
  }
  return best;
}

// Where no search stands for any, and beyond the rows, where none knows what it stands for, all on
// the front are candidates.
std::size_t JointFront::choose() const {
  const bool beyond = reaches_beyond(inputs_, box_);
  const bool any = !beyond && std::ranges::any_of(members_, &Member::is_choice);
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < members_.size(); ++k) {
    if (any ? !members_[k].is_choice : !is_on_front(k)) continue;
    const std::size_t candidate = any ? better_than(k) : k;
    if (std::ranges::count(places, candidate) == 0) places.push_back(candidate);
  }
  if (places.empty()) return 0;
  if (places.size() == 1) return places[0];
  // Of equal complexity the one with fewer numbers that were fitted comes first.
  std::ranges::stable_sort(places, {}, [&](std::size_t k) {
    return std::pair(members_[k].complexity, members_[k].against);
  });
  std::vector<Expression> candidates;
  for (const std::size_t k : places) candidates.push_back(members_[k].formula);
  if (beyond) {
    const CrossValidation validation = cross_validate(candidates, inputs_, target_, movement_, box_,
                                                      kFrontFolds, {}, Beyond::as_far);
    if (!validation.mean_square.empty()) return places[simplest_as_good(validation.mean_square)];
  }
  std::vector<WeighedFormula> pool;
  for (const Member& member : members_) {
    pool.push_back({&member.formula, member.against, member.error});
  }
  return places[simplest_typical(distances_from_posterior_mean(candidates, pool, inputs_))];
}

void JointFront::settle() {
  if (is_settled_ || members_.empty()) return;
  is_settled_ = true;
  list([&](std::size_t k) { return is_on_front(k); });
  const auto exact = simplest_exact(formulas_, inputs_, target_);
  is_exact_ = exact.has_value();
  if (exact) {
    chosen_ = *exact;
    return;
  }
  const std::size_t choice = choose();
  list([&](std::size_t k) { return k == choice || is_on_front(k); });
  chosen_ = static_cast<std::size_t>(std::ranges::find(places_, choice) - places_.begin());
}

void JointFront::list(const std::function<bool(std::size_t)>& is_taken) {
  places_.clear();
  formulas_.clear();
  for (std::size_t k = 0; k < members_.size(); ++k) {
    if (!is_taken(k)) continue;
    places_.push_back(k);
    formulas_.push_back(members_[k].formula);
  }
}

std::vector<Expression> JointFront::likeliest(std::size_t most) const {
  std::vector<const Member*> order;
  for (const Member& member : members_) order.push_back(&member);
  std::ranges::stable_sort(order, {}, [](const Member* member) { return member->against; });
  std::vector<Expression> formulas;
  for (const Member* member : order) {
    if (formulas.size() == most) break;
    formulas.push_back(member->formula);
  }
  return formulas;
}

const std::vector<Expression>& JointFront::formulas() {
  settle();
  return formulas_;
}

std::size_t JointFront::chosen() {
  settle();
  return chosen_;
}

}  // namespace tribench
