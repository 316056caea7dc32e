// SPDX-License-Identifier: MIT
//
// tribench explore: asks a world, or a program, for the movements that tell what is missing.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "algorithms/exploration/fixed_plans.hpp"
#include "foundation/error.hpp"
#include "foundation/number_text.hpp"
#include "foundation/output_file.hpp"
#include "foundation/standard_streams.hpp"
#include "foundation/text.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/cli/world_options.hpp"
#include "harness/exploration/executing_program.hpp"
#include "harness/exploration/exploration_folder.hpp"
#include "harness/exploration/exploration_report.hpp"
#include "harness/exploration/recorded_world.hpp"
#include "harness/exploration/world_folder.hpp"
#include "problems/reading/csv.hpp"
#include "problems/reading/file_text.hpp"

namespace tribench {
namespace {

struct ExploreArguments {
  std::string world;
  std::vector<std::string> command;
  std::string limits;
  double command_seconds = 600;
  double budget_s = 600;
  double alpha = 0.01;
  std::optional<double> smallest_effect;
  std::string plan = "informative";
  std::uint64_t seed = 1;
  std::string out;
  bool json = false;
};

// "600s" and "10m" are 600, "1h" is 3600.
CLI::Validator seconds_of_text() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        if (read_number<double>(text)) return {};
        const char unit = text.empty() ? ' ' : text.back();
        const double unit_s = unit == 's' ? 1 : unit == 'm' ? 60 : unit == 'h' ? 3600 : 0;
        const std::optional<double> number =
            unit_s > 0 ? read_number<double>(text.substr(0, text.size() - 1)) : std::nullopt;
        if (!number) {
          return fmt::format(
              "'{}' cannot be used; use a number of seconds (600, 600s), minutes "
              "(10m) or hours (1h)",
              text);
        }
        text = fmt::format("{}", unit_s * *number);
        return {};
      },
      "");
}

void check(const ExploreArguments& arguments) {
  if (arguments.world.empty() == arguments.command.empty()) {
    throw_bad_input(
        arguments.world.empty() ? "there is nothing to ask" : "a world and a program are given",
        "explore", "name a world's folder, or a program with --command");
  }
  if (!arguments.command.empty() && arguments.limits.empty()) {
    throw_bad_input("a program needs limits to plan within", "--limits",
                    "a file with the limits as world.json has them");
  }
}

// A program with its words may come as one of them, in quotes; so may a path with a blank.
std::vector<std::string> program_of(const ExploreArguments& arguments) {
  if (arguments.command.size() != 1 || std::filesystem::exists(arguments.command.front())) {
    return arguments.command;
  }
  return words_of_command(arguments.command.front(), "--command");
}

ExplorationSetting setting_of(const ExploreArguments& arguments,
                              const loop::ExplorerOptions& options, const MotionLimits& limits) {
  MotionLimits lasting = limits;
  if (!arguments.world.empty()) lasting.seconds = 0;
  // The budget too: towards its end it decides which movements are asked for.
  return {fmt::format("{}, plan {}, seed {}, alpha {}, smallest effect {}, budget {} s",
                      arguments.world.empty() ? fmt::format("{}", fmt::join(arguments.command, " "))
                                              : arguments.world,
                      arguments.plan, arguments.seed, options.alpha, options.smallest_effect,
                      arguments.budget_s),
          limits_json(lasting), options.start_rad, limits.seconds};
}

