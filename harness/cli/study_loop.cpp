// SPDX-License-Identifier: MIT
#include "harness/cli/study_loop.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "algorithms/campaign/rules.hpp"
#include "foundation/json_text.hpp"
#include "harness/cli/choice_option.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/study/external_diagnosis.hpp"
#include "harness/study/loop_methods.hpp"
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

void print_answers(const std::vector<CauseAnswers>& answers) {
  if (answers.empty()) return;
  fmt::print("\n| cause | k | runs |");
  for (const Says says : kSays) fmt::print(" {} |", says_name(says));
  fmt::print(" error / noise |\n|---|--:|--:|");
  for (std::size_t i = 0; i < kSays.size(); ++i) fmt::print("--:|");
  fmt::print("--:|\n");
  for (const CauseAnswers& one : answers) {
    fmt::print("| {} | {} | {} |", one.cause, one.scale, one.runs);
    for (const std::size_t count : one.counts) {
      fmt::print(" {} |", count == 0 ? "" : fmt::format("{}", count));
    }
    fmt::print(" {} |\n",
               std::isnan(one.error_ratio) ? "-" : fmt::format("{:.3f}", one.error_ratio));
  }
}

nlohmann::ordered_json answers_json(const CauseAnswers& one) {
  nlohmann::ordered_json counts;
  for (const Says says : kSays) {
    counts[std::string(says_name(says))] = one.counts[static_cast<std::size_t>(says)];
  }
  return {{"name", fmt::format("answers to {} at {}", one.cause, one.scale)},
          {"summary", "how often each answer was given"},
          {"cause", one.cause},
          {"scale", one.scale},
          {"runs", one.runs},
          {"answers", counts},
          {"error_ratio", std::isnan(one.error_ratio) ? nlohmann::ordered_json()
                                                      : nlohmann::ordered_json(one.error_ratio)}};
}

void print_json(const LoopStudy& study) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (const LoopFigure& figure : study.figures) {
    array.push_back({{"name", figure.name},
                     {"summary", fmt::format("target {}", figure.target)},
                     {"value", figure.value},
                     {"low", figure.low},
                     {"high", figure.high},
                     {"hits", figure.hits},
                     {"trials", figure.trials},
                     {"met", figure.met}});
  }
  for (const CauseAnswers& one : study.answers) array.push_back(answers_json(one));
  fmt::print("{}\n", write_json(array, 2));
}

}  // namespace

void add_generator_option(CLI::App& command, LoopGenerator& generator) {
  take_one_of<LoopGenerator>(
      command.add_option("--generator", generator,
                         "planted: effects as columns; simulated: physics integrated in time, "
                         "other motions and kinds of noise"),
      {{"planted", LoopGenerator::planted}, {"simulated", LoopGenerator::simulated}})
      ->default_str("planted");
}

void add_loop_study(CLI::App& study, ExitStatus& status) {
  CLI::App* command = study.add_subcommand(
      "loop", "The closed loop on planted effects: false alarms, power, exactness");
  command->footer("Example: tribench study loop --runs 2000 --per-cell 20");
  auto options = std::make_shared<LoopStudyOptions>();
  auto json = std::make_shared<bool>(false);
  add_generator_option(*command, options->generator);
  command
      ->add_option("--runs", options->null_runs,
                   "runs in which nothing is missing (simulated: of each kind of noise)")
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
                      "shell once a case (docs/own_diagnosis.md)");
  auto without = std::make_shared<std::vector<std::string>>();
  std::string rule_lines;
  for (const loop::Rule& rule : loop::rules()) {
    rule_lines += fmt::format("\n  {:<18} {}", rule.name, rule.purpose);
  }
  command->add_option("--without", *without,
                      "leave rules of the loop out, to see what they are worth:" + rule_lines);
  auto limit_s = std::make_shared<double>(600);
  command
      ->add_option("--command-seconds", *limit_s, "wall time that the program may take for a case")
      ->transform(real_number(0.01, 1e6))
      ->capture_default_str();
  command->callback([options, json, command_line, without, limit_s, &status] {
    options->quiet = false;
    const LoopStudy done = run_loop_study(
        *options, command_line->empty() ? diagnosis_without(*without)
                                        : make_external_diagnosis(*command_line, *limit_s));
    if (*json) {
      print_json(done);
    } else {
      print_table(done.figures);
      print_answers(done.answers);
    }
    if (!std::ranges::all_of(done.figures, &LoopFigure::met)) status = ExitStatus::found;
  });
}

}  // namespace tribench
