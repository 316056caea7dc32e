// SPDX-License-Identifier: MIT
//
// A grid from its first cell to its reports: what `tribench run` and `tribench nightly` do alike.
#pragma once

#include <atomic>
#include <string>

#include "harness/grid.hpp"
#include "harness/journal.hpp"
#include "harness/run.hpp"

namespace tribench {

struct WholeRun {
  RunTally tally;
  JournalContents journal;
  std::string board;  // the first screen of the leaderboard

  // Of such a run nothing is left to read; one with some failed cells is another matter.
  bool all_failed() const { return tally.done() > 0 && tally.failed == tally.done(); }
};

// What run_whole's journal says of the run. Throws as data_identity does.
RunIdentity identity_of(const Grid& grid, const std::string& data);

// Runs what options.out does not have yet and writes every file of a run's folder. Throws as
// run_grid does. `stop`: ends it early, with files of what is done.
WholeRun run_whole(const Grid& grid, const RunOptions& options, const std::atomic<bool>& stop);

}  // namespace tribench
