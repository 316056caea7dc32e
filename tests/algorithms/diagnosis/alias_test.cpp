// SPDX-License-Identifier: MIT
//
// Which families are told to be another name of an effect.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "foundation/random.hpp"
#include "problems/dataset.hpp"
#include "tests/algorithms/diagnosis/planted_diagnosis.hpp"

namespace tribench::loop {
namespace {

TEST(Aliases, WhatLooksOtherwiseOrStandsBesideAnEffectIsNoAliasOfIt) {
  using Pair = std::pair<const char*, const char*>;
  for (const Pair& pair : {Pair{"hysteresis", "power_quadrant_step"}, Pair{"payload", "coupling"},
                           Pair{"stribeck", "power_quadrant_gain"}}) {
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
      const Diagnosis diagnosis =
          diagnose_planted({.effects = {{pair.first, 1.0}, {pair.second, 1.0}}}, seed);
      for (const EffectFinding& effect : diagnosis.effects) {
        for (const AliasFinding& alias : effect.aliases) {
          EXPECT_GE(alias.correlation, 0.5) << effect.family << " and " << alias.family;
          const auto other =
              std::ranges::find(diagnosis.effects, alias.family, &EffectFinding::family);
          const bool is_later = other != diagnosis.effects.end() && other->order > effect.order;
          EXPECT_FALSE(is_later) << effect.family << " and " << alias.family;
        }
      }
    }
  }
}

// Strokes of a campaign in which the joint warms up or wears, `effect` (of the temperature and of
// the time, 0 to 1) being a part of its Coulomb friction.
template <typename Effect>
Observations warming_campaign(Effect effect, std::uint64_t seed) {
  RandomStream random(seed);
  constexpr int kMovements = 80;
  constexpr std::size_t kStroke = 100;
  std::vector<std::vector<double>> columns(5);  // time, velocity, acceleration, temperature, torque
  Dataset data;
  for (int m = 0; m < kMovements; ++m) {
    data.movement_names.push_back(std::to_string(m));
    const double direction = m % 2 == 0 ? 1 : -1;
    const double top = random.uniform(0.3, 1.5);
    for (std::size_t i = 0; i < kStroke; ++i) {
      const double phase = std::numbers::pi * (static_cast<double>(i) + 1) / (kStroke + 1);
      const double t = 3.0 * m + 0.01 * static_cast<double>(i);
      const double now = t / (3.0 * kMovements);
      const double temperature = 25 + 20 * (1 - std::exp(-3 * now));
      const double v = direction * top * std::sin(phase);
      const double torque = direction * (4 + effect(temperature, now)) + 3 * v;
      const double row[] = {t, v, direction * top * std::numbers::pi * std::cos(phase),
                            std::round(temperature * 10) / 10, torque + 0.15 * random.normal()};
      for (std::size_t k = 0; k < columns.size(); ++k) columns[k].push_back(row[k]);
      data.movement.push_back(m);
    }
  }
  data.channels = {{"t", "s", Role::time, columns[0]},
                   {"v", "rad/s", Role::velocity, columns[1]},
                   {"a", "rad/s^2", Role::acceleration, columns[2]},
                   {"T", "degC", Role::temperature, columns[3]},
                   {"tau", "N m", Role::friction_torque, columns[4]}};
  return observe(data);
}

// Where the temperature only rises, friction that changes with it changes with time as well. Which
// of the two needs to be rescued because few movements carry it is chance.
TEST(Aliases, TimeIsNoSurerThanATemperatureThatOnlyRises) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Observations data = warming_campaign(
        [](double temperature, double) { return 0.05 * (temperature - 30); }, seed);
    const Diagnosis diagnosis = diagnose(data, coulomb_viscous_base, {});
    ASSERT_FALSE(diagnosis.effects.empty()) << seed;
    for (const EffectFinding& effect : diagnosis.effects) {
      const bool is_told = effect.family == "temperature" ||
                           std::ranges::count(effect.aliases, "temperature", &AliasFinding::family);
      EXPECT_TRUE(is_told) << effect.family << " of seed " << seed;
    }
  }
}

// A slow change and the base may share Coulomb friction as they like: an effect's size must not
// hang on how they do.
TEST(Aliases, AnEffectIsAsLargeAsWhatTheBaseCannotDo) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Observations data = warming_campaign([](double, double now) { return now; }, seed);
    const Diagnosis diagnosis = diagnose(data, coulomb_viscous_base, {});
    ASSERT_EQ(families(diagnosis), std::vector<std::string>{"drift"}) << seed;
    EXPECT_NEAR(diagnosis.effects[0].rms_contribution, std::sqrt(1.0 / 12), 0.03) << seed;
  }
}

// sin q is q where the joint turns by a few degrees: there a mass pulls as a spring does.
TEST(Aliases, AMassAndASpringAreToldApartByTheRangeOfMotionAlone) {
  for (const bool turns_far : {true, false}) {
    Observations data = observe(kuka::make_planted({}, 6).data);
    const auto position = std::ranges::find(data.signals, "q", &Signal::name);
    for (std::size_t i = 0; i < data.rows(); ++i) {
      if (!turns_far) position->values[i] *= 0.1;
      data.target[i] += (turns_far ? 0.5 : 5) * position->values[i];
    }
    const Diagnosis diagnosis = diagnose_most(data, options_of_planted());
    ASSERT_EQ(families(diagnosis), std::vector<std::string>{"spring"}) << turns_far;
    EXPECT_EQ(std::ranges::count(diagnosis.effects[0].aliases, "payload", &AliasFinding::family),
              turns_far ? 0 : 1);
  }
}

