// SPDX-License-Identifier: MIT
//
// tribench world: a joint to be asked by movements: simulated, its truth sealed, or recorded.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/number_text.hpp"
#include "foundation/output_file.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/data_options.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/cli/world_options.hpp"
#include "harness/exploration/recorded_world.hpp"
#include "harness/exploration/world_folder.hpp"
#include "problems/preparation/recording.hpp"
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
  std::shared_ptr<DataOptions> reading = std::make_shared<DataOptions>();
  double longest_s = 10;
  bool json = false;
};

using WorldJson = nlohmann::ordered_json;

std::uint64_t seed_of(const std::string& text) {
  std::string number = text;
  const std::string error = whole_number(0)(number);
  if (!error.empty()) {
    throw_bad_input(fmt::format("'{}' is no seed", text), "SEED",
                    "a whole number, a recording, or a world's folder with execute or reveal");
  }
  return std::stoull(number);
}

void make_recorded_world(const WorldArguments& arguments) {
  const std::vector<std::filesystem::path> files = {arguments.world};
  const PreparedRecording recording =
      prepare(read_data(files, *arguments.reading, std::vector<std::string>()), *arguments.reading,
              Gravity::automatic, SlowRows::kept);
  const RecordedWorld world =
      RecordedWorld::create(arguments.out, recording.data, arguments.longest_s,
                            arguments.reading->drive.gear_ratio.value_or(0));
  if (arguments.json) {
    fmt::print("{}\n",
               write_json(WorldJson{{"folder", arguments.out},
                                    {"recordings", world.movements()},
                                    {"limits", WorldJson::parse(limits_json(world.limits()))}},
                          1));
    return;
  }
  for (const std::string& note : recording.notes) fmt::print("{}\n", note);
  fmt::print("{}: {} recorded movements, {:.1f} s; each is given once\n", arguments.out,
             world.movements(), world.limits().seconds);
}

void make_world(const WorldArguments& arguments) {
  if (arguments.out.empty()) {
    throw_bad_input("there is no folder to put the world into", "--out", "--out FOLDER");
  }
  if (std::filesystem::is_regular_file(arguments.world)) {
    make_recorded_world(arguments);
    return;
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

struct Executed {
  Dataset data;
  double before_s = 0;
  double used_s = 0;
  double left_s = 0;
  std::vector<std::string> given;  // of a recorded world
};

Executed executed(const WorldArguments& arguments, const std::vector<PlannedMovement>& movements) {
  const KeepRows keep = [&](const Dataset& rows) { write_csv(rows, arguments.data); };
  Executed out;
  if (RecordedWorld::is_in(arguments.world)) {
    RecordedWorld world(arguments.world);
    out.before_s = world.seconds_used();
    RecordedWorld::Answer answer = world.execute(movements, arguments.movements, keep);
    out.data = std::move(answer.rows);
    out.given = std::move(answer.given);
    out.used_s = world.seconds_used();
    out.left_s = world.limits().seconds - out.used_s;
    return out;
  }
  WorldFolder folder(arguments.world);
  out.before_s = folder.world().seconds_used();
  out.data = folder.execute(movements, arguments.movements, keep);
  out.used_s = folder.world().seconds_used();
  out.left_s = folder.world().limits().seconds - out.used_s;
  return out;
}

void execute(const WorldArguments& arguments) {
  const std::vector<PlannedMovement> movements =
      read_movements(read_file_text(arguments.movements), arguments.movements);
  try_output_file(arguments.data);  // what is executed cannot be taken back
  const auto [data, before_s, used_s, left_s, given] = executed(arguments, movements);
  if (arguments.json) {
    WorldJson answer = {{"movements", movements.size()},
                        {"rows", data.rows()},
                        {"seconds", used_s - before_s},
                        {"seconds_used", used_s},
                        {"seconds_left", left_s}};
    if (!given.empty()) answer["given"] = given;
    fmt::print("{}\n", write_json(answer));
    return;
  }
  for (std::size_t i = 0; i < given.size(); ++i) {
    fmt::print("movement {}: the nearest that is left was recorded as '{}'\n", i + 1, given[i]);
  }
  fmt::print("{}: {} movements, {} rows, {:.1f} s of motion; {:.1f} s are left\n", arguments.data,
             movements.size(), data.rows(), used_s - before_s, left_s);
}

void reveal(const WorldArguments& arguments) {
  if (RecordedWorld::is_in(arguments.world)) {
    throw_bad_input("nobody knows what a recorded joint hides", arguments.world,
                    "only simulated worlds have a truth to reveal");
  }
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
      "         tribench world joint.csv --out m   (recordings that are given as they are asked "
      "for)\n"
      "movements.csv: as next_movements.csv of tribench loop --suggest (docs/explore.md).");
  auto arguments = std::make_shared<WorldArguments>();
  command
      ->add_option("WORLD", arguments->world,
                   "a seed or a recording for a new world, or a world's folder")
      ->required();
  command->add_option("--out", arguments->out, "the new world's folder");
  add_world_choice(*command, arguments->choice);
  add_data_options(*command, arguments->reading);
  command->add_option("--longest", arguments->longest_s, "seconds; longer recordings are cut up")
      ->transform(real_number(0.1, 1e6))
      ->capture_default_str();
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
