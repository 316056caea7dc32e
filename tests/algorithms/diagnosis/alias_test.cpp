// SPDX-License-Identifier: MIT
//
// Which families are told to be another name of an effect.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace tribench::loop
