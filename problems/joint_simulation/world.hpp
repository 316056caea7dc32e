// SPDX-License-Identifier: MIT
//
// A joint that can be asked: it executes movements one after the other and records them, within
// limits, while what its friction has beside Coulomb and viscous friction stays hidden. Causes have
// a memory that lasts from movement to movement; the lubricant warms; every movement has noise of
// its own.
//
//   World world({.seed = 7, .level = WorldLevel::medium});
//   const Dataset rows = world.execute(constant_movement(0.3, -1, 1, 1), "movement 1");
//
// Deterministic: the same plan and the same movements in the same order give the same bits. About
// 10 ms to make one, 0.1 ms a second of motion.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "problems/dataset.hpp"
#include "problems/experiment/motion_limits.hpp"
#include "problems/experiment/planned_movement.hpp"
#include "problems/friction/planted_data.hpp"
#include "problems/joint_simulation/causes.hpp"
#include "problems/joint_simulation/joint_recording.hpp"
#include "problems/joint_simulation/noise.hpp"

namespace tribench::simulation {

// How much is missing: nothing, one cause of the library, two, one that no library has.
enum class WorldKind { none, single, pair, unknown };
inline constexpr std::array kWorldKinds = {WorldKind::none, WorldKind::single, WorldKind::pair,
                                           WorldKind::unknown};
std::string_view world_kind_name(WorldKind kind);

// How hard it is to see: 2 to 4 times the noise, which is Gaussian; 1 to 2 times, noise of four
// kinds; 0.5 to 1 times, of all seven.
enum class WorldLevel { easy, medium, hard };
inline constexpr std::array kWorldLevels = {WorldLevel::easy, WorldLevel::medium, WorldLevel::hard};
std::string_view world_level_name(WorldLevel level);
// What is missing is so many times the noise at least; at most twice that.
double smallest_effect(WorldLevel level);

struct WorldPlan {
  std::uint64_t seed = 1;
  WorldLevel level = WorldLevel::medium;
  std::optional<WorldKind> kind = {};  // else drawn: 15, 45, 25 and 15 %
};

struct WorldTruth {
  WorldPlan plan;
  WorldKind kind = WorldKind::none;
  NoiseKind noise = NoiseKind::gaussian;
  double noise_sd_nm = 0;
  // What is missing, without values; the scale is over a campaign of usual movements.
  std::vector<PlantedEffect> effects;
};

class World {
 public:
  explicit World(const WorldPlan& plan);

  const MotionLimits& limits() const { return limits_; }
  double smallest_effect() const { return simulation::smallest_effect(truth_.plan.level); }
  const WorldTruth& truth() const { return truth_; }
  double seconds_used() const { return state_.used_s; }
  double position_rad() const { return state_.position_rad; }
  std::size_t movements() const { return state_.movements; }

  // The rows of the movement, at limits().rate_hz, friction torque and noise included; its cost is
  // added to seconds_used(). Throws Error (bad_input) at `place` where it breaks a limit: the world
  // is then as it was.
  Dataset execute(const PlannedMovement& wanted, std::string_view place);

 private:
  struct State {
    Thermal thermal{1, 1};
    std::vector<Response> responses;
    double time_s = 0;  // rests included
    double used_s = 0;  // motion alone
    double position_rad = 0;
    std::size_t movements = 0;
  };

  std::vector<Response> fresh_responses() const;
  void calibrate();
  // Runs a movement from the state's time on; rows go to `data` where there is one.
  void run(State& state, const Movement& movement, Dataset* data,
           std::vector<std::vector<double>>* values) const;
  std::vector<double> noise_of(std::size_t movement, const Dataset& data) const;
  // What is recorded as friction: base, effects, noise. Throws Error (bad_input) at `place` where
  // the motor would need more torque than it has.
  std::vector<double> friction_of(std::size_t movement, const Dataset& data,
                                  const std::vector<std::vector<double>>& effects,
                                  std::string_view place) const;

  RandomStream random_;
  MotionLimits limits_;
  WorldTruth truth_;
  State state_;
};

}  // namespace tribench::simulation