ExitStatus run_explore(const ExploreArguments& arguments) {
  check(arguments);
  const loop::NamedPlan& plan = loop::find_plan(arguments.plan);
  std::optional<WorldFolder> folder;
  std::optional<RecordedWorld> recorded;
  MotionLimits limits;
  loop::ExecuteMovement execute;
  loop::ExplorerOptions options;
  options.alpha = arguments.alpha;
  if (!arguments.world.empty() && RecordedWorld::is_in(arguments.world)) {
    recorded.emplace(std::filesystem::path(arguments.world));
    limits = recorded->limits();
    limits.seconds = std::max(0.0, limits.seconds - recorded->seconds_used());
    options.start_rad = recorded->position_rad();
    execute = [&](const PlannedMovement& movement) {
      return recorded->execute({movement}, "the plan").rows;
    };
  } else if (!arguments.world.empty()) {
    folder.emplace(std::filesystem::path(arguments.world));
    limits = folder->world().limits();
    limits.seconds = std::max(0.0, limits.seconds - folder->world().seconds_used());
    options.start_rad = folder->world().position_rad();
    options.smallest_effect = folder->world().smallest_effect();
    execute = [&](const PlannedMovement& movement) {
      return folder->execute({movement}, "the plan");
    };
  } else {
    limits = read_limits(read_file_text(arguments.limits), arguments.limits);
    execute = executing_program(program_of(arguments), limits, arguments.command_seconds,
                                &end_requested_by_signal());
  }
  options.smallest_effect = arguments.smallest_effect.value_or(options.smallest_effect);
  std::optional<ExplorationFolder> answers;
  if (!arguments.out.empty()) {
    ExplorationSetting setting = setting_of(arguments, options, limits);
    answers.emplace(arguments.out, setting);
    if (answers->answers() > 0) {
      print_message(fmt::format("{}: {} answers are there; it goes on from these", arguments.out,
                                answers->answers()));
    }
    options.start_rad = setting.start_rad;
    limits.seconds = setting.seconds_left;
    execute = answers->remembering(std::move(execute));
  }
  // Of what was remembered, too: the clock begins anew where the exploration goes on.
  if (arguments.world.empty()) execute = with_running_clock(std::move(execute));
  options.budget_s = std::min(arguments.budget_s, limits.seconds);
  options.stop = &stop_requested_by_signal();
  if (!arguments.json) {
    options.told = [](const loop::ExplorationStep& step) {
      if (step.looked) fmt::print("  {}\n", step_line(step));
    };
  }
  const loop::Exploration done = loop::explore(limits, execute, options, plan.make(arguments.seed));
  const SecondOpinion second = second_opinion(done, limits.gear_ratio);
  const std::string json = exploration_json(done, second, options);
  if (!arguments.out.empty()) {
    const std::filesystem::path out = arguments.out;
    write_file(out / "exploration.json", json);
    write_file(out / "exploration.md", exploration_markdown(done, second, options));
    std::vector<PlannedMovement> movements;
    for (const loop::ExplorationStep& step : done.steps) movements.push_back(step.movement);
    write_file(out / "movements.csv", movements_text(movements, "rad", "rad/s"));
    if (done.data.rows() > 0) {
      write_csv(done.data, out / "data.csv");
    } else {
      std::filesystem::remove(out / "data.csv");
    }
  }
  fmt::print("{}", arguments.json ? json : exploration_terminal(done, second, options));
  if (done.end == loop::ExplorationEnd::failed) {
    print_message(fmt::format("tribench: {}{}\n", done.failure,
                              answers ? "; the same command goes on from there" : ""));
    return ExitStatus::failed;
  }
  return done.end == loop::ExplorationEnd::sure ? ExitStatus::done : ExitStatus::undecided;
}

}  // namespace

void add_explore_command(CLI::App& app, ExitStatus& status) {
  CLI::App* command = app.add_subcommand(
      "explore", "Ask a joint for the movements that tell what its friction model lacks");
  command->footer(
      "Example: tribench world 7 --out w && tribench explore w --budget 600s --out answer\n"
      "         tribench explore --command ./robot.py --limits limits.json --budget 300s\n"
      "Exit status 4 where it is not sure when the seconds are spent, or at Ctrl-C, which waits "
      "for "
      "the movement\nunder way; 3 at SIGTERM, which breaks it off.");
  auto arguments = std::make_shared<ExploreArguments>();
  command->add_option("WORLD", arguments->world, "a world's folder (tribench world)");
  command->add_option("--command", arguments->command,
                      "a program and its words in the place of a world: a movements file in, a "
                      "recording as CSV out (docs/explore.md); words that begin with a dash go "
                      "with it in quotes: --command 'python3 -u robot.py'");
  command->add_option("--limits", arguments->limits,
                      "what the program's joint allows: JSON as in world.json");
  command
      ->add_option("--command-seconds", arguments->command_seconds,
                   "wall time that the program may take for a movement")
      ->transform(real_number(0.01, 1e6))
      ->capture_default_str();
  command
      ->add_option("--budget", arguments->budget_s,
                   "seconds of motion at most: 600, 600s, 10m or 1h")
      ->transform(real_number(0.1, 1e9))
      ->transform(seconds_of_text())  // before the number is read
      ->capture_default_str();
  command
      ->add_option(
          "--alpha", arguments->alpha,
          "share of wrong verdicts among those it stops with, whenever it stops, where the "
          "truth is one of the explanations (docs/explore.md)")
      ->transform(real_number(1e-6, 0.5))
      ->capture_default_str();
  add_smallest_effect(
      *command, arguments->smallest_effect,
      fmt::format("else what the world says, {:g} where nobody does", loop::kSmallestEffect));
  std::string plans;
  for (const loop::NamedPlan& plan : loop::movement_plans()) {
    plans += fmt::format("\n  {:<12} {}", plan.name, plan.summary);
  }
  command->add_option("--plan", arguments->plan, "who chooses the movements:" + plans)
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "of plans that draw")
      ->transform(whole_number(0))
      ->capture_default_str();
  command->add_option("--out", arguments->out,
                      "folder for exploration.json, exploration.md, movements.csv, data.csv and, "
                      "answer by answer, journal.jsonl: the same command goes on from there");
  command->add_flag("--json", arguments->json, "print exploration.json");
  command->callback([arguments, &status] { status = run_explore(*arguments); });
}

}  // namespace tribench
