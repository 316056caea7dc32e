// SPDX-License-Identifier: MIT
#include "harness/cli/study_loop.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "harness/cli/number_options.hpp"
#include "harness/study/external_diagnosis.hpp"
#include "harness/study/loop_study.hpp"

namespace tribench {
namespace {

void print_table(const std::vector<LoopFigure>& figures) {
  fmt::print("| figure | value | 95 % interval | runs | target | met |\n");
  fmt::print("|---|--:|--:|--:|--:|---|\n");
  for (const LoopFigure& figure : figures) {
    const bool rate = figure.trials > 0;
    fmt::print("| {} | {} | {} | {} | {} | {} |\n", figure.name,
               rate ? fmt::format("{:.2f} %", figure.value) : fmt::format("{:.4g}", figure.value),
               rate ? fmt::format("{:.2f} .. {:.2f} %", figure.low, figure.high) : std::string("-"),
               rate ? fmt::format("{} of {}", figure.hits, figure.trials) : std::string("-"),
               figure.target, figure.met ? "yes" : "NO");
  }
}

void print_json(const std::vector<LoopFigure>& figures) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (const LoopFigure& figure : figures) {
    array.push_back({{"name", figure.name},
                     {"summary", fmt::format("target {}", figure.target)},
                     {"value", figure.value},
                     {"low", figure.low},
                     {"high", figure.high},
                     {"hits", figure.hits},
                     {"trials", figure.trials},
                     {"met", figure.met}});
  }
  fmt::print("{}\n", array.dump(2));
}

}  // namespace

void add_loop_study(CLI::App& study, ExitStatus& status) {
  CLI::App* command = study.add_subcommand(
      "loop", "The closed loop on planted effects: false alarms, power, exactness");
  command->footer("Example: tribench study loop --runs 2000 --per-cell 20");
  auto options = std::make_shared<LoopStudyOptions>();
  auto json = std::make_shared<bool>(false);
  command->add_option("--runs", options->null_runs, "runs in which nothing is missing")
      ->transform(whole_number(1, 1'000'000))
      ->capture_default_str();
  command->add_option("--per-cell", options->runs_per_cell, "runs of each effect at each size")
      ->transform(whole_number(1, 100'000))
      ->capture_default_str();
  command->add_option("--seed", options->first_seed, "of the first run")
      ->transform(whole_number(0))
      ->capture_default_str();
  command->add_option("--only", options->only,
                      "the cases of runs.csv that begin so: null, single/stribeck, pair");
  command->add_option("--jobs", options->threads, "threads; the figures are the same for any")
      ->transform(whole_number(0, 1024));
  command->add_option("--out", options->out,
                      "folder for runs.csv, a line a run; a study that was stopped goes on there");
  command->add_flag("--json", *json, "an array of figures");
  auto command_line = std::make_shared<std::vector<std::string>>();
  command->add_option("--command", *command_line,
                      "your own method instead of the loop: a program and its words, run without a "
                      "shell once a case (docs/closed_loop.md)");
  command->callback([options, json, command_line, &status] {
    options->quiet = false;
    const std::vector<LoopFigure> figures =
        run_loop_study(*options, command_line->empty() ? LoopMethod(diagnose_case)
                                                       : make_external_diagnosis(*command_line))
            .figures;
    if (*json) {
      print_json(figures);
    } else {
      print_table(figures);
    }
    if (!std::ranges::all_of(figures, &LoopFigure::met)) status = ExitStatus::found;
  });
}

}  // namespace tribench
