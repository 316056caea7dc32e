// SPDX-License-Identifier: MIT
#include "problems/joint_simulation/world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "foundation/error.hpp"

namespace tribench::simulation {
namespace {

PlannedMovement across(const MotionLimits& limits, double part) {
  return constant_movement(part * limits.speed_rad_s, limits.lowest_rad, limits.highest_rad, 1);
}

const std::vector<double>& friction(const Dataset& data) {
  return data.find(Role::friction_torque)->values;
}

TEST(World, GivesTheSameRowsForTheSameMovements) {
  World first({.seed = 5});
  World second({.seed = 5});
  World other({.seed = 6});
  for (const double part : {0.5, -0.8}) {
    const PlannedMovement movement = across(first.limits(), part);
    const Dataset rows = first.execute(movement, "a");
    EXPECT_EQ(friction(rows), friction(second.execute(movement, "a")));
    EXPECT_NE(friction(rows).size() + 0.5,
              friction(other.execute(across(other.limits(), part), "a"))[0]);
  }
  EXPECT_EQ(first.seconds_used(), second.seconds_used());
}

TEST(World, RecordsAtItsRateWithinTheMovement) {
  World world({.seed = 3});
  const PlannedMovement movement = across(world.limits(), 0.5);
  const Dataset rows = world.execute(movement, "a");
  const double seconds = seconds_of(movement, movement.from, world.limits());
  EXPECT_NEAR(static_cast<double>(rows.rows()), seconds * world.limits().rate_hz, 2);
  for (const double q : rows.find(Role::position)->values) {
    EXPECT_GE(q, world.limits().lowest_rad - 1e-9);
    EXPECT_LE(q, world.limits().highest_rad + 1e-9);
  }
  EXPECT_NEAR(world.seconds_used(), seconds_of(movement, 0, world.limits()), 1e-12);
}

TEST(World, RefusesWhatBreaksALimitAndIsAsBefore) {
  World world({.seed = 4});
  World untouched({.seed = 4});
  const MotionLimits& limits = world.limits();
  PlannedMovement fast = across(limits, 1.2);
  PlannedMovement far = across(limits, 0.5);
  far.to = limits.highest_rad + 0.1;
  PlannedMovement heavy = across(limits, 0.5);
  heavy.load_factor = 3;
  PlannedMovement long_one = two_tone_movement(0.5 * limits.speed_rad_s, -1, 1, 1);
  long_one.duration = limits.seconds + 1;
  for (const PlannedMovement& wrong : {fast, far, heavy, long_one}) {
    try {
      world.execute(wrong, "file, movement 2");
      ADD_FAILURE() << "was not refused";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
      EXPECT_EQ(error.place(), "file, movement 2");
      EXPECT_FALSE(error.mend().empty());
    }
  }
  EXPECT_EQ(world.seconds_used(), 0);
  const PlannedMovement right = across(limits, 0.5);
  EXPECT_EQ(friction(world.execute(right, "a")), friction(untouched.execute(right, "a")));
}

TEST(World, GetsHotAndCoolsAtRest) {
  // Some world is hot before its seconds are spent; a rest lets it go on.
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    World world({.seed = seed});
    PlannedMovement back_and_forth = two_tone_movement(
        world.limits().speed_rad_s, world.limits().lowest_rad, world.limits().highest_rad, 0.5);
    try {
      while (true) world.execute(back_and_forth, "a");
    } catch (const Error& error) {
      if (std::string(error.what()).find("housing") == std::string::npos) continue;
      back_and_forth.rest = world.limits().longest_rest_s;
      EXPECT_NO_THROW(world.execute(back_and_forth, "a"));
      return;
    }
  }
  ADD_FAILURE() << "no world gets hot";
}

TEST(World, HidesWhatItsKindSays) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    for (const WorldKind kind : kWorldKinds) {
      const World world({seed, WorldLevel::medium, kind});
      const std::vector<PlantedEffect>& effects = world.truth().effects;
      const std::size_t count = kind == WorldKind::none ? 0 : kind == WorldKind::pair ? 2 : 1;
      ASSERT_EQ(effects.size(), count);
      for (const PlantedEffect& effect : effects) {
        EXPECT_EQ(effect.in_library(), kind != WorldKind::unknown);
        EXPECT_GE(effect.scale, world.smallest_effect());
        EXPECT_LE(effect.scale, 2 * world.smallest_effect());
        EXPECT_GT(std::abs(effect.coefficient), 0);
      }
    }
  }
}

TEST(MovementsFile, IsReadBackAsItWasWritten) {
  PlannedMovement rested = constant_movement(-0.1 / 3, -1, 0.5, 1.5);
  rested.rest = 12.25;
  rested.other_velocity = 0.3;
  const std::vector<PlannedMovement> all = {constant_movement(0.3, -1, 1, 1),
                                            two_tone_movement(0.4, -0.7, 0.9, 0.5), rested};
  const std::vector<PlannedMovement> back =
      read_movements(movements_text(all, "rad", "rad/s"), "m.csv");
  ASSERT_EQ(back.size(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(back[i].kind, all[i].kind);
    EXPECT_EQ(back[i].velocity, all[i].velocity);
    EXPECT_EQ(back[i].from, all[i].from);
    EXPECT_EQ(back[i].to, all[i].to);
    EXPECT_EQ(back[i].load_factor, all[i].load_factor);
    EXPECT_EQ(back[i].rest, all[i].rest);
    EXPECT_EQ(back[i].other_velocity, all[i].other_velocity);
    EXPECT_EQ(back[i].tones[1].frequency, all[i].tones[1].frequency);
  }
}

TEST(MovementsFile, NamesLineAndMend) {
  const auto error_of = [](const char* text) {
    try {
      read_movements(text, "m.csv");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string head = "kind,velocity_rad_s,from_rad,to_rad\n";
  using ::testing::HasSubstr;
  EXPECT_THAT(error_of((head + "constnat,0.1,0,1\n").c_str()), HasSubstr("constant"));
  EXPECT_THAT(error_of((head + "constant,0.1,0,1\nconstant,x,0,1\n").c_str()),
              HasSubstr("m.csv:3"));
  EXPECT_THAT(error_of((head + "constant,0.1,1,0\n").c_str()), HasSubstr("the sign of to - from"));
  EXPECT_THAT(error_of("kind,velocity_deg_s,from_rad,to_rad\nconstant,1,0,1\n"),
              HasSubstr("rad/s"));
  EXPECT_THAT(error_of("kind,velocity_rad_s,from_rad\nconstant,1,0\n"), HasSubstr("to_rad"));
}

}  // namespace
}  // namespace tribench::simulation
