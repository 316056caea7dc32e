// SPDX-License-Identifier: MIT
//
// tribench study recovery: how often the Nguyen laws were found exactly.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "foundation/json_text.hpp"
#include "harness/cli/commands.hpp"
#include "harness/study/recovery_study.hpp"

namespace tribench {
namespace {

double percent(const RecoveryFigure& figure) {
  return 100 * static_cast<double>(figure.recovered) / static_cast<double>(figure.runs);
}

void print_recovery(const std::vector<RecoveryFigure>& figures) {
  struct Mean {
    double sum = 0;
    int problems = 0;
  };
  std::map<std::string, Mean> means;
  fmt::print(
      "| problem | method | operators | recovered | runs | DSR, published | median CPU s |\n");
  fmt::print("|---|---|---|--:|--:|--:|--:|\n");
  for (const RecoveryFigure& figure : figures) {
    const int number = std::stoi(figure.problem.substr(figure.problem.find('/') + 1));
    const bool published = number >= 1 && number <= 12;
    fmt::print("| {} | {} | {} | {:.0f} % | {} | {} | {:.2f} |\n", figure.problem, figure.method,
               figure.operators, percent(figure), figure.runs,
               published ? fmt::format("{} %", kPublishedDsr[number - 1]) : "",
               figure.median_cpu_s);
    Mean& mean = means[figure.method + ", " + figure.operators];
    mean.sum += percent(figure);
    ++mean.problems;
  }
  fmt::print(
      "\nRecovered: normalised mean squared error below 1e-12 on noise-free rows not fitted.\n");
  for (const auto& [method, mean] : means) {
    fmt::print("Mean of {} problems, {}: {:.1f} % (published: DSR 83.6 %, RNN + GP {:.0f} %)\n",
               mean.problems, method, mean.sum / mean.problems, kPublishedRnnGp);
  }
}

void print_recovery_json(const std::vector<RecoveryFigure>& figures) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (const RecoveryFigure& figure : figures) {
    array.push_back({{"name", figure.problem},
                     {"summary", fmt::format("{}, {}", figure.method, figure.operators)},
                     {"method", figure.method},
                     {"operators", figure.operators},
                     {"recovered", figure.recovered},
                     {"runs", figure.runs},
                     {"median_cpu_s", figure.median_cpu_s}});
  }
  fmt::print("{}\n", write_json(array, 2));
}

}  // namespace

void add_recovery_study(CLI::App& study) {
  CLI::App* command = study.add_subcommand(
      "recovery", "How often the methods of a run found the Nguyen laws exactly");
  command->footer(
      "Example: tribench run nguyen --out run-nguyen; tribench study recovery run-nguyen");
  auto run = std::make_shared<std::string>();
  auto json = std::make_shared<bool>(false);
  command->add_option("DIR", *run, "folder of a run with cells of nguyen/N")->required();
  command->add_flag("--json", *json, "an array of figures");
  command->callback([run, json] {
    const std::vector<RecoveryFigure> figures = run_recovery_study(*run);
    if (*json) {
      print_recovery_json(figures);
    } else {
      print_recovery(figures);
    }
  });
}

}  // namespace tribench
