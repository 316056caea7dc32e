// SPDX-License-Identifier: MIT
#include "harness/loop/nothing_missing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "reports/record/loop_record.hpp"

namespace tribench::loop {

void doubt_undetermined(JudgedDiagnosis& whole) {
  if (whole.verdict != Verdict::none) return;
  whole.verdict = Verdict::cannot_tell;
  whole.needed = {
      "movements that repeat one another's directions and speeds: without any one of them the "
      "others do not determine even the base model"};
}

void doubt_few_movements(JudgedDiagnosis& whole, std::size_t movements) {
  if (whole.verdict != Verdict::none || !whole.noise.is_mostly_between()) return;
  whole.verdict = Verdict::cannot_tell;
  whole.needed = {fmt::format(
      "more movements, some tens: {} that differ from one another by more than the noise of their "
      "rows do not tell with what",
      movements)};
}

void doubt_nothing_missing(JudgedDiagnosis& whole, std::vector<std::string> needed) {
  constexpr double kTooMuch = 0.05;  // of the error
  if (whole.verdict != Verdict::none || whole.candidates.empty()) return;
  const double less = 1 - whole.error.attainable / whole.error.mae_after;
  const CandidateFinding& seen =
      *std::ranges::max_element(whole.candidates, {}, &CandidateFinding::gain_share);
  const double less_by_effect = 1 - std::sqrt(1 - std::min(1.0, seen.gain_share));
  const bool by_effect = less_by_effect > kTooMuch;
  if (!by_effect && !(less > kTooMuch)) return;
  whole.verdict = Verdict::cannot_tell;
  whole.needed = std::move(needed);
  if (!whole.needed.empty()) return;
  whole.needed.push_back(
      by_effect ? fmt::format("more movements, some tens: '{}' would leave {:.0f} % less error on "
                              "those left out, and these are too few to say what it is",
                              seen.family, 100 * less_by_effect)
                : fmt::format("more movements of every kind: a smooth function of the same inputs "
                              "leaves {:.0f} % less error on those left out, but too few of them "
                              "tell what it stands for",
                              100 * less));
}

}  // namespace tribench::loop
