// SPDX-License-Identifier: MIT
//
// Whether a run's results can be had again: some of its cells are run anew and compared with what
// the journal has, bit for bit, apart from times.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "harness/grid.hpp"
#include "harness/journal.hpp"
#include "harness/run.hpp"

namespace tribench {

struct VerifyResult {
  std::size_t compared = 0;
  std::vector<std::string> different;  // "cell: what differs", one a cell
  // Cells whose result the clock or a limit decided: they need not repeat.
  std::size_t not_reproducible = 0;
};

// Cells of the journal that promise to be reproducible, `count` of them at most, picked by the
// grid's hash: the same ones every time.
std::vector<std::string> pick_sample(const JournalContents& journal, std::size_t count);

// Runs the sample in `scratch`, which must not hold a run.
VerifyResult verify_run(const Grid& grid, const JournalContents& journal, std::size_t count,
                        RunOptions options, const std::atomic<bool>& stop);

}  // namespace tribench
