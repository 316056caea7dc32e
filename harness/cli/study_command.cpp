// SPDX-License-Identifier: MIT
//
// tribench study: experiments of the program with itself, reproducible by one command each.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "foundation/json_text.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/cli/study_logs.hpp"
#include "harness/cli/study_loop.hpp"
#include "harness/cli/study_memory.hpp"
#include "harness/cli/study_retellings.hpp"
#include "harness/cli/study_smoothers.hpp"
#include "harness/study/external_torque_study.hpp"
#include "harness/study/generator_study.hpp"
#include "harness/study/reference_study.hpp"

namespace tribench {
namespace {

void print_figures(const std::vector<GeneratorFigure>& figures, int seeds) {
  fmt::print("Generated datasets against their specification, {} seeds; a gate is 10 %.\n\n",
             seeds);
  fmt::print("| joint | figure | unit | expected | ours | spread | off | gate | paper |\n");
  fmt::print("|--:|---|---|--:|--:|--:|--:|---|--:|\n");
  for (const GeneratorFigure& figure : figures) {
    fmt::print("| {} | {} | {} | {:.3f} | {:.3f} | {:.3f} | {:+.1f} % | {} | {} |\n", figure.joint,
               figure.name, figure.unit, figure.expected, figure.mean, figure.spread,
               100 * (figure.mean / figure.expected - 1), figure.within ? "yes" : "NO",
               figure.paper);
  }
}

void print_json(const std::vector<GeneratorFigure>& figures) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (const GeneratorFigure& figure : figures) {
    array.push_back({{"name", figure.name},
                     {"summary", fmt::format("joint {}, {}", figure.joint, figure.unit)},
                     {"joint", figure.joint},
                     {"unit", figure.unit},
                     {"expected", figure.expected},
                     {"mean", figure.mean},
                     {"spread", figure.spread},
                     {"within", figure.within},
                     {"paper", figure.paper}});
  }
  fmt::print("{}\n", write_json(array, 2));
}

void add_generator_study(CLI::App& study, ExitStatus& status) {
  CLI::App* command = study.add_subcommand(
      "generator", "Datasets A and B: do simple exact fits give the specified errors?");
  command->footer("Example: tribench study generator --seeds 10");
  auto seeds = std::make_shared<int>(10);
  auto json = std::make_shared<bool>(false);
  command->add_option("--seeds", *seeds, "seeds 1 to N")->transform(whole_number(1, 10000));
  command->add_flag("--json", *json, "an array of figures");
  command->callback([seeds, json, &status] {
    const std::vector<GeneratorFigure> figures = run_generator_study(*seeds);
    if (*json) {
      print_json(figures);
    } else {
      print_figures(figures, *seeds);
    }
    const bool passed = std::all_of(figures.begin(), figures.end(),
                                    [](const GeneratorFigure& figure) { return figure.within; });
    if (!passed) status = ExitStatus::found;
  });
}

void print_references(const std::vector<ReferenceFigure>& figures, bool json) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  if (!json) {
    fmt::print("Published errors of measured sets, 100 |y - f| / |y|; a gate is 0.1.\n\n");
    fmt::print("| problem | model | terms | rows | published | ours | gate |\n");
    fmt::print("|---|---|---|--:|--:|--:|---|\n");
  }
  for (const ReferenceFigure& figure : figures) {
    array.push_back({{"name", figure.problem + " " + figure.model},
                     {"summary", figure.summary},
                     {"rows", figure.rows},
                     {"published_percent", figure.published},
                     {"percent", figure.ours},
                     {"within", figure.within}});
    if (!json) {
      fmt::print("| {} | {} | {} | {} | {:.4f} | {:.4f} | {} |\n", figure.problem, figure.model,
                 figure.summary, figure.rows, figure.published, figure.ours,
                 figure.within ? "yes" : "NO");
    }
  }
  if (json) fmt::print("{}\n", write_json(array, 2));
}

void add_reference_study(CLI::App& study, ExitStatus& status) {
  CLI::App* command = study.add_subcommand(
      "references", "Measured sets: do the published models give the published errors?");
  command->footer("Example: tribench study references --data ../shared/data");
  auto data = std::make_shared<std::string>();
  auto json = std::make_shared<bool>(false);
  command->add_option("--data", *data, "the folder with the measured sets");
  command->add_flag("--json", *json, "an array of figures");
  command->callback([data, json, &status] {
    const std::vector<ReferenceFigure> figures = run_reference_study(
        data->empty() ? std::nullopt : std::optional<std::filesystem::path>(*data));
    print_references(figures, *json);
    for (const ReferenceFigure& figure : figures) {
      if (!figure.within) status = ExitStatus::found;
    }
  });
}

void print_torques_json(const std::vector<ExternalTorqueFigure>& figures) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (const ExternalTorqueFigure& figure : figures) {
    array.push_back(
        {{"name", figure.model},
         {"summary", fmt::format("joint {}, fitted as {}", figure.joint, figure.problem)},
         {"joint", figure.joint},
         {"problem", figure.problem},
         {"operators", figure.operators},
         {"seeds", figure.seeds},
         {"mae_nm", figure.mae_nm},
         {"low_nm", figure.low_nm},
         {"high_nm", figure.high_nm},
         {"outside_share", figure.outside_share},
         {"mae_outside_nm", figure.mae_outside_nm}});
  }
  fmt::print("{}\n", write_json(array, 2));
}

void add_external_torque_study(CLI::App& study) {
  CLI::App* command = study.add_subcommand(
      "external-torque", "How well the friction models of a run estimate the external torque");
  command->footer("Example: tribench study external-torque run-paper");
  auto run = std::make_shared<std::string>();
  auto json = std::make_shared<bool>(false);
  command->add_option("DIR", *run, "folder of a run with cells of B/jN/load")->required();
  command->add_flag("--json", *json, "an array of figures");
  command->callback([run, json] {
    const std::vector<ExternalTorqueFigure> figures = run_external_torque_study(*run);
    if (*json) {
      print_torques_json(figures);
    } else {
      fmt::print("{}", external_torque_markdown(figures));
    }
  });
}

}  // namespace

void add_study_command(CLI::App& app, ExitStatus& status, const Registry& registry) {
  CLI::App* study = app.add_subcommand("study", "Experiments of the program with itself");
  study->require_subcommand(1);
  add_comparison_study(*study, status);
  add_exploration_study(*study);
  add_recordings_study(*study);
  add_generator_study(*study, status);
  add_reference_study(*study, status);
  add_external_torque_study(*study);
  add_log_study(*study, status);
  add_loop_study(*study, status);
  add_memory_study(*study, registry);
  add_night_study(*study, status, registry);
  add_recovery_study(*study);
  add_retelling_study(*study, status);
  add_smoother_study(*study);
}

}  // namespace tribench
