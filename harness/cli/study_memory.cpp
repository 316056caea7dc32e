// SPDX-License-Identifier: MIT
#include "harness/cli/study_memory.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "foundation/json_text.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/study/memory_study.hpp"

namespace tribench {
namespace {

void print_table(const std::vector<MemoryFigure>& figures) {
  fmt::print(
      "Each recording held out in turn; root mean square errors, their mean. Gains over the best "
      "model without a state (*), 95 % by recordings.\n\n"
      "| file | model | state | error | gain | |\n|---|---|---|--:|--:|---|\n");
  for (const MemoryFigure& f : figures) {
    const std::string gain =
        std::isfinite(f.gain) ? fmt::format("{:+.4g} +- {:.2g}", f.gain, f.half) : std::string();
    fmt::print("| {} | {} | {} | {} | {} | {} |\n", f.file,
               f.method + (f.is_best_without ? "*" : ""), f.has_state ? "yes" : "",
               f.failed.empty() ? fmt::format("{:.4g}", f.rmse) : "-", gain,
               f.failed.empty() ? f.verdict() : f.failed);
  }
}

void print_json(const std::vector<MemoryFigure>& figures) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (const MemoryFigure& f : figures) {
    array.push_back({{"name", f.file + "/" + f.method},
                     {"summary", f.failed.empty() ? f.verdict() : f.failed},
                     {"has_state", f.has_state},
                     {"is_best_without", f.is_best_without},
                     {"recordings", f.recordings},
                     {"rmse", f.failed.empty() ? json_number(f.rmse) : nullptr},
                     {"gain", json_number(f.gain)},
                     {"half", json_number(f.half)}});
  }
  fmt::print("{}\n", write_json(array, 2));
}

}  // namespace

void add_memory_study(CLI::App& study, const Registry& registry) {
  CLI::App* command = study.add_subcommand(
      "memory", "What is a state worth on your recordings, each of them held out in turn?");
  command->footer(
      "Example: tribench study memory joint1.csv joint2.csv --target current --inputs v,a,load "
      "--group recording --roles 'v=velocity,a=acceleration,load=gravity_torque,t=time'");
  auto options = std::make_shared<MemoryStudyOptions>();
  auto json = std::make_shared<bool>(false);
  command->add_option("DATA", options->files, "CSV files, each a joint by itself")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("--target", options->target, "the column to explain")->required();
  command->add_option("--inputs", options->inputs, "the columns to explain it by")
      ->required()
      ->delimiter(',');
  command
      ->add_option("--roles", options->roles, "COLUMN=ROLE[UNIT],... of time and velocity at least")
      ->required();
  command->add_option("--group", options->group, "the column that names the recordings")
      ->required();
  command->add_option("--without", options->without, "methods without a state")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--with", options->with, "methods with a state")
      ->delimiter(',')
      ->capture_default_str();
  command->add_flag("--load", options->load, "bristles press harder under load");
  command->add_option("--jobs", options->threads, "threads; the figures are the same for any")
      ->transform(whole_number(0, 1024));
  command->add_flag("--json", *json, "an array of figures");
  command->callback([options, json, &registry] {
    options->quiet = *json;
    const std::vector<MemoryFigure> figures = run_memory_study(*options, registry);
    if (*json) {
      print_json(figures);
    } else {
      print_table(figures);
    }
  });
}

}  // namespace tribench
