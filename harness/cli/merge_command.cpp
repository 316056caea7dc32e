// SPDX-License-Identifier: MIT
//
// tribench merge: shards joined into one run; tribench report: a run rendered again.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "harness/cli/commands.hpp"
#include "harness/curves.hpp"
#include "harness/provenance.hpp"
#include "harness/run_files.hpp"
#include "reports/pictures.hpp"
#include "reports/published.hpp"
#include "reports/record_csv.hpp"
#include "reports/run_reports.hpp"

namespace tribench {
namespace {

struct MergeArguments {
  std::vector<std::string> folders;
  std::string out;
};

struct ReportArguments {
  std::string folder;
  std::string base;
  std::string pictures;
};

void print_damage(const JournalContents& journal) {
  for (const std::string& damage : journal.damage) fmt::print(stderr, "tribench: {}\n", damage);
}

void merge(const MergeArguments& arguments) {
  const std::vector<std::filesystem::path> folders(arguments.folders.begin(),
                                                   arguments.folders.end());
  const JournalContents merged = merge_journals(folders, arguments.out);
  print_damage(merged);
  // The shards agree on the grid, so the first one's plan is everybody's.
  const std::filesystem::path out = arguments.out;
  for (const char* file : {"grid.toml", "planned.csv"}) {
    std::filesystem::copy_file(folders.front() / file, out / file,
                               std::filesystem::copy_options::overwrite_existing);
  }
  if (std::filesystem::exists(folders.front() / kPublishedFile)) {
    std::filesystem::copy_file(folders.front() / kPublishedFile, out / kPublishedFile,
                               std::filesystem::copy_options::overwrite_existing);
  }
  write_result_files(out, merged.results);
  write_curves(out, merged.results, Catalogue());
  write_merged_provenance(out, folders, merged);
  fmt::print("{}\n{} cells from {} folders; see {}\n", write_run_reports(out),
             merged.results.size(), folders.size(), (out / "leaderboard.md").string());
}

// The journal is the truth, even of a run that was killed; without one the CSV files are.
void report(const ReportArguments& arguments) {
  const std::filesystem::path folder = arguments.folder;
  if (std::filesystem::exists(folder / "cells.jsonl")) {
    const JournalContents journal = read_journal(folder / "cells.jsonl");
    print_damage(journal);
    write_result_files(folder, journal.results);
    write_curves(folder, journal.results, Catalogue());
  }
  fmt::print("{}\n", write_run_reports(folder, arguments.base));
  if (!arguments.pictures.empty()) {
    const std::vector<std::string> files = write_pictures(folder, arguments.pictures);
    fmt::print("{} pictures in {}\n", files.size(), arguments.pictures);
  }
}

}  // namespace

void add_merge_command(CLI::App& app, ExitStatus& /*status*/) {
  CLI::App* command = app.add_subcommand("merge", "Joins the shards of a run");
  command->footer("Example: tribench merge shard-1 shard-2 --out run-paper");
  auto arguments = std::make_shared<MergeArguments>();
  command->add_option("folders", arguments->folders, "folders of the shards, in any order")
      ->required();
  command->add_option("--out", arguments->out, "the joined run's folder")->required();
  command->callback([arguments] { merge(*arguments); });
}

void add_report_command(CLI::App& app, ExitStatus& /*status*/) {
  CLI::App* command = app.add_subcommand("report", "Renders a run again, finished or not");
  command->footer("Example: tribench report runs/today --base runs/yesterday");
  auto arguments = std::make_shared<ReportArguments>();
  command->add_option("folder", arguments->folder, "a run's folder")->required();
  command->add_option("--base", arguments->base,
                      "an earlier run: the first screen says what changed since then");
  command->add_option("--pictures", arguments->pictures,
                      "write every picture of the page as SVG into this folder (needs nodejs)");
  command->callback([arguments] { report(*arguments); });
}

}  // namespace tribench
