// SPDX-License-Identifier: MIT
//
// tribench world: a simulated joint with a sealed truth, to be asked by movements.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/number_text.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/cli/world_options.hpp"
#include "harness/exploration/world_folder.hpp"
#include "problems/reading/csv.hpp"
#include "problems/reading/file_text.hpp"

namespace tribench {
namespace {

struct WorldArguments {
  std::string world;
  std::string out;
  WorldChoice choice;
  std::string movements;
  std::string data;
  bool json = false;
};

using WorldJson = nlohmann::ordered_json;

std::uint64_t seed_of(const std::string& text) {
  std::string number = text;
  const std::string error = whole_number(0)(number);
  if (!error.empty()) {
    throw_bad_input(fmt::format("'{}' is no seed", text), "SEED",
                    "a whole number, or a world's folder with execute or reveal");
  }
  return std::stoull(number);
}

void make_world(const WorldArguments& arguments) {
  if (arguments.out.empty()) {
    throw_bad_input("there is no folder to put the world into", "--out", "--out FOLDER");
  }
  const WorldFolder folder =
      WorldFolder::create(arguments.out, arguments.choice.plan(seed_of(arguments.world)));
  const MotionLimits& limits = folder.world().limits();
  if (arguments.json) {
    fmt::print("{}\n", write_json(WorldJson{{"folder", arguments.out},
                                            {"truth_sha256", seal_of(folder.world().truth())},
                                            {"limits", WorldJson::parse(limits_json(limits))}},
                                  1));
    return;
  }
  fmt::print(
      "{}: a joint from {:g} to {:g} rad, {:g} rad/s, {:g} N m, {:g} K, {:g} s of motion\n"
      "truth sealed, SHA-256 {}\n",
      arguments.out, limits.lowest_rad, limits.highest_rad, limits.speed_rad_s, limits.torque_nm,
      limits.temperature_rise_k, limits.seconds, seal_of(folder.world().truth()));
}

void execute(const WorldArguments& arguments) {
  WorldFolder folder(arguments.world);
  const std::vector<PlannedMovement> movements =
      read_movements(read_file_text(arguments.movements), arguments.movements);
  const double before_s = folder.world().seconds_used();
  const Dataset data = folder.execute(movements, arguments.movements);
  write_csv(data, arguments.data);
  const double used_s = folder.world().seconds_used();
  const double left_s = folder.world().limits().seconds - used_s;
  if (arguments.json) {
    fmt::print("{}\n", write_json(WorldJson{{"movements", movements.size()},
                                            {"rows", data.rows()},
                                            {"seconds", used_s - before_s},
                                            {"seconds_used", used_s},
                                            {"seconds_left", left_s}}));
    return;
  }
  fmt::print("{}: {} movements, {} rows, {:.1f} s of motion; {:.1f} s are left\n", arguments.data,
             movements.size(), data.rows(), used_s - before_s, left_s);
}

void reveal(const WorldArguments& arguments) {
  WorldFolder folder(arguments.world);
  const std::string text = folder.reveal();
  if (arguments.json) {
    fmt::print("{}\n", text);
    return;
  }
  const WorldJson json = WorldJson::parse(text);
  fmt::print("{}: {}\n", arguments.world, json["truth"]["kind"].get<std::string>());
  for (const WorldJson& cause : json["truth"]["causes"]) {
    fmt::print("  {} ({:.2f} times the noise)\n", cause["cause"].get<std::string>(),
               cause["scale"].get<double>());
  }
  fmt::print("key {}; SHA-256 of key, line feed and truth is {}\n", json["key"].get<std::string>(),
             json["truth_sha256"].get<std::string>());
}

}  // namespace

void add_world_command(CLI::App& app, ExitStatus& /*status*/) {
  CLI::App* command = app.add_subcommand(
      "world", "A joint that can be asked: it executes movements, what it hides is sealed");
  command->footer(
      "Example: tribench world 7 --out w && tribench world w execute movements.csv --out data.csv\n"
      "         tribench world w reveal\n"
      "movements.csv: as next_movements.csv of tribench loop --suggest (docs/explore.md).");
  auto arguments = std::make_shared<WorldArguments>();
  command->add_option("WORLD", arguments->world, "a seed for a new world, or a world's folder")
      ->required();
  command->add_option("--out", arguments->out, "the new world's folder");
  add_world_choice(*command, arguments->choice);
  command->add_flag("--json", arguments->json, "the answer as JSON");
  CLI::App* asked = command->add_subcommand("execute", "Perform movements and record them");
  asked->footer("Example: tribench world w execute movements.csv --out data.csv");
  asked->add_option("MOVEMENTS", arguments->movements, "a CSV file, a line a movement")->required();
  asked->add_option("--out", arguments->data, "the recording, CSV")->required();
  asked->add_flag("--json", arguments->json, "what it cost, as JSON");
  CLI::App* told = command->add_subcommand("reveal", "Say what was hidden, with the seal's key");
  told->footer("Example: tribench world w reveal --json");
  told->add_flag("--json", arguments->json, "truth and key as JSON");
  command->callback([arguments, asked, told] {
    if (asked->parsed()) {
      execute(*arguments);
    } else if (told->parsed()) {
      reveal(*arguments);
    } else {
      make_world(*arguments);
    }
  });
}

}  // namespace tribench
