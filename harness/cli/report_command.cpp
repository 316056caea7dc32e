// SPDX-License-Identifier: MIT
//
// tribench report: a run rendered again, as its leaderboard and page, pictures, tables for a paper
// or a page to cite.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "foundation/output_file.hpp"
#include "foundation/standard_streams.hpp"
#include "harness/catalogue.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/run_pictures.hpp"
#include "harness/curves.hpp"
#include "harness/run_files.hpp"
#include "harness/study/external_torque_study.hpp"
#include "reports/picture_files.hpp"
#include "reports/run_reports.hpp"
#include "reports/study_page.hpp"

namespace tribench {
namespace {

struct ReportArguments {
  std::string folder;
  std::string base;
  std::string data;
  std::string pictures;
  std::string page;
  std::string form;
  std::string out;
};

// Without a journal the CSV files are the truth.
void refresh_files(const std::filesystem::path& folder, const std::string& data) {
  if (!std::filesystem::exists(folder / "cells.jsonl")) return;
  const JournalContents journal = rewrite_result_files(folder);
  for (const std::string& damage : journal.damage)
    print_message(fmt::format("tribench: {}\n", damage));
  const Catalogue catalogue = full_catalogue_of_run(folder, data);
  for (const std::string& line : write_curves(folder, journal.results, catalogue)) {
    print_message(fmt::format("tribench: {}\n", line));
  }
}

void report(const ReportArguments& arguments) {
  const std::filesystem::path folder = arguments.folder;
  // Before the work.
  if (!arguments.pictures.empty()) make_picture_folder(arguments.pictures);
  if (!arguments.page.empty()) try_output_file(arguments.page);
  if (!arguments.out.empty()) try_output_file(arguments.out);
  refresh_files(folder, arguments.data);
  if (!arguments.form.empty()) {
    const std::string tables = run_tables_latex(folder);
    if (arguments.out.empty()) {
      fmt::print("{}", tables);
    } else {
      write_file(arguments.out, tables);
    }
    return;
  }
  fmt::print("{}\n", write_run_reports(folder, arguments.base));
  write_run_pictures(folder, arguments.pictures);
  if (!arguments.page.empty()) {
    write_study_page(folder, arguments.page, external_torque_section(folder));
    fmt::print("the page is {}\n", arguments.page);
  }
}

}  // namespace

void add_report_command(CLI::App& app, ExitStatus& /*status*/) {
  CLI::App* command = app.add_subcommand("report", "Renders a run again, finished or not");
  command->footer(
      "Examples: tribench report runs/today --base runs/yesterday\n"
      "          tribench report run-paper --pictures figures\n"
      "          tribench report run-paper --as latex --out tables.tex");
  auto arguments = std::make_shared<ReportArguments>();
  command->add_option("folder", arguments->folder, "a run's folder")->required();
  command->add_option("--base", arguments->base,
                      "an earlier run: the first screen says what changed since then");
  add_pictures_option(*command, arguments->pictures);
  command->add_option("--data", arguments->data, "folder of the measured sets, for the pictures");
  command->add_option("--page", arguments->page,
                      "write a page to cite (Markdown): settings, machine, published figures "
                      "beside ours, proofs, pictures (needs nodejs)");
  CLI::Option* form =
      command->add_option("--as", arguments->form, "latex: tables for a paper instead of a report")
          ->check(CLI::IsMember({"latex"}));
  command->add_option("--out", arguments->out, "with --as: a file instead of the screen")
      ->needs(form);
  command->callback([arguments] { report(*arguments); });
}

}  // namespace tribench
