// SPDX-License-Identifier: MIT
#include "harness/whole_run.hpp"

#include <algorithm>
#include <utility>

#include "foundation/text.hpp"
#include "harness/catalogue.hpp"
#include "harness/curves.hpp"
#include "harness/program_files.hpp"
#include "harness/provenance.hpp"
#include "harness/run_files.hpp"
#include "reports/run_reports.hpp"

namespace tribench {
namespace {

// As it was typed, words separated by blanks.
std::string own_command_line() {
  std::string text = read_file_if_there("/proc/self/cmdline").value_or("");
  if (!text.empty()) text.pop_back();
  std::ranges::replace(text, '\0', ' ');
  return text;
}

}  // namespace

RunIdentity identity_of(const Grid& grid, const std::string& data) {
  return {print_grid_identity(grid), code_identity(), data_identity(grid, data),
          program_files(grid)};
}

WholeRun run_whole(const Grid& grid, const RunOptions& options, const std::atomic<bool>& stop) {
  const RunIdentity identity = identity_of(grid, options.data);
  RunSession session{utc_now(), {}, own_command_line(), options, {}};
  session.tally = run_grid(grid, options, identity, stop);
  session.ended = utc_now();
  WholeRun run{session.tally, read_journal(options.out / "cells.jsonl"), {}};
  write_result_files(options.out, run.journal.results);
  write_curves(options.out, run.journal.results, full_catalogue_of(options.data, grid.own));
  write_quarantine_file(options.out, run.journal.results);
  write_provenance(options.out, identity, session, run.journal.results);
  run.board = write_run_reports(options.out);
  return run;
}

}  // namespace tribench
