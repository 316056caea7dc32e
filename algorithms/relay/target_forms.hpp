// SPDX-License-Identifier: MIT
//
// The forms of the target that a law may be simple in: y, y^2, 1/y, 1/y^2, log y; where y is an
// angle its sine, cosine and tangent.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "algorithms/expression/expression.hpp"
#include "algorithms/relay/log_rows.hpp"

namespace tribench::relay {

enum class TargetForm { plain, square, inverse, inverse_square, logarithm, sine, cosine, tangent };
inline constexpr std::array kTargetForms = {TargetForm::plain, TargetForm::square,
                                            TargetForm::inverse, TargetForm::inverse_square,
                                            TargetForm::logarithm};

// Of an angle: see angle_forms.
inline constexpr std::array kAngleForms = {TargetForm::tangent, TargetForm::sine,
                                           TargetForm::cosine};

constexpr bool is_even_power(TargetForm form) {
  return form == TargetForm::square || form == TargetForm::inverse_square;
}
// Whether y's sign can be told from T(y).
constexpr bool keeps_sign(TargetForm form) {
  return form == TargetForm::plain || form == TargetForm::inverse;
}

// T(y); the logarithm is of |y|.
std::vector<double> formed_target(std::span<const double> target, TargetForm form);

// Those of kAngleForms that tell every target from every other: the sine and the tangent within a
// quarter turn of 0, the cosine from 0 to half a turn. None of targets that are all so small that
// an angle is its sine.
std::vector<TargetForm> angle_forms(std::span<const double> target);

// y of what T(y) is; times `sign` where T does not keep it.
Expression solved_for_target(TargetForm form, const Expression& formed, double sign);

// The inputs whose signs make the target's, for T that do not keep it; none where no choice of
// those that change their sign does, or where there are more than 8 of them. Cost: rows x 2^inputs.
std::optional<std::vector<std::size_t>> signs_of_target(const LogRows& rows);

// Rows of all decades alike: 1 / (|z| + a thousandth of the median |z|); ones for the logarithm.
std::vector<double> relative_scale(const std::vector<double>& formed, TargetForm form);

// Where the noise of y is the same in all rows: 1 / |dT / dy|, bounded where the target is small.
std::vector<double> noise_scale(std::span<const double> target, TargetForm form);

// Whether a formula gives the target to a millionth of the largest.
bool explains(const Expression& formula, const LogRows& rows);

}  // namespace tribench::relay
