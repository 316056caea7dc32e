// SPDX-License-Identifier: MIT
#include "problems/kuka/campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "foundation/elementary.hpp"
#include "foundation/random.hpp"
#include "foundation/sign.hpp"

namespace tribench::kuka {
namespace {

constexpr std::size_t kAveragingInstants = 6000;
constexpr double kDurationB_s = 43.0;

RandomStream stream_of(const Joint& joint, std::uint64_t seed) {
  return RandomStream(key_of(fmt::format("kuka/j{}", joint.number))).split(seed);
}

// A constant-velocity crossing of the stroke, against the direction from the other end.
struct Crossing {
  double velocity_rad_s;
  std::size_t samples;  // at 1 kHz

  double position_at(double time_s) const {
    return -sign(velocity_rad_s) * kStrokeEnd_rad + velocity_rad_s * time_s;
  }
};

Crossing crossing_of(const Setting& setting) {
  const double speed = commanded_speeds()[static_cast<std::size_t>(setting.speed)];
  return {setting.direction * speed,
          static_cast<std::size_t>(2 * kStrokeEnd_rad / speed * kSampleRate_hz)};
}

// Adds rows channel by channel; the channels are declared once.
class Recorder {
 public:
  explicit Recorder(std::string name) { record_.data.name = std::move(name); }

  void declare(std::string name, std::string unit, Role role) {
    record_.data.channels.push_back({std::move(name), std::move(unit), role, {}});
  }
  void start_movement(std::string name) { record_.data.movement_names.push_back(std::move(name)); }
  void add(std::span<const double> values, double truth) {
    for (std::size_t j = 0; j < values.size(); ++j) {
      record_.data.channels[j].values.push_back(values[j]);
    }
    record_.data.movement.push_back(static_cast<int>(record_.data.movement_names.size()) - 1);
    record_.truth.push_back(truth);
  }
  KnownDataset take() { return std::move(record_); }

