// SPDX-License-Identifier: MIT
//
// tribench merge: shards joined into one run.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "foundation/output_file.hpp"
#include "foundation/standard_streams.hpp"
#include "foundation/text.hpp"
#include "harness/catalogue.hpp"
#include "harness/cli/commands.hpp"
#include "harness/curves.hpp"
#include "harness/provenance.hpp"
#include "harness/run_files.hpp"
#include "problems/user/user_problem_text.hpp"
#include "reports/published.hpp"
#include "reports/run_reports.hpp"
#include "reports/suite_view.hpp"

namespace tribench {
namespace {

struct MergeArguments {
  std::vector<std::string> folders;
  std::string out;
  std::string data;
};

void print_damage(const JournalContents& journal) {
  for (const std::string& damage : journal.damage)
    print_message(fmt::format("tribench: {}\n", damage));
  if (journal.repeated == 0) return;
  print_message(fmt::format(
      "tribench: {} results are in more than one folder, the same in each: they count once\n",
      journal.repeated));
}

// A leaderboard of what is there is of use, but it is not that of the grid.
ExitStatus tell_missing(const PlannedAndMissing& cells) {
  if (cells.missing.empty()) return ExitStatus::done;
  print_message(fmt::format(
      "tribench: {} of {} planned cells are missing, the first {}: run the shards that are left "
      "(run --shard K/N --resume) and merge again, into another folder\n",
      cells.missing.size(), cells.planned, cells.missing.front()));
  return ExitStatus::undecided;
}

ExitStatus merge(const MergeArguments& arguments) {
  const std::vector<std::filesystem::path> folders(arguments.folders.begin(),
                                                   arguments.folders.end());
  const JournalContents merged = merge_journals(folders, arguments.out);
  print_damage(merged);
  // The shards agree on the grid, so the first one's plan is everybody's.
  const std::filesystem::path out = arguments.out;
  const std::filesystem::path grid = folders.front() / "grid.toml";
  write_file(out / "grid.toml",
             user::moved_grid_text(read_file(grid), grid.string(), folders.front(), out));
  std::filesystem::copy_file(folders.front() / "planned.csv", out / "planned.csv",
                             std::filesystem::copy_options::overwrite_existing);
  for (const char* file : {kPublishedFile, kSuiteFile}) {
    if (!std::filesystem::exists(folders.front() / file)) continue;
    std::filesystem::copy_file(folders.front() / file, out / file,
                               std::filesystem::copy_options::overwrite_existing);
  }
  write_result_files(out, merged.results);
  const Catalogue catalogue = full_catalogue_of_run(out, arguments.data);
  for (const std::string& line : write_curves(out, merged.results, catalogue)) {
    print_message(fmt::format("tribench: {}\n", line));
  }
  write_merged_provenance(out, folders, merged);
  fmt::print("{}\n{} cells from {} folders; see {}\n", write_run_reports(out),
             merged.results.size(), folders.size(), (out / "leaderboard.md").string());
  return tell_missing(missing_cells(out, merged.results));
}

}  // namespace

void add_merge_command(CLI::App& app, ExitStatus& status) {
  CLI::App* command = app.add_subcommand("merge", "Joins the shards of a run");
  command->footer(
      "Example: tribench merge shard-1 shard-2 --out run-paper\n"
      "Exit status 4 where planned cells are in none of the folders: what is there is merged.");
  auto arguments = std::make_shared<MergeArguments>();
  command->add_option("folders", arguments->folders, "folders of the shards, in any order")
      ->required();
  command->add_option("--out", arguments->out, "the joined run's folder")->required();
  command->add_option("--data", arguments->data, "folder of the measured sets, for the pictures");
  command->callback([arguments, &status] { status = merge(*arguments); });
}

}  // namespace tribench
