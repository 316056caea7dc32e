// SPDX-License-Identifier: MIT
#include "harness/restarts.hpp"

#include <fmt/format.h>

#include <optional>
#include <utility>
#include <vector>

#include "algorithms/admission.hpp"
#include "algorithms/finite_rows.hpp"
#include "algorithms/fitting/joint_front.hpp"
#include "harness/finished_front.hpp"

namespace tribench {

FitResult fit_until_spent(FitResult first, const FitRound& round, bool widens,
                          const TrainingData& data, const Budget& budget,
                          const RandomStream& random) {
  // Models with states are fitted from a grid of starts: another round would find the same.
  if (first.front.empty() || !first.states.empty() || first.keeps_choice) return first;
  const FiniteRows rows(data);
  JointFront joint(rows.table(), rows.target, rows.movement, input_box(data.inputs));
  joint.add(first.front, first.chosen);
  const int most_alike = widens ? 3 : 1;
  std::vector<Expression> before = first.front;
  int alike = 0;
  int count = 0;
  while (!joint.is_explained() && budget.remaining() > 0 && budget.remaining_seconds() > 0 &&
         !budget.out_of_time()) {
    const std::uint64_t spent = budget.spent();
    const FitResult next = round(random.split(static_cast<std::uint64_t>(count)), count + 1);
    if (next.front.empty() || budget.spent() == spent) break;
    ++count;
    const bool has_a_say = next.held_out_rows >= first.held_out_rows;
    joint.add(next.front, has_a_say ? std::optional(next.chosen) : std::nullopt);
    alike = std::exchange(before, next.front) == next.front ? alike + 1 : 0;
    if (alike == most_alike) break;
  }
  FitResult result = std::move(first);
  result.front = joint.formulas();
  result.chosen = joint.chosen();
  if (!joint.is_explained()) leave_saturated(rows, result);
  if (count > 0) {
    result.reason = budget.exhausted() ? StopReason::budget : StopReason::converged;
    result.note += fmt::format("{}{} restart{}", result.note.empty() ? "" : "; ", count,
                               count == 1 ? "" : "s");
  }
  return result;
}

}  // namespace tribench