 private:
  KnownDataset record_;
};

std::string movement_name(std::size_t i) { return fmt::format("m{:02}", i + 1); }

// One movement of B: velocity and position at 1 kHz.
struct DwellMotion {
  std::vector<double> velocity_rad_s;
  std::vector<double> position_rad;
};

DwellMotion make_dwell_motion(RandomStream& random) {
  constexpr std::array<double, 5> kSpeedsB = {0.05, 0.1, 0.15, 0.2, 0.3};
  const auto total = static_cast<std::size_t>(kDurationB_s * kSampleRate_hz);
  DwellMotion motion;
  double position = random.uniform(-1.5, 1.5);
  while (motion.velocity_rad_s.size() < total) {
    const double duration = random.uniform(1.5, 5.0);
    double velocity = random.sign() * kSpeedsB[random.below(kSpeedsB.size())];
    // A segment that would leave the stroke runs the other way.
    if (std::abs(position + velocity * duration) > kStrokeEnd_rad) velocity = -velocity;
    const auto samples = static_cast<std::size_t>(duration * kSampleRate_hz);
    for (std::size_t k = 0; k < samples && motion.velocity_rad_s.size() < total; ++k) {
      motion.velocity_rad_s.push_back(velocity);
      motion.position_rad.push_back(position);
      position += velocity / kSampleRate_hz;
    }
  }
  return motion;
}

// Gravity torque of B for 1 N m of amplitude: the other joints' motion shifts and scales it.
double posture_factor(double position_rad, double time_s, double phase_rad) {
  return elementary::sin(position_rad + 0.6 * elementary::sin(0.25 * time_s + phase_rad)) *
         (1 - 0.08 * elementary::cos(0.17 * time_s));
}

// The rows of one movement of B.
void record_dwells(const Joint& joint, double payload_kg, double start_s,
                   std::size_t samples_per_movement, RandomStream random, Recorder& recorder) {
  const double payload_nm = kStandardGravity * payload_kg * joint.payload_lever_m;
  const double scale = joint.noise_scale_b;
  const DwellMotion motion = make_dwell_motion(random);
  const double phase = random.uniform(0, 2 * kPi);
  const double offset = scale * joint.movement_noise_nm * random.normal();
  for (std::size_t i = 0; i < samples_per_movement; ++i) {
    const double part =
        (static_cast<double>(i) + random.uniform()) / static_cast<double>(samples_per_movement);
    const auto k = static_cast<std::size_t>(part * static_cast<double>(motion.position_rad.size()));
    const double time_s = static_cast<double>(k) / kSampleRate_hz;
    const double q = motion.position_rad[k];
    const double v = motion.velocity_rad_s[k];
    const double posture = posture_factor(q, time_s, phase);
    const double arm = joint.gravity_amplitude_nm * posture;
    const double external = payload_nm * posture;
    const double g = arm + external;
    const double truth = joint.law.at(v, g) + joint.shift_at(v, g);
    const double noise = ripple_at(joint.ripple, q) + joint.sample_noise_nm * random.normal();
    const double friction = truth + offset + scale * noise;
    recorder.add(std::array{start_s + time_s, q, v, sign(v), g, sign(g), arm, external,
                            g + friction, friction},
                 truth);
  }
}

}  // namespace

std::vector<Setting> campaign_order(const Joint& joint, std::uint64_t seed) {
  std::vector<Setting> settings;
  for (int speed = 0; speed < kSpeeds; ++speed) {
    settings.push_back({speed, 1});
    settings.push_back({speed, -1});
  }
  RandomStream random = stream_of(joint, seed).split("order");
  random.shuffle(std::span(settings));
  return settings;
}

namespace {

// What both campaigns record of the joint itself, in the order of their rows.
void declare_motion(Recorder& recorder) {
  recorder.declare("time_s", "s", Role::time);
  recorder.declare("q", "rad", Role::position);
  recorder.declare("qd", "rad/s", Role::velocity);
  recorder.declare("sgn_qd", "-", Role::velocity_sign);
  recorder.declare("g", "N m", Role::gravity_torque);
  recorder.declare("sgn_g", "-", Role::gravity_sign);
}

}  // namespace

KnownDataset make_a_raw(const Joint& joint, std::uint64_t seed, std::size_t samples_per_movement) {
  Recorder recorder("A");
  declare_motion(recorder);
  recorder.declare("tau_f", "N m", Role::friction_torque);
  const std::vector<Setting> settings = campaign_order(joint, seed);
  const RandomStream campaign = stream_of(joint, seed).split("A");
  double start_s = 0;
  for (std::size_t m = 0; m < settings.size(); ++m) {
    recorder.start_movement(movement_name(m));
    const Crossing crossing = crossing_of(settings[m]);
    RandomStream random = campaign.split(m);
    const double offset = joint.movement_noise_nm * random.normal();
    for (std::size_t i = 0; i < samples_per_movement; ++i) {
      const double part =
          (static_cast<double>(i) + random.uniform()) / static_cast<double>(samples_per_movement);
      const double time_s =
          std::floor(part * static_cast<double>(crossing.samples)) / kSampleRate_hz;
      const double q = crossing.position_at(time_s);
      const double v = crossing.velocity_rad_s;
      const double g = joint.gravity_amplitude_nm * elementary::sin(q);
      const double truth = joint.law.at(v, g);
      const double friction =
          truth + ripple_at(joint.ripple, q) + offset + joint.sample_noise_nm * random.normal();
      recorder.add(std::array{start_s + time_s, q, v, sign(v), g, sign(g), friction}, truth);
    }
    start_s += static_cast<double>(crossing.samples) / kSampleRate_hz + kPauseBetweenMovements_s;
  }
  return recorder.take();
}

KnownDataset make_a_averaged(const Joint& joint, std::uint64_t seed) {
  Recorder recorder("A");
  recorder.declare("qd", "rad/s", Role::velocity);
  recorder.declare("sgn_qd", "-", Role::velocity_sign);
  recorder.declare("tau_f", "N m", Role::friction_torque);
  const std::vector<Setting> settings = campaign_order(joint, seed);
  const RandomStream campaign = stream_of(joint, seed).split("A averaged");
  const double mean_ripple = joint.mean_ripple_nm();
  for (std::size_t m = 0; m < settings.size(); ++m) {
    recorder.start_movement(movement_name(m));
    const Crossing crossing = crossing_of(settings[m]);
    const double v = crossing.velocity_rad_s;
    RandomStream random = campaign.split(m);
    const std::size_t instants = std::min(crossing.samples, kAveragingInstants);
    // Column by column: half a million instants are most of what a problem of A costs.
    std::vector<double> positions(instants);
    for (std::size_t i = 0; i < instants; ++i) {
      positions[i] =
          crossing.position_at((static_cast<double>(i) + 0.5) / static_cast<double>(instants) *
                               static_cast<double>(crossing.samples) / kSampleRate_hz);
    }
    std::vector<double> gravity = positions;
    elementary::sin_of_each(gravity);
    for (double& g : gravity) g *= joint.gravity_amplitude_nm;
    const std::vector<double> law = joint.law.at(v, gravity);
    const std::vector<double> ripple = ripple_at(joint.ripple, positions);
    double sum = 0;
    for (std::size_t i = 0; i < instants; ++i) sum += law[i] + ripple[i];
    const double noise =
        joint.movement_noise_nm * random.normal() +
        joint.sample_noise_nm * random.normal() / std::sqrt(static_cast<double>(crossing.samples));
    recorder.add(std::array{v, sign(v), sum / static_cast<double>(instants) + noise},
                 joint.law.averaged_at(v) + mean_ripple);
  }
  return recorder.take();
}

KnownDataset make_b(const Joint& joint, std::uint64_t seed, double payload_kg, int movements,
                    std::size_t samples_per_movement) {
  Recorder recorder("B");
  declare_motion(recorder);
  recorder.declare("g_arm", "N m", Role::none);
  recorder.declare("tau_ext", "N m", Role::external_torque);
  recorder.declare("tau_m", "N m", Role::motor_torque);
  recorder.declare("tau_f", "N m", Role::friction_torque);
  const RandomStream campaign =
      stream_of(joint, seed).split("B").split(key_of(fmt::format("{} kg", payload_kg)));
  for (int m = 0; m < movements; ++m) {
    recorder.start_movement(movement_name(static_cast<std::size_t>(m)));
    record_dwells(joint, payload_kg, m * (kDurationB_s + kPauseBetweenMovements_s),
                  samples_per_movement, campaign.split(static_cast<std::uint64_t>(m)), recorder);
  }
  return recorder.take();
}

}  // namespace tribench::kuka
