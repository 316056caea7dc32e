// SPDX-License-Identifier: MIT
#include "problems/kuka/planted.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "foundation/error.hpp"
#include "foundation/glob.hpp"
#include "problems/catalogue.hpp"
#include "problems/friction/planted_effects.hpp"

namespace tribench::kuka {
namespace {

double root_mean_square(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  const auto n = static_cast<double>(a.size());
  for (std::size_t r = 0; r < a.size(); ++r) {
    sa += a[r];
    sb += b[r];
    saa += a[r] * a[r];
    sbb += b[r] * b[r];
    sab += a[r] * b[r];
  }
  return (sab - sa * sb / n) / std::sqrt((saa - sa * sa / n) * (sbb - sb * sb / n));
}

TEST(Planted, TheTargetIsBaseAndEffectsAndNoise) {
  PlantedCase planted;
  planted.effects = {{"stribeck", 1.0}, {"inertia", 0.5}};
  const PlantedData run = make_planted(planted, 3);
  ASSERT_EQ(run.data.movement_names.size(), 108U);
  ASSERT_EQ(run.data.rows(), 90U * 40 + 18 * 120);
  ASSERT_EQ(run.truth.effects.size(), 2U);
  const auto& y = run.data.at("friction_torque_Nm").values;
  const std::vector<double> free = run.truth.noise_free();
  for (std::size_t r = 0; r < y.size(); ++r) {
    EXPECT_NEAR(y[r], free[r] + run.truth.noise[r], 1e-12);
    EXPECT_NEAR(free[r],
                run.truth.base[r] + run.truth.effects[0].values[r] + run.truth.effects[1].values[r],
                1e-12);
  }
}

TEST(Planted, EveryEffectHasTheSizeAskedFor) {
  for (const PlantedShape& shape : planted_shapes()) {
    PlantedCase planted;
    planted.effects = {{std::string(shape.family), 0.5}};
    const PlantedData run = make_planted(planted, 8);
    const PlantedEffect& effect = run.truth.effects.front();
    EXPECT_NEAR(root_mean_square(effect.values), 0.5 * run.truth.noise_sd, 1e-9) << shape.family;
    EXPECT_EQ(effect.in_library(), shape.in_library);
  }
}

TEST(Planted, SignsAreDrawnAndTheRestIsTheSeeds) {
  std::set<bool> signs;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    PlantedCase planted;
    planted.effects = {{"hysteresis", 1.0}};
    signs.insert(make_planted(planted, seed).truth.effects.front().coefficient > 0);
  }
  EXPECT_EQ(signs.size(), 2U);
  // The same seed: same campaign and same noise, whatever is planted.
  PlantedCase planted;
  planted.effects = {{"lag", 2.0}};
  const PlantedData with = make_planted(planted, 5);
  const PlantedData without = make_planted({}, 5);
  EXPECT_EQ(with.truth.noise, without.truth.noise);
  EXPECT_EQ(with.data.at("position_rad").values, without.data.at("position_rad").values);
  EXPECT_NE(make_planted({}, 6).truth.noise, without.truth.noise);
}

TEST(Planted, TheNoiseIsAsSpecified) {
  double sd = 0;
  double hard_sd = 0;
  double lag_product = 0;
  double squares = 0;
  double fourth = 0;
  double count = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const PlantedData run = make_planted({}, seed);
    sd += run.truth.noise_sd / 20;
    PlantedCase hard;
    hard.noise = NoiseKind::hard;
    hard_sd += make_planted(hard, seed).truth.noise_sd / 20;
    const auto& noise = run.truth.noise;
    for (std::size_t r = 1; r < noise.size(); ++r) {
      if (run.data.movement[r] != run.data.movement[r - 1]) continue;
      lag_product += noise[r] * noise[r - 1];
      squares += noise[r] * noise[r];
      fourth += std::pow(noise[r], 4);
      count += 1;
    }
  }
  EXPECT_GT(sd, 0.15);
  EXPECT_LT(sd, 0.30);
  EXPECT_LT(hard_sd, sd);
  EXPECT_NEAR(lag_product / squares, 0.61, 0.03);                 // 0.6 and the movements' offsets
  EXPECT_GT(fourth / count / std::pow(squares / count, 2), 4.0);  // heavier than normal (3)
}

