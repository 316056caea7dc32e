// SPDX-License-Identifier: MIT
//
// Which families are told to be another name of an effect.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

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
      const std::vector<std::string> named = families(diagnosis);
      for (const EffectFinding& effect : diagnosis.effects) {
        for (const AliasFinding& alias : effect.aliases) {
          EXPECT_GE(alias.correlation, 0.5) << effect.family << " and " << alias.family;
          EXPECT_THAT(named, ::testing::Not(::testing::Contains(alias.family))) << effect.family;
        }
      }
    }
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

}  // namespace
}  // namespace tribench::loop
