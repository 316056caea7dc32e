// SPDX-License-Identifier: MIT
#include "harness/exploration/recorded_world.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <span>
#include <utility>

#include "algorithms/exploration/explorer.hpp"
#include "algorithms/exploration/recorded_movements.hpp"
#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/output_file.hpp"
#include "foundation/output_folder.hpp"
#include "foundation/pivoted_qr.hpp"
#include "problems/file_hash.hpp"
#include "problems/joint_simulation/joint_recording.hpp"
#include "problems/joint_simulation/world_motion.hpp"
#include "problems/reading/csv.hpp"
#include "problems/reading/file_text.hpp"

namespace tribench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kFeatureRate_hz = 50;
constexpr int kPhaseSteps = 20;
constexpr double kAnything = 1e9;
constexpr double kAnyWarmth_k = 1000;
constexpr std::array kTorques = {Role::friction_torque, Role::motor_torque};

std::span<const double> values_of(const Dataset& data, Role role, std::string_view place) {
  if (const Channel* found = data.find(role)) {
    if (role == Role::position && found->unit != "rad") {
      throw_bad_input(fmt::format("the position is in {}", found->unit), place,
                      "a world is a joint that turns: a position in rad or deg (--roles)");
    }
    return found->values;
  }
  throw_bad_input(fmt::format("there is no {} to ask for", role_name(role)), place,
                  "a recorded world needs time, position, velocity and a torque (--roles)");
}

double largest(std::span<const double> values) {
  double most = 0;
  for (const double x : values) most = std::max(most, std::abs(x));
  return most;
}