TEST(Planted, TemperatureAndTimeCanBeToldApart) {
  const PlantedData run = make_planted({}, 2);
  const auto& temperature = run.data.at("temperature_degC").values;
  for (const double value : temperature) {
    EXPECT_GE(value, 24 - 1e-9);
    EXPECT_LE(value, 40);
  }
  const double together = correlation(temperature, run.data.at("time_s").values);
  EXPECT_GT(together, 0.5);
  EXPECT_LT(together, 0.85);
}

TEST(Planted, TrajectoriesStayWithinTheJointsLimits) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const PlantedData run = make_planted({}, seed);
    std::set<int> with_other;
    for (std::size_t r = 0; r < run.data.rows(); ++r) {
      EXPECT_LE(std::abs(run.data.at("position_rad").values[r]), 2.1);
      EXPECT_LE(std::abs(run.data.at("velocity_rad_s").values[r]), 0.68 + 1e-9);
      if (run.data.at("other_velocity_rad_s").values[r] != 0) {
        with_other.insert(run.data.movement[r]);
      }
    }
    EXPECT_GE(with_other.size(), 4U);
    EXPECT_LE(with_other.size(), 17U);
  }
}

TEST(Planted, CollisionsAreBurstsInsideTheirMovements) {
  PlantedCase planted;
  planted.collisions = 5;
  planted.collision_scale = 16;
  const PlantedData run = make_planted(planted, 1);
  ASSERT_EQ(run.truth.collisions.size(), 5U);
  std::set<int> movements;
  const std::vector<double> quiet = make_planted({}, 1).truth.noise;
  for (const PlantedCollision& collision : run.truth.collisions) {
    movements.insert(collision.movement);
    for (std::size_t r = collision.first_row; r <= collision.last_row; ++r) {
      EXPECT_EQ(run.data.movement[r], collision.movement);
      EXPECT_GT(std::abs(run.truth.noise[r] - quiet[r]), 4 * run.truth.noise_sd);
    }
  }
  EXPECT_EQ(movements.size(), 5U);
}

TEST(Planted, AOnlyHasNoAccelerationAndHidesInertia) {
  PlantedCase planted;
  planted.trajectories = 0;
  planted.effects = {{"inertia", 4.0}};
  const PlantedData run = make_planted(planted, 1);
  EXPECT_EQ(run.data.movement_names.size(), 90U);
  EXPECT_EQ(run.truth.effects.front().coefficient, 0);
}

TEST(Planted, PairsAreTwoDifferentFamiliesOfTheLibrary) {
  std::set<std::string> seen;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const PlantedCase pair = draw_pair(1, seed);
    ASSERT_EQ(pair.effects.size(), 2U);
    EXPECT_NE(pair.effects[0].family, pair.effects[1].family);
    for (const Plant& effect : pair.effects) {
      EXPECT_TRUE(find_planted_shape(effect.family).in_library);
      seen.insert(effect.family);
    }
  }
  EXPECT_EQ(seen.size(), 15U);
}

TEST(Planted, AnUnknownFamilyIsAnsweredWithTheNearest) {
  try {
    find_planted_shape("stribek");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean stribeck?"), std::string::npos);
  }
}

TEST(Planted, TheCatalogueHasTheMatrixSplitByMovement) {
  const Catalogue catalogue;
  EXPECT_EQ(std::ranges::count_if(
                catalogue.entries(),
                [](const ProblemEntry& entry) { return glob_matches("undeclared/*", entry.name); }),
            19 * 5 + 3 + 3 + 2);
  const Problem problem = catalogue.find("undeclared/load_coulomb/0.5").make(4);
  const Table& train = problem.stages.front().train;
  const std::set<int> trained(train.movement.begin(), train.movement.end());
  const std::set<int> tested(problem.test.movement.begin(), problem.test.movement.end());
  EXPECT_EQ(trained.size() + tested.size(), 108U);
  EXPECT_EQ(tested.size(), 22U);
  for (const int movement : tested) EXPECT_EQ(trained.count(movement), 0U);
  EXPECT_EQ(train.truth.size(), train.rows());
  EXPECT_EQ(problem.inputs.size(), 10U);
}

}  // namespace
}  // namespace tribench::kuka
