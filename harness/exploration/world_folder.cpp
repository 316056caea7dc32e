// SPDX-License-Identifier: MIT
#include "harness/exploration/world_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "algorithms/exploration/explorer.hpp"
#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/output_file.hpp"
#include "foundation/output_folder.hpp"
#include "foundation/suggestion.hpp"
#include "foundation/text.hpp"
#include "problems/file_hash.hpp"

namespace tribench {
namespace {

using Json = nlohmann::ordered_json;

struct LimitField {
  const char* name;
  double MotionLimits::*value;
  double low;
  double high;
  // A joint is not moved by limits that nobody has set; the others say "none" where they are
  // absent.
  bool must_be_there = false;
};

constexpr double kLargest = 1e9;
constexpr std::array kFields = {
    LimitField{"lowest_rad", &MotionLimits::lowest_rad, -kLargest, kLargest, true},
    LimitField{"highest_rad", &MotionLimits::highest_rad, -kLargest, kLargest, true},
    LimitField{"speed_rad_s", &MotionLimits::speed_rad_s, 1e-9, kLargest, true},
    LimitField{"acceleration_rad_s2", &MotionLimits::acceleration_rad_s2, 1e-9, kLargest, true},
    LimitField{"torque_Nm", &MotionLimits::torque_nm, 0, kLargest, true},
    LimitField{"temperature_rise_K", &MotionLimits::temperature_rise_k, 0, 1000},
    LimitField{"ambient_degC", &MotionLimits::ambient_degc, -273, 1000},
    LimitField{"seconds", &MotionLimits::seconds, 1e-3, kLargest},
    LimitField{"least_load_factor", &MotionLimits::least_load_factor, -1000, 1000},
    LimitField{"greatest_load_factor", &MotionLimits::greatest_load_factor, -1000, 1000},
    LimitField{"other_velocity_rad_s", &MotionLimits::greatest_other_velocity_rad_s, 0, kLargest},
    LimitField{"longest_rest_s", &MotionLimits::longest_rest_s, 0, kLargest},
    LimitField{"rate_Hz", &MotionLimits::rate_hz, 1e-3, 1e6, true},
    LimitField{"gear_ratio", &MotionLimits::gear_ratio, 0, 1e6, true},
    LimitField{"gravity_Nm", &MotionLimits::gravity_nm, 0, kLargest},
    LimitField{"gravity_phase_rad", &MotionLimits::gravity_phase_rad, -10, 10}};

std::string text_of(const std::filesystem::path& file) {
  std::optional<std::string> text = read_file_if_there(file);
  if (text) return *std::move(text);
  throw_bad_input("there is no world here", file.parent_path().string(),
                  "make one: tribench world SEED --out FOLDER");
}

// The one of `all` that is called so.
template <typename All, typename NameOf>
auto named(const All& all, NameOf name_of, std::string_view name)
    -> std::optional<typename All::value_type> {
  const auto found = std::ranges::find(all, name, name_of);
  return found == all.end() ? std::nullopt : std::optional(*found);
}

simulation::WorldPlan read_plan(const std::filesystem::path& file) {
  const Json json = read_json_or_throw<Json>(text_of(file), file.string());
  const auto refuse = [&file](std::string_view why) {
    throw_bad_input(fmt::format("this is no sealed world: {}", why), file.string(),
                    "make the world again");
  };
  simulation::WorldPlan plan;
  try {
    const auto seed = json_whole_number<std::uint64_t>(json.at("seed"));
    if (!seed) refuse("its seed is no whole number from 0 on");
    plan.seed = *seed;
    const auto level = named(simulation::kWorldLevels, simulation::world_level_name,
                             json.at("level").get<std::string>());
    if (!level) refuse("its level is not known");
    plan.level = *level;
    if (json.contains("kind")) {
      plan.kind = named(simulation::kWorldKinds, simulation::world_kind_name,
                        json.at("kind").get<std::string>());
      if (!plan.kind) refuse("its kind is not known");
    }
  } catch (const Json::exception& error) {
    refuse(json_complaint(error));
  }
  return plan;
}

}  // namespace

std::string truth_json(const simulation::WorldTruth& truth) {
  Json causes = Json::array();
  for (const PlantedEffect& effect : truth.effects) {
    Json lives_in = Json::array();
    for (const Role role : effect.lives_in) lives_in.push_back(role_name(role));
    causes.push_back({{"cause", effect.family},
                      {"families", effect.names},
                      {"beside", effect.beside},
                      {"lives_in", lives_in},
                      {"scale", effect.scale}});
  }
  return write_json(Json{{"kind", world_kind_name(truth.kind)},
                         {"level", world_level_name(truth.plan.level)},
                         {"seed", truth.plan.seed},
                         {"noise", noise_name(truth.noise)},
                         {"noise_sd_Nm", truth.noise_sd_nm},
                         {"causes", causes}});
}

std::string seal_key(const simulation::WorldPlan& plan) {
  RandomStream random = RandomStream(key_of("world/seal")).split(plan.seed);
  const std::uint64_t last = random.next();
  const std::uint64_t first = random.next();
  return fmt::format("{:016x}{:016x}", first, last);
}

std::string sealed_text(const simulation::WorldTruth& truth) {
  return seal_key(truth.plan) + "\n" + truth_json(truth);
}

std::string seal_of(const simulation::WorldTruth& truth) {
  return sha256_of_text(sealed_text(truth));
}

std::string limits_json(const MotionLimits& limits) {
  Json json;
  for (const LimitField& field : kFields) json[field.name] = limits.*field.value;
  return write_json(json, 1);
}

namespace {

void check_all_there(const Json& limits, const std::string& place) {
  std::vector<std::string> missing;
  for (const LimitField& field : kFields) {
    if (field.must_be_there && !limits.contains(field.name)) missing.emplace_back(field.name);
  }
  if (missing.empty()) return;
  throw_bad_input(fmt::format("the limits lack {}", fmt::join(missing, ", ")), place,
                  "set them; gear_ratio is 0 where it is not known");
}

}  // namespace

MotionLimits read_limits(std::string_view text, const std::string& place) {
  Json json = read_json_or_throw<Json>(text, place);
  if (json.is_object() && json.contains("limits")) json = json.at("limits");
  if (!json.is_object()) throw_bad_input("this is no list of limits", place, "as in world.json");
  MotionLimits limits;
  std::vector<std::string> names;
  for (const LimitField& field : kFields) names.emplace_back(field.name);
  for (const auto& [name, value] : json.items()) {
    const auto found = std::ranges::find(
        kFields, name, [](const LimitField& f) { return std::string_view(f.name); });
    if (found == kFields.end()) {
      throw_bad_input(fmt::format("there is no limit '{}'", name), place,
                      did_you_mean(name, names));
    }
    if (!value.is_number() || !(value.get<double>() >= found->low) ||
        !(value.get<double>() <= found->high)) {
      throw_bad_input(fmt::format("{} is no {}", write_json(value), name), place,
                      fmt::format("a number from {:g} to {:g}", found->low, found->high));
    }
    limits.*(found->value) = value.get<double>();
  }
  check_all_there(json, place);
  if (!(limits.lowest_rad < limits.highest_rad)) {
    throw_bad_input("lowest_rad is not below highest_rad", place, "give a range of positions");
  }
  if (limits.least_load_factor > limits.greatest_load_factor) {
    throw_bad_input("least_load_factor is above greatest_load_factor", place, "turn them round");
  }
  return limits;
}

WorldFolder::WorldFolder(std::filesystem::path folder, const simulation::WorldPlan& plan)
    : folder_(std::move(folder)), world_(plan) {}

WorldFolder WorldFolder::create(const std::filesystem::path& folder,
                                const simulation::WorldPlan& plan) {
  if (std::filesystem::exists(folder / "world.json")) {
    throw_bad_input("there is a world already", folder.string(), "choose another folder");
  }
  make_output_folder(folder);
  WorldFolder out(folder, plan);
  Json sealed = {
      {"seed", plan.seed}, {"level", world_level_name(plan.level)}, {"key", seal_key(plan)}};
  if (plan.kind) sealed["kind"] = world_kind_name(*plan.kind);
  write_file(folder / "sealed.json", write_json(sealed) + "\n");
  const Json known = {{"world", 1},
                      {"truth_sha256", seal_of(out.world_.truth())},
                      {"smallest_effect", out.world_.smallest_effect()},
                      {"limits", Json::parse(limits_json(out.world_.limits()))}};
  write_file(folder / "world.json", write_json(known, 1) + "\n");
  return out;
}

WorldFolder::WorldFolder(const std::filesystem::path& folder)
    : WorldFolder(folder, read_plan(folder / "sealed.json")) {
  check_seal();
  const std::filesystem::path file = folder / "executed.csv";
  if (!std::filesystem::exists(file)) return;
  executed_ = read_movements(text_of(file), file.string());
  for (const PlannedMovement& movement : executed_) world_.execute(movement, file.string());
}

bool WorldFolder::revealed() const { return std::filesystem::exists(folder_ / "revealed.json"); }

Dataset WorldFolder::execute(const std::vector<PlannedMovement>& movements, const std::string& file,
                             const KeepRows& keep) {
  if (revealed()) {
    throw_bad_input("the truth of this world has been revealed", folder_.string(),
                    "ask before you reveal; another SEED is another world");
  }
  simulation::World world = world_;
  Dataset data;
  for (std::size_t i = 0; i < movements.size(); ++i) {
    loop::append_movement(data,
                          world.execute(movements[i], fmt::format("{}, movement {}", file, i + 1)));
  }
  if (keep) keep(data);
  world_ = std::move(world);
  append(movements);
  return data;
}

// A whole file in the place of the old one: a world that is stopped is as before or as after.
void WorldFolder::append(const std::vector<PlannedMovement>& movements) {
  executed_.insert(executed_.end(), movements.begin(), movements.end());
  const std::filesystem::path part = folder_ / "executed.csv.part";
  write_file(part, movements_text(executed_, "rad", "rad/s"));
  std::filesystem::rename(part, folder_ / "executed.csv");
}

// The truth is drawn anew from the plan each time: by another version it may be another.
void WorldFolder::check_seal() const {
  const std::filesystem::path file = folder_ / "world.json";
  const Json known = read_json_or_throw<Json>(text_of(file), file.string());
  if (known.is_object() && known.contains("truth_sha256") &&
      known["truth_sha256"] == seal_of(world_.truth())) {
    return;
  }
  throw_bad_input(
      "the seal does not fit the truth: sealed.json or world.json was changed, or another version "
      "of "
      "tribench made this world",
      folder_.string(), "make the world again");
}

std::string WorldFolder::reveal() {
  check_seal();
  const std::string seal = seal_of(world_.truth());
  const Json revealed = {{"key", seal_key(world_.truth().plan)},
                         {"truth_sha256", seal},
                         {"sealed_text", sealed_text(world_.truth())},
                         {"truth", Json::parse(truth_json(world_.truth()))}};
  write_file(folder_ / "revealed.json", write_json(revealed, 1) + "\n");
  return write_json(revealed, 1);
}

}  // namespace tribench