// One movement of 300 s, in pieces: the joint turns on and on or to and fro, and friction is larger
// by 1 N m at its end, or at the end of its way.
Observations one_movement(bool turns_back, bool wears, std::uint64_t seed) {
  RandomStream random(seed);
  constexpr std::size_t kRows = 3000;
  constexpr double kStep = 0.1;
  std::vector<std::vector<double>> columns(4);  // time, position, velocity, friction
  Dataset data;
  double q = 0;
  double farthest = 0;
  double aim = 1;
  double v = 1;
  for (std::size_t i = 0; i < kRows; ++i) {
    if (i % 40 == 0) aim = random.uniform(0.3, 1.7) * (turns_back && i % 80 == 0 ? -1 : 1);
    v += 0.2 * (aim - v);
    q += kStep * v;
    farthest = std::max(farthest, std::abs(q));
    const double row[] = {kStep * static_cast<double>(i), q, v, v > 0 ? 4 + 3 * v : -4 + 3 * v};
    for (std::size_t k = 0; k < columns.size(); ++k) columns[k].push_back(row[k]);
    data.movement.push_back(static_cast<int>(5 * i / kRows));
  }
  for (std::size_t i = 0; i < kRows; ++i) {
    const double now = static_cast<double>(i) / kRows;
    const double change = wears ? (columns[2][i] > 0 ? now : -now) : columns[1][i] / farthest;
    columns[3][i] += change + 0.1 * random.normal();
  }
  for (int m = 0; m < 5; ++m) data.movement_names.push_back(std::to_string(m));
  data.channels = {{"t", "s", Role::time, columns[0]},
                   {"q", "rad", Role::position, columns[1]},
                   {"v", "rad/s", Role::velocity, columns[2]},
                   {"tau", "N m", Role::friction_torque, columns[3]}};
  Observations observations = observe(data);
  observations.withheld.push_back({"t", "there is one movement"});
  return observations;
}

// Of one movement the time is withheld; where it goes with the position a spring may be a drift.
TEST(Aliases, WhatIsWithheldMayStillBeWhatWasFound) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    for (const bool wears : {true, false}) {
      const Diagnosis on_and_on =
          diagnose(one_movement(false, wears, seed), coulomb_viscous_base, {});
      ASSERT_FALSE(on_and_on.effects.empty()) << seed;
      EXPECT_EQ(on_and_on.effects[0].family, "spring");
      EXPECT_EQ(std::ranges::count(on_and_on.effects[0].aliases, "drift", &AliasFinding::family), 1)
          << seed << wears;
    }
    const Diagnosis to_and_fro =
        diagnose(one_movement(true, false, seed), coulomb_viscous_base, {});
    ASSERT_EQ(families(to_and_fro), std::vector<std::string>{"spring"}) << seed;
    EXPECT_EQ(std::ranges::count(to_and_fro.effects[0].aliases, "drift", &AliasFinding::family), 0)
        << seed;
  }
}

// Twelve and a half waves a turn over a fifth of one: no ripple of the library, but a sum of some
// and of a mass whose torques cancel. What is there only to cancel the others is not sure.
TEST(Aliases, WhatTheOtherEffectsCanTellIsProvisional) {
  RandomStream random(3);
  constexpr std::size_t kStroke = 150;
  std::vector<std::vector<double>> columns(4);  // position, velocity, gravity, friction
  Dataset data;
  for (int m = 0; m < 40; ++m) {
    data.movement_names.push_back(std::to_string(m));
    const double v = (m % 2 == 0 ? 1 : -1) * (0.2 + 0.02 * m);
    for (std::size_t i = 0; i < kStroke; ++i) {
      const double way = 1.2 * static_cast<double>(i) / (kStroke - 1) - 0.6;
      const double q = v > 0 ? way : -way;
      const double friction = (v > 0 ? 5 : -5) + 3 * v + std::cos(12.5 * q + 0.3);
      const double row[] = {q, v, 14 * std::sin(q + 0.4), friction + 0.1 * random.normal()};
      for (std::size_t k = 0; k < columns.size(); ++k) columns[k].push_back(row[k]);
      data.movement.push_back(m);
    }
  }
  data.channels = {{"q", "rad", Role::position, columns[0]},
                   {"v", "rad/s", Role::velocity, columns[1]},
                   {"g", "N m", Role::gravity_torque, columns[2]},
                   {"tau", "N m", Role::friction_torque, columns[3]}};
  for (const bool with_rule : {true, false}) {
    DiagnosisOptions options{.gear_ratios = {160}};
    if (!with_rule) options.without = {"cancelling"};
    const Diagnosis diagnosis = diagnose(observe(data), coulomb_viscous_base, options);
    const auto payload = std::ranges::find(diagnosis.effects, "payload", &EffectFinding::family);
    ASSERT_NE(payload, diagnosis.effects.end());
    EXPECT_GT(payload->rms_contribution, 0.3);
    EXPECT_EQ(payload->told_by_others, with_rule);
    EXPECT_EQ(payload->provisional, with_rule);
    EXPECT_FALSE(diagnosis.effects[0].told_by_others) << diagnosis.effects[0].family;
  }
}

}  // namespace
}  // namespace tribench::loop
