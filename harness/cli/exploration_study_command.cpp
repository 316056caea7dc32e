// SPDX-License-Identifier: MIT
//
// tribench study explore: do chosen movements tell sooner what is missing?
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "foundation/json_text.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/cli/world_options.hpp"
#include "harness/study/exploration_study.hpp"

namespace tribench {
namespace {

void print_exploration_table(const ExplorationStudy& study) {
  fmt::print(
      "| worlds | plan | n | sure and right | sure and wrong | median s | movements | aliases "
      "told apart |\n");
  fmt::print("|---|---|--:|--:|--:|--:|--:|--:|\n");
  for (const ExplorationFigure& one : study.figures) {
    fmt::print("| {} | {} | {} | {} | {} | {:.0f} | {:.0f} | {} of {} |\n", one.group, one.plan,
               one.worlds, one.sure_right, one.sure_wrong, one.median_seconds, one.median_movements,
               one.aliases - one.aliases_left, one.aliases);
  }
  if (study.left_out > 0) {
    fmt::print("{} explorations left: the same command goes on with them\n", study.left_out);
  }
}

void print_exploration_json(const ExplorationStudy& study) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (const ExplorationFigure& one : study.figures) {
    array.push_back({{"name", one.group + " " + one.plan},
                     {"summary", "seconds of motion to the right verdict"},
                     {"group", one.group},
                     {"plan", one.plan},
                     {"worlds", one.worlds},
                     {"sure_right", one.sure_right},
                     {"sure_wrong", one.sure_wrong},
                     {"median_seconds", one.median_seconds},
                     {"median_movements", one.median_movements},
                     {"aliases", one.aliases},
                     {"aliases_left", one.aliases_left}});
  }
  fmt::print("{}\n", write_json(array, 1));
}

}  // namespace

void add_exploration_study(CLI::App& study) {
  CLI::App* command = study.add_subcommand(
      "explore", "Worlds explored by chosen, random and fixed movements: seconds and errors");
  command->footer("Example: tribench study explore --worlds 20 --plans informative,random");
  auto options = std::make_shared<ExplorationStudyOptions>();
  auto choice = std::make_shared<WorldChoice>();
  auto json = std::make_shared<bool>(false);
  command->add_option("--worlds", options->worlds, "how many, each with every plan")
      ->transform(whole_number(1, 1'000'000))
      ->capture_default_str();
  command->add_option("--seed", options->first_seed, "of the first world")
      ->transform(whole_number(0))
      ->capture_default_str();
  add_world_choice(*command, *choice);
  command
      ->add_option("--plans", options->plans,
                   "of informative, random, sweep, sines, d_optimal; without it all")
      ->delimiter(',');
  command->add_option("--budget", options->budget_s, "seconds of motion at most")
      ->transform(real_number(1, 1e6))
      ->capture_default_str();
  command->add_option("--alpha", options->alpha, "of the rule of stopping")
      ->transform(real_number(1e-6, 0.5))
      ->capture_default_str();
  add_smallest_effect(*command, options->smallest_effect, "else the least that the level hides");
  command->add_option("--jobs", options->threads, "threads; the figures are the same for any")
      ->transform(whole_number(0, 1024));
  command->add_option("--out", options->out,
                      "folder for explorations.csv, a line a world and plan as it is done; with "
                      "the same folder again it goes on");
  command->add_flag("--json", *json, "an array of figures");
  command->callback([options, choice, json] {
    options->quiet = false;
    options->level = choice->level;
    options->kind = choice->kind;
    if (!options->out.empty()) options->stop = &stop_requested_by_signal();
    const ExplorationStudy done = run_exploration_study(*options);
    if (*json) {
      print_exploration_json(done);
    } else {
      print_exploration_table(done);
    }
  });
}

}  // namespace tribench
