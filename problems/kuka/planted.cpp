// SPDX-License-Identifier: MIT
#include "problems/kuka/planted.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "foundation/elementary.hpp"
#include "foundation/random.hpp"
#include "problems/friction/planted_effects.hpp"
#include "problems/kuka/joint.hpp"
#include "problems/kuka/loop_campaign.hpp"

namespace tribench::kuka {
namespace {

constexpr std::size_t kCollisionRows = 6;

struct NoiseSettings {
  double row_sd_nm;
  double movement_sd_nm;
  double movement_factor;  // sd of the logarithm of a movement's noise level
  int degrees_of_freedom;
  double correlation;  // of neighbouring rows
  double speed_share;  // of the level that grows from 0 with speed
};

NoiseSettings settings_of(NoiseKind kind) {
  return kind == NoiseKind::ordinary ? NoiseSettings{0.30, 0.045, 0.2, 5, 0.6, 0.5}
                                     : NoiseSettings{0.30, 0.090, 0.2, 4, 0.85, 0.9};
}

// Student t, scaled to unit variance.
double student(RandomStream& random, int degrees_of_freedom) {
  const double normal = random.normal();
  double squares = 0;
  for (int i = 0; i < degrees_of_freedom; ++i) {
    const double x = random.normal();
    squares += x * x;
  }
  return normal * std::sqrt((degrees_of_freedom - 2) / squares);
}

double base_friction(double velocity_rad_s) {
  const double speed = std::abs(velocity_rad_s);
  if (velocity_rad_s == 0) return 0;
  return velocity_rad_s > 0 ? 8.0 + 14.1 * speed : -(9.3 + 14.8 * speed);
}

double root_mean_square(std::span<const double> values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

// The rows' noise; sets noise_sd, then adds the movements' offsets.
void add_noise(const Dataset& data, NoiseKind kind, const RandomStream& random,
               PlantedTruth& truth) {
  const NoiseSettings settings = settings_of(kind);
  const std::vector<double>& velocity = data.find(Role::velocity)->values;
  truth.noise.resize(data.rows());
  std::vector<double> offsets;
  for (std::size_t m = 0, r = 0; m < data.movement_names.size(); ++m) {
    RandomStream draw = random.split(m);
    offsets.push_back(settings.movement_sd_nm * draw.normal());
    const double level =
        settings.row_sd_nm * elementary::exp(settings.movement_factor * draw.normal());
    double state = 0;
    for (bool first = true; r < data.rows() && data.movement[r] == static_cast<int>(m); ++r) {
      const double fresh = student(draw, settings.degrees_of_freedom);
      state = first ? fresh
                    : settings.correlation * state +
                          std::sqrt(1 - settings.correlation * settings.correlation) * fresh;
      first = false;
      const double part = std::min(1.0, std::abs(velocity[r]) / kFastest_rad_s);
      truth.noise[r] = level * (1 - settings.speed_share + settings.speed_share * part) * state;
    }
  }
  truth.noise_sd = root_mean_square(truth.noise);
  for (std::size_t r = 0; r < data.rows(); ++r) {
    truth.noise[r] += offsets[static_cast<std::size_t>(data.movement[r])];
  }
}

JointState state_at(const LoopCampaign& campaign, std::size_t row) {
  const std::vector<Channel>& channels = campaign.data.channels;
  return {.position_rad = channels[1].values[row],
          .velocity_rad_s = channels[2].values[row],
          .acceleration_rad_s2 = channels[3].values[row],
          .gravity_nm = channels[4].values[row],
          .temperature_degc = channels[5].values[row],
          .campaign_part = campaign.campaign_part[row],
          .distance_rad = campaign.distance_rad[row],
          .other_velocity_rad_s = channels[6].values[row],
          .other_acceleration_rad_s2 = channels[7].values[row]};
}

PlantedEffect plant(const Plant& wanted, const LoopCampaign& campaign, double noise_sd,
                    RandomStream random) {
  const PlantedShape& shape = find_planted_shape(wanted.family);
  PlantedEffect effect{wanted.family, wanted.scale, 0, {}, {}, shape.lives_in, {}};
  if (shape.in_library) effect.names.push_back(wanted.family);
  for (std::size_t r = 0; r < campaign.data.rows(); ++r) {
    effect.values.push_back(shape.at(state_at(campaign, r)));
  }
  // An effect that these movements do not excite (inertia in A) stays absent, at coefficient 0.
  const double size = root_mean_square(effect.values);
  effect.coefficient = size > 0 ? random.sign() * wanted.scale * noise_sd / size : 0;
  for (double& value : effect.values) value *= effect.coefficient;
  return effect;
}

// A burst is half a sine over six rows, away from the movement's ends.
void add_collisions(const PlantedCase& planted, const Dataset& data, RandomStream random,
                    PlantedTruth& truth) {
  std::vector<std::size_t> first_row(data.movement_names.size() + 1, data.rows());
  for (std::size_t r = data.rows(); r-- > 0;) {
    first_row[static_cast<std::size_t>(data.movement[r])] = r;
  }
  std::vector<int> movements(data.movement_names.size());
  for (std::size_t m = 0; m < movements.size(); ++m) movements[m] = static_cast<int>(m);
  random.shuffle(std::span(movements));
  const auto wanted = static_cast<std::size_t>(std::max(0, planted.collisions));
  for (std::size_t i = 0; i < std::min(wanted, movements.size()); ++i) {
    const auto m = static_cast<std::size_t>(movements[i]);
    const std::size_t rows = first_row[m + 1] - first_row[m];
    const std::size_t first =
        first_row[m] + kCollisionRows + random.below(rows - 3 * kCollisionRows);
    const double peak = random.sign() * planted.collision_scale * truth.noise_sd;
    for (std::size_t k = 0; k < kCollisionRows; ++k) {
      const double part = (static_cast<double>(k) + 0.5) / kCollisionRows;
      truth.noise[first + k] += peak * elementary::sin(kPi * part);
    }
    truth.collisions.push_back({movements[i], first, first + kCollisionRows - 1, peak});
  }
}

}  // namespace

PlantedData make_planted(const PlantedCase& planted, std::uint64_t seed) {
  const RandomStream random = RandomStream(key_of("kuka/planted")).split(seed);
  LoopCampaign campaign =
      make_loop_campaign(planted.constant_velocity, planted.trajectories, random.split("campaign"));
  PlantedTruth truth;
  for (const double velocity : campaign.data.find(Role::velocity)->values) {
    truth.base.push_back(base_friction(velocity));
  }
  add_noise(campaign.data, planted.noise, random.split("noise"), truth);
  for (const Plant& wanted : planted.effects) {
    truth.effects.push_back(
        plant(wanted, campaign, truth.noise_sd, random.split("sign").split(wanted.family)));
  }
  add_collisions(planted, campaign.data, random.split("collisions"), truth);

  Channel friction{"friction_torque_Nm", "N m", Role::friction_torque, truth.noise_free()};
  for (std::size_t r = 0; r < friction.values.size(); ++r) friction.values[r] += truth.noise[r];
  campaign.data.channels.push_back(std::move(friction));
  return {std::move(campaign.data), std::move(truth)};
}

PlantedCase draw_pair(double scale, std::uint64_t seed) {
  RandomStream random = RandomStream(key_of("kuka/planted/pair")).split(seed);
  std::vector<std::string> families;
  for (const PlantedShape& shape : planted_shapes()) {
    if (shape.in_library) families.emplace_back(shape.family);
  }
  random.shuffle(std::span(families));
  PlantedCase pair;
  pair.effects = {{families[0], scale}, {families[1], scale}};
  return pair;
}

}  // namespace tribench::kuka
