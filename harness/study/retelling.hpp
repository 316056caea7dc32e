// SPDX-License-Identifier: MIT
//
// A recording told another way: the same movements of the same joint, written down by somebody
// else. What is said of the joint must not hang on the way of telling.
//
// Works on the cells of the files, before anything is understood of them, so that reading is tried
// too. Columns are what their names or `--roles` say; numbers of other columns stay as they are.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "foundation/random.hpp"
#include "harness/study/recordings.hpp"

namespace tribench {

struct Retelling {
  std::string_view name;  // "mirrored"
  std::string_view summary;
  double wanted = 1;        // share of recordings of which the same story is told
  double error_within = 0;  // the errors' ratio may differ from 1 by so much; 0: bit for bit
  // Compared with the first telling under --unordered: the order of movements is what changes.
  bool unordered = false;
  // Nothing where this recording cannot be told so (no time to shift, one movement to order).
  std::optional<RecordingToTell> (*tell)(const RecordingToTell& recording,
                                         RandomStream random) = nullptr;
};

const std::vector<Retelling>& retellings();
// Throws Error (bad_input) with the nearest name.
const Retelling& find_retelling(std::string_view name);

// The same under --unordered.
RecordingToTell unordered(RecordingToTell recording);

}  // namespace tribench
