// SPDX-License-Identifier: MIT
#include "algorithms/fitting/joint_front.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "algorithms/expression/complexity.hpp"
#include "algorithms/fitting/evidence.hpp"
#include "algorithms/fitting/exact_choice.hpp"

namespace tribench {
namespace {

// Of the target's size: a good approximation of a smooth law of one or two inputs leaves more.
constexpr double kToRounding = 1e-11;

}  // namespace

JointFront::JointFront(const Inputs& inputs, std::span<const double> target)
    : inputs_(inputs), target_(target) {
  for (const double y : target) zero_loss_ += y * y / static_cast<double>(target.size());
}

double JointFront::mean_square(const Expression& formula) {
  const ErrorSum sum = evaluator_.sum_squared_errors(formula, inputs_, target_);
  if (sum.status != ErrorSumStatus::complete) return HUGE_VAL;
  return sum.sum / static_cast<double>(target_.size());
}

double JointFront::against(const Expression& formula) {
  const double error = mean_square(formula);
  if (std::isinf(error)) return error;
  return evidence_against(formula, error, zero_loss_, target_.size());
}

void JointFront::add(std::span<const Expression> front, std::size_t chosen) {
  struct Member {
    int complexity;
    double error;
    Expression formula;
  };
  Expression stands_for = front[chosen];
  if (!formulas_.empty() && against(formulas_[chosen_]) <= against(stands_for)) {
    stands_for = formulas_[chosen_];
  }
  std::vector<Member> all;
  const auto take = [&](const Expression& formula) {
    all.push_back({paper_complexity(formula), mean_square(formula), formula});
  };
  std::ranges::for_each(formulas_, take);
  for (const Expression& formula : front) {
    if (std::ranges::count(formulas_, formula) == 0) take(formula);
  }
  std::ranges::stable_sort(all, [](const Member& a, const Member& b) {
    return a.complexity != b.complexity ? a.complexity < b.complexity : a.error < b.error;
  });
  formulas_.clear();
  double best = HUGE_VAL;
  for (Member& member : all) {
    const bool is_chosen = member.formula == stands_for;
    if (!(member.error < best) && !is_chosen) continue;
    best = std::min(best, member.error);
    if (is_chosen) chosen_ = formulas_.size();
    formulas_.push_back(std::move(member.formula));
  }
  const auto exact = simplest_exact(formulas_, inputs_, target_);
  is_explained_ = false;
  if (!exact) return;
  chosen_ = *exact;
  is_explained_ = mean_square(formulas_[chosen_]) <= kToRounding * kToRounding * zero_loss_;
}

}  // namespace tribench
