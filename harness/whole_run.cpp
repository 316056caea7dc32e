// SPDX-License-Identifier: MIT
#include "harness/whole_run.hpp"

#include <algorithm>
#include <utility>

#include "foundation/shell_word.hpp"
#include "foundation/text.hpp"
#include "harness/catalogue.hpp"
#include "harness/curves.hpp"
#include "harness/program_files.hpp"
#include "harness/provenance.hpp"
#include "harness/run_files.hpp"
#include "reports/run_reports.hpp"

namespace tribench {
namespace {

// As it can be typed again.
std::string own_command_line() {
  const std::string words = read_file_if_there("/proc/self/cmdline").value_or("");
  std::string line;
  for (std::size_t begin = 0; begin < words.size();) {
    const std::size_t end = std::min(words.find('\0', begin), words.size());
    line += (begin == 0 ? "" : " ") + shell_word(words.substr(begin, end - begin));
    begin = end + 1;
  }
  return line;
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