double mean_of(std::span<const double> values, bool size) {
  double sum = 0;
  for (const double x : values) sum += size ? std::abs(x) : x;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

std::vector<double> features_of(std::span<const double> position, std::span<const double> velocity,
                                const MotionLimits& limits) {
  const double range = limits.highest_rad - limits.lowest_rad;
  const auto [low, high] = std::ranges::minmax(position);
  return {mean_of(velocity, false) / limits.speed_rad_s,
          mean_of(velocity, true) / limits.speed_rad_s, mean_of(position, false) / range,
          low / range, high / range};
}

std::vector<double> features_of(const PlannedMovement& wanted, const MotionLimits& limits) {
  const simulation::Movement motion = simulation::motion_for(wanted, limits);
  const auto steps = static_cast<std::size_t>(motion.duration_s() * kFeatureRate_hz);
  std::vector<double> position;
  std::vector<double> velocity;
  for (std::size_t i = 0; i <= steps; ++i) {
    const simulation::MotionState now = motion.at(static_cast<double>(i) / kFeatureRate_hz);
    position.push_back(now.position_rad);
    velocity.push_back(now.velocity_rad_s);
  }
  return features_of(position, velocity, limits);
}

// Size and phase of a declared gravity torque, as a sine of the position.
void fit_gravity(const Dataset& data, std::span<const double> position, MotionLimits& limits) {
  const Channel* gravity = data.find(Role::gravity_torque);
  if (gravity == nullptr || largest(gravity->values) == 0) return;
  const auto rows = static_cast<Eigen::Index>(position.size());
  Eigen::MatrixXd waves(rows, 2);
  for (Eigen::Index i = 0; i < rows; ++i) {
    waves(i, 0) = elementary::sin(position[static_cast<std::size_t>(i)]);
    waves(i, 1) = elementary::cos(position[static_cast<std::size_t>(i)]);
  }
  const Eigen::Map<const Eigen::VectorXd> torque(gravity->values.data(), rows);
  const Eigen::Vector2d size = PivotedQr(waves).solve(torque);
  limits.gravity_nm = size.norm();
  // The angle of (cosine, sine): each step leaves a third power of what was left.
  double phase = size[0] >= 0 ? 0 : std::numbers::pi;
  for (int k = 0; k < kPhaseSteps; ++k) {
    phase += (size[1] * elementary::cos(phase) - size[0] * elementary::sin(phase)) / size.norm();
  }
  limits.gravity_phase_rad = phase;
}

// What the recordings cover is allowed, and nothing else.
MotionLimits limits_of(const Dataset& data, double gear_ratio, std::string_view place) {
  const std::span<const double> time = values_of(data, Role::time, place);
  const std::span<const double> position = values_of(data, Role::position, place);
  const std::span<const double> velocity = values_of(data, Role::velocity, place);
  const bool has_torque =
      std::ranges::any_of(kTorques, [&](Role role) { return data.find(role) != nullptr; });
  if (!has_torque) values_of(data, Role::friction_torque, place);
  MotionLimits limits;
  const auto [low, high] = std::ranges::minmax(position);
  limits.lowest_rad = low;
  limits.highest_rad = high;
  limits.speed_rad_s = largest(velocity);
  if (!(low < high) || !(limits.speed_rad_s > 0)) {
    throw_bad_input("nothing moves", place, "give recordings of motion, the position in rad");
  }
  if (const Channel* change = data.find(Role::acceleration)) {
    limits.acceleration_rad_s2 = std::max(largest(change->values), limits.speed_rad_s);
  }
  limits.torque_nm = kAnything;  // what was recorded was possible
  limits.temperature_rise_k = kAnyWarmth_k;
  if (const Channel* sensor = data.find(Role::temperature)) {
    limits.ambient_degc = *std::ranges::min_element(sensor->values);
  }
  if (const Channel* other = data.find(Role::other_velocity)) {
    limits.greatest_other_velocity_rad_s = largest(other->values);
  }
  limits.longest_rest_s = 0;
  limits.gear_ratio = gear_ratio;
  limits.seconds = 0;
  for (std::size_t i = 1; i < time.size(); ++i) {
    if (data.movement[i] == data.movement[i - 1]) limits.seconds += time[i] - time[i - 1];
  }
  if (!(limits.seconds > 0)) throw_bad_input("no time passes", place, "give the column of time");
  limits.rate_hz = static_cast<double>(data.rows()) / limits.seconds;
  fit_gravity(data, position, limits);
  return limits;
}

// Channels under names that say what they are, so that they read back without --roles.
Dataset named_by_roles(const Dataset& data) {
  Dataset out = data;
  std::erase_if(out.channels, [](const Channel& one) {
    return one.role == Role::none || one.role == Role::movement;
  });
  for (Channel& channel : out.channels) {
    std::string unit = channel.unit == "-" ? "" : channel.unit;
    std::erase(unit, ' ');
    channel.name = std::string(role_name(channel.role)) + unit_suffix(unit);
  }
  return out;
}

// The rows first .. last - 1, as one movement.
Dataset rows_from(const Dataset& data, std::size_t first, std::size_t last) {
  Dataset out;
  out.name = data.name;
  for (const Channel& channel : data.channels) {
    const auto begin = channel.values.begin();
    out.channels.push_back(
        {channel.name,
         channel.unit,
         channel.role,
         {begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(last)}});
  }
  out.movement_names = {data.movement_names[static_cast<std::size_t>(data.movement[first])]};
  out.movement.assign(last - first, 0);
  return out;
}

}  // namespace

RecordedWorld RecordedWorld::create(const std::filesystem::path& folder, const Dataset& data,
                                    double longest_s, double gear_ratio) {
  if (std::filesystem::exists(folder / "world.json")) {
    throw_bad_input("there is a world already", folder.string(), "choose another folder");
  }
  const Dataset recordings = loop::cut_movements(named_by_roles(data), longest_s);
  const MotionLimits limits = limits_of(recordings, gear_ratio, data.name);
  make_output_folder(folder);
  write_csv(recordings, folder / "recordings.csv");
  const Json known = {
      {"world", 1},
      {"recordings", recordings.movement_names.size()},
      {"recordings_sha256", sha256_of(folder / "recordings.csv")},
      {"limits", Json::parse(limits_json(limits))},
  };
  write_file(folder / "world.json", write_json(known, 1) + "\n");
  return RecordedWorld(folder);
}

