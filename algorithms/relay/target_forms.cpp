// SPDX-License-Identifier: MIT
#include "algorithms/relay/target_forms.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "algorithms/expression/build.hpp"
#include "foundation/elementary.hpp"

namespace tribench::relay {
namespace {

constexpr double kExplained = 1e-6;  // of the largest target
constexpr double kHardlyAnAngle = 0.1;
constexpr double kSmallTarget = 1e-3;  // of the median: rows below it count for less

double median_size(std::vector<double> values) {
  for (double& x : values) x = std::abs(x);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

std::vector<double> formed_target(std::span<const double> target, TargetForm form) {
  std::vector<double> values(target.begin(), target.end());
  for (double& y : values) {
    if (form == TargetForm::logarithm) y = elementary::log(std::abs(y));
    if (is_even_power(form)) y = y * y;
    if (form == TargetForm::sine) y = elementary::sin(y);
    if (form == TargetForm::cosine) y = elementary::cos(y);
    if (form == TargetForm::tangent) y = elementary::tan(y);
    if (form == TargetForm::inverse || form == TargetForm::inverse_square) y = 1 / y;
  }
  return values;
}

std::vector<TargetForm> angle_forms(std::span<const double> target) {
  const auto [low, high] = std::ranges::minmax(target);
  std::vector<TargetForm> forms;
  if (std::max(std::abs(low), std::abs(high)) < kHardlyAnAngle) return forms;
  for (const TargetForm form : kAngleForms) {
    const bool is_told = form == TargetForm::cosine
                             ? low >= 0 && high <= std::numbers::pi
                             : std::max(std::abs(low), std::abs(high)) <= std::numbers::pi / 2;
    if (is_told) forms.push_back(form);
  }
  return forms;
}

Expression solved_for_target(TargetForm form, const Expression& formed, double sign) {
  using namespace build;
  if (form == TargetForm::plain) return formed;
  if (form == TargetForm::inverse) return constant(1) / formed;
  if (form == TargetForm::tangent) return function(Op::atan, formed);
  if (form == TargetForm::sine || form == TargetForm::cosine) {
    // tan(asin(x) / 2), finite to both ends of -1 .. 1.
    const Expression half =
        formed / (constant(1) + function(Op::sqrt, constant(1) - power(formed, 2)));
    const Expression arc = constant(2) * function(Op::atan, half);
    return form == TargetForm::sine ? arc : constant(std::numbers::pi / 2) - arc;
  }
  const Expression size = form == TargetForm::logarithm ? function(Op::exp, formed)
                          : form == TargetForm::square  ? function(Op::sqrt, formed)
                                                        : function(Op::sqrt, constant(1) / formed);
  return sign < 0 ? -size : size;
}

std::optional<std::vector<std::size_t>> signs_of_target(const LogRows& rows) {
  std::vector<std::size_t> turning;
  for (std::size_t j = 0; j < rows.inputs().size(); ++j) {
    if (rows.inputs()[j].changes_sign) turning.push_back(j);
  }
  if (turning.size() > 8) return std::nullopt;
  for (unsigned subset = 0; subset < (1U << turning.size()); ++subset) {
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < turning.size(); ++i) {
      if ((subset >> i & 1U) != 0) chosen.push_back(turning[i]);
    }
    const auto is_negative = [&](std::size_t r) {
      bool negative = rows.target().values[r] < 0;
      for (const std::size_t j : chosen) {
        negative = negative != (rows.inputs()[j].values[r] < 0);
      }
      return negative;
    };
    bool is_constant = true;
    for (std::size_t r = 1; r < rows.rows() && is_constant; ++r) {
      is_constant = is_negative(r) == is_negative(0);
    }
    if (is_constant) return chosen;
  }
  return std::nullopt;
}

std::vector<double> relative_scale(const std::vector<double>& formed, TargetForm form) {
  std::vector<double> scale(formed.size(), 1.0);
  if (form == TargetForm::logarithm) return scale;
  const double small = kSmallTarget * median_size(formed);
  for (std::size_t r = 0; r < scale.size(); ++r) scale[r] = 1 / (std::abs(formed[r]) + small);
  return scale;
}

std::vector<double> noise_scale(std::span<const double> target, TargetForm form) {
  constexpr double kSmall = 0.1;  // of the median
  const double small = kSmall * median_size({target.begin(), target.end()});
  std::vector<double> scale;
  for (const double y : target) {
    const double size = std::abs(y);
    scale.push_back(form == TargetForm::plain       ? 1.0
                    : form == TargetForm::square    ? 1 / std::max(size, small)
                    : form == TargetForm::inverse   ? size * size
                    : form == TargetForm::logarithm ? size
                                                    : size * size * size);
  }
  return scale;
}

bool explains(const Expression& formula, const LogRows& rows) {
  const Factor found = factor_of(formula, rows);
  double worst = 0;
  double size = 0;
  for (std::size_t r = 0; r < rows.rows(); ++r) {
    if (!std::isfinite(found.values[r])) return false;
    worst = std::max(worst, std::abs(found.values[r] - rows.target().values[r]));
    size = std::max(size, std::abs(rows.target().values[r]));
  }
  return worst <= kExplained * size;
}

}  // namespace tribench::relay
