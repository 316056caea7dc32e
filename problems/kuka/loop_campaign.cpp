// SPDX-License-Identifier: MIT
#include "problems/kuka/loop_campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "foundation/elementary.hpp"
#include "problems/campaign_channels.hpp"
#include "problems/kuka/campaign.hpp"
#include "problems/kuka/joint.hpp"

namespace tribench::kuka {
namespace {

constexpr std::size_t kInstantsA = 40;
constexpr std::size_t kInstantsD = 120;
constexpr double kDurationD_s = 12;
constexpr double kOtherJointMoves = 0.6;
// Parts of the time in motion: the constant of warming and cooling, and the pause half way.
constexpr double kThermalConstant = 0.22;
constexpr double kCoolDown = 0.25;

struct Posture {
  double gravity_nm;
  double phase_rad;
};
constexpr std::array<Posture, 2> kPostures = {{{42.4, 0.0}, {25.0, 0.5}}};

// x(t) = sum of amplitude sin(rate t + phase), with its derivatives.
struct Tone {
  double amplitude = 0;
  double rate = 0;
  double phase = 0;
};

struct State {
  double position = 0;
  double velocity = 0;
  double acceleration = 0;
};

struct Motion {
  double duration_s = 0;
  double start_rad = 0;       // of a crossing; the centre of a trajectory
  double velocity_rad_s = 0;  // of a crossing; 0 for a trajectory
  std::array<Tone, 2> tones;
  Tone other;
  Posture posture{};
  bool is_crossing() const { return velocity_rad_s != 0; }
};

State at(const Tone& tone, double t) {
  const double angle = tone.rate * t + tone.phase;
  const double sine = tone.amplitude * elementary::sin(angle);
  return {sine, tone.amplitude * tone.rate * elementary::cos(angle), -tone.rate * tone.rate * sine};
}

State at(const Motion& motion, double t) {
  if (motion.is_crossing()) {
    return {motion.start_rad + motion.velocity_rad_s * t, motion.velocity_rad_s, 0};
  }
  const State a = at(motion.tones[0], t);
  const State b = at(motion.tones[1], t);
  return {motion.start_rad + a.position + b.position, a.velocity + b.velocity,
          a.acceleration + b.acceleration};
}

Motion make_crossing(double velocity_rad_s, RandomStream& random) {
  Motion motion;
  motion.velocity_rad_s = velocity_rad_s;
  motion.start_rad = velocity_rad_s > 0 ? -kStrokeEnd_rad : kStrokeEnd_rad;
  motion.duration_s = 2 * kStrokeEnd_rad / std::abs(velocity_rad_s);
  motion.posture = kPostures[random.below(kPostures.size())];
  return motion;
}

Motion make_trajectory(RandomStream& random) {
  Motion motion;
  motion.duration_s = kDurationD_s;
  const double slow = random.uniform(0.5, 1.6);
  const double fast = slow * random.uniform(1.5, 2.5);
  const double peak = random.uniform(0.35, 0.67);
  const double share = random.uniform(0.3, 0.7);
  motion.tones[0] = {share * peak / slow, slow, random.uniform(0, 2 * kPi)};
  motion.tones[1] = {(1 - share) * peak / fast, fast, random.uniform(0, 2 * kPi)};
  const double reach = motion.tones[0].amplitude + motion.tones[1].amplitude;
  const double room = std::max(0.0, kStrokeEnd_rad - reach);
  motion.start_rad = random.uniform(-room, room);
  if (random.chance(kOtherJointMoves)) {
    const double rate = random.uniform(0.5, 2.0);
    motion.other = {random.uniform(0.2, 0.6) / rate, rate, random.uniform(0, 2 * kPi)};
  }
  motion.posture = kPostures[random.below(kPostures.size())];
  return motion;
}

std::vector<Motion> make_motions(int constant_velocity, int trajectories, RandomStream random) {
  std::vector<Motion> motions;
  const int speeds = constant_velocity / 2;
  for (int i = 0; i < speeds; ++i) {
    const double part = speeds > 1 ? static_cast<double>(i) / (speeds - 1) : 0.5;
    const double speed = kSlowest_rad_s + (kFastest_rad_s - kSlowest_rad_s) * part;
    motions.push_back(make_crossing(speed, random));
    motions.push_back(make_crossing(-speed, random));
  }
  for (int i = 0; i < trajectories; ++i) motions.push_back(make_trajectory(random));
  random.shuffle(std::span(motions));
  return motions;
}

std::vector<double> instants_of(const Motion& motion, RandomStream& random) {
  std::vector<double> instants;
  if (motion.is_crossing()) {
    instants.push_back(0);
    for (std::size_t i = 1; i < kInstantsA; ++i) {
      instants.push_back(random.uniform(0, motion.duration_s));
    }
    std::sort(instants.begin(), instants.end());
  } else {
    for (std::size_t i = 0; i < kInstantsD; ++i) {
      instants.push_back(motion.duration_s * static_cast<double>(i) / kInstantsD);
    }
  }
  return instants;
}

// Where the velocity changes sign between two instants, by bisection.
double reversal_between(const Motion& motion, double low, double high) {
  const bool positive = at(motion, low).velocity > 0;
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    ((at(motion, middle).velocity > 0) == positive ? low : high) = middle;
  }
  return low;
}

std::vector<double> distances_of(const Motion& motion, std::span<const double> instants) {
  std::vector<double> distances;
  double reversal_rad = at(motion, instants.front()).position;
  for (std::size_t i = 0; i < instants.size(); ++i) {
    const State state = at(motion, instants[i]);
    if (i > 0 && at(motion, instants[i - 1]).velocity * state.velocity < 0) {
      reversal_rad = at(motion, reversal_between(motion, instants[i - 1], instants[i])).position;
    }
    distances.push_back(std::abs(state.position - reversal_rad));
  }
  return distances;
}

// Warming towards the warmest, a pause half way in which the joint cools.
struct Thermal {
  double total_s;  // of motion