bool RecordedWorld::is_in(const std::filesystem::path& folder) {
  return std::filesystem::exists(folder / "recordings.csv");
}

RecordedWorld::RecordedWorld(const std::filesystem::path& folder) : folder_(folder) {
  const std::string file = (folder / "world.json").string();
  const std::string text = read_file_text(file);
  limits_ = read_limits(text, file);
  const Json known = read_json_or_throw<Json>(text, file);
  if (known.value("recordings_sha256", std::string()) != sha256_of(folder / "recordings.csv")) {
    throw_bad_input("recordings.csv is not as it was when the world was made", folder.string(),
                    "make the world again");
  }
  take_over(read_csv(folder / "recordings.csv").data);
  position_rad_ = recorded_.front().rows.find(Role::position)->values.front();
  const std::filesystem::path asked = folder / "executed.csv";
  if (!std::filesystem::exists(asked)) return;
  Answer answer;
  const std::vector<PlannedMovement> given =
      read_movements(read_file_text(asked.string()), asked.string());
  if (given.size() > recorded_.size()) {
    throw_bad_input(fmt::format("{} movements were asked for, and there are {} recordings",
                                given.size(), recorded_.size()),
                    asked.string(), "make the world again");
  }
  for (const PlannedMovement& one : given) give(one, answer);
}

void RecordedWorld::take_over(const Dataset& recordings) {
  const std::vector<double>& time = recordings.find(Role::time)->values;
  for (std::size_t first = 0; first < recordings.rows();) {
    std::size_t last = first;
    while (last < recordings.rows() && recordings.movement[last] == recordings.movement[first]) {
      ++last;
    }
    Recorded one;
    one.rows = rows_from(recordings, first, last);
    one.name = one.rows.movement_names.front();
    one.seconds = time[last - 1] - time[first];
    one.features = features_of(one.rows.find(Role::position)->values,
                               one.rows.find(Role::velocity)->values, limits_);
    recorded_.push_back(std::move(one));
    first = last;
  }
}

RecordedWorld::Recorded& RecordedWorld::nearest(const PlannedMovement& wanted) {
  const std::vector<double> features = features_of(wanted, limits_);
  Recorded* best = nullptr;
  double least = 0;
  for (Recorded& one : recorded_) {
    if (one.given) continue;
    double squares = 0;
    for (std::size_t k = 0; k < features.size(); ++k) {
      squares += (one.features[k] - features[k]) * (one.features[k] - features[k]);
    }
    if (best != nullptr && !(squares < least)) continue;
    best = &one;
    least = squares;
  }
  return *best;
}

void RecordedWorld::give(const PlannedMovement& wanted, Answer& answer) {
  Recorded& one = nearest(wanted);
  one.given = true;
  used_s_ += one.seconds;
  position_rad_ = one.rows.find(Role::position)->values.back();
  asked_.push_back(wanted);
  loop::append_movement(answer.rows, one.rows);
  answer.given.push_back(one.name);
}

RecordedWorld::Answer RecordedWorld::execute(const std::vector<PlannedMovement>& wanted,
                                             const std::string& file, const KeepRows& keep) {
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const std::string place = fmt::format("{}, movement {}", file, i + 1);
    if (asked_.size() + i >= recorded_.size()) {
      throw_bad_input(fmt::format("all {} recorded movements have been given", recorded_.size()),
                      place, "ask for fewer; a new world has all of them again");
    }
    if (const BrokenLimit limit = broken_limit(wanted[i], limits_); limit.broken()) {
      throw_bad_input(limit.what, place, limit.mend);
    }
  }
  Answer answer;
  for (const PlannedMovement& one : wanted) give(one, answer);
  if (keep) keep(answer.rows);
  const std::filesystem::path part = folder_ / "executed.csv.part";
  write_file(part, movements_text(asked_, "rad", "rad/s"));
  std::filesystem::rename(part, folder_ / "executed.csv");
  return answer;
}

}  // namespace tribench