  double pause_start_s() const { return total_s / 2; }
  double pause_s() const { return kCoolDown * total_s; }
  // Of the joint after `moving_s` seconds of motion, the pause left out.
  double temperature_after(double moving_s) const {
    const double range = kWarmest_degc - kCoolest_degc;
    const auto missing = [&](double seconds) {
      return elementary::exp(-seconds / (kThermalConstant * total_s));
    };
    if (moving_s < pause_start_s()) return kWarmest_degc - range * missing(moving_s);
    const double before_pause = range * (1 - missing(pause_start_s()));
    const double after_pause = before_pause * missing(pause_s());
    return kWarmest_degc - (range - after_pause) * missing(moving_s - pause_start_s());
  }
  double whole_s() const { return total_s + pause_s(); }
  double campaign_s(double moving_s) const {
    return moving_s < pause_start_s() ? moving_s : moving_s + pause_s();
  }
};

// The rows of one movement that starts after `start_s` seconds of motion.
void record(const Motion& motion, double start_s, const Thermal& thermal, RandomStream draw,
            LoopCampaign& campaign) {
  const std::vector<double> instants = instants_of(motion, draw);
  const std::vector<double> distances = distances_of(motion, instants);
  const int movement = static_cast<int>(campaign.data.movement_names.size()) - 1;
  for (std::size_t i = 0; i < instants.size(); ++i) {
    const State state = at(motion, instants[i]);
    const State other = at(motion.other, instants[i]);
    const double time_s = thermal.campaign_s(start_s + instants[i]);
    append_campaign_row(campaign.data, movement,
                        {.time_s = time_s,
                         .position_rad = state.position,
                         .velocity_rad_s = state.velocity,
                         .acceleration_rad_s2 = state.acceleration,
                         .gravity_nm = motion.posture.gravity_nm *
                                       elementary::sin(state.position + motion.posture.phase_rad),
                         .temperature_degc = thermal.temperature_after(start_s + instants[i]),
                         .other_velocity_rad_s = other.velocity,
                         .other_acceleration_rad_s2 = other.acceleration});
    campaign.distance_rad.push_back(distances[i]);
    campaign.campaign_part.push_back(time_s / thermal.whole_s());
  }
}

}  // namespace

LoopCampaign make_loop_campaign(int constant_velocity, int trajectories,
                                const RandomStream& random) {
  const std::vector<Motion> motions =
      make_motions(constant_velocity, trajectories, random.split("motions"));
  Thermal thermal{0};
  for (const Motion& motion : motions) {
    thermal.total_s += motion.duration_s + kPauseBetweenMovements_s;
  }

  LoopCampaign campaign{blank_campaign("A+D"), {}, {}};
  double start_s = 0;
  for (std::size_t m = 0; m < motions.size(); ++m) {
    campaign.data.movement_names.push_back(
        fmt::format("{}{:03}", motions[m].is_crossing() ? 'A' : 'D', m + 1));
    record(motions[m], start_s, thermal, random.split("instants").split(m), campaign);
    start_s += motions[m].duration_s + kPauseBetweenMovements_s;
  }
  return campaign;
}

}  // namespace tribench::kuka
