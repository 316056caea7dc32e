// SPDX-License-Identifier: MIT
#include "algorithms/exploration/second_opinion.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "foundation/random.hpp"
#include "problems/dataset.hpp"
#include "problems/preparation/observations.hpp"

namespace tribench::loop {
namespace {

// What they live in.
std::vector<ExplainingFamily> families() {
  const auto family = [](const char* name, Role role) {
    ExplainingFamily out;
    out.name = name;
    out.characteristic = {std::string(role_name(role))};
    return out;
  };
  return {family("stribeck", Role::velocity),      family("nonlinear_viscous", Role::velocity),
          family("lag", Role::acceleration),       family("hysteresis", Role::acceleration),
          family("inertia", Role::acceleration),   family("drift", Role::time),
          family("temperature", Role::temperature)};
}

bool agree(const std::vector<std::string>& diagnosed, const std::vector<std::string>& said) {
  return bears_out({diagnosed, false}, {said, false}, families());
}

TEST(SecondOpinion, NamesAsManyFamiliesByNamesThatTheyMayHave) {
  EXPECT_TRUE(agree({}, {}));
  EXPECT_TRUE(agree({"stribeck", "lag"}, {"lag", "stribeck"}));
  EXPECT_TRUE(agree({"lag"}, {"inertia"}));
  EXPECT_TRUE(agree({"inertia"}, {"lag"}));
  // One that names presliding alone does not bear out a lag beside it, nor the other way round.
  EXPECT_FALSE(agree({"hysteresis"}, {"hysteresis", "lag"}));
  EXPECT_FALSE(agree({"hysteresis", "lag"}, {"hysteresis"}));
  EXPECT_FALSE(agree({"stribeck"}, {"lag"}));
  EXPECT_FALSE(agree({"stribeck"}, {"nonlinear_viscous"}));
  EXPECT_FALSE(agree({}, {"stribeck"}));
}

TEST(SecondOpinion, FindsSomethingElseWhereTheOtherDoes) {
  EXPECT_TRUE(bears_out({{"lag"}, true}, {{"lag"}, true}, families()));
  EXPECT_FALSE(bears_out({{"lag"}, true}, {{"lag"}, false}, families()));
  EXPECT_FALSE(bears_out({{"lag"}, false}, {{"lag"}, true}, families()));
}

// A sensor whose zero jumps from movement to movement: no friction, but not nothing.
TEST(SecondOpinion, MovementsThatDifferBeyondTheirNoiseHoldSomethingElse) {
  const auto diagnosed = [](double jump) {
    RandomStream random(5);
    Dataset data;
    data.channels = {{"time", "s", Role::time, {}},
                     {"v", "rad/s", Role::velocity, {}},
                     {"tau_f", "N m", Role::friction_torque, {}}};
    for (int m = 0; m < 16; ++m) {
      data.movement_names.push_back(std::to_string(m));
      const double way = m % 2 == 0 ? 1 : -1;
      const double zero = jump * random.normal();
      for (int i = 0; i < 300; ++i) {
        const double v = way * (0.1 + 0.7 * (i % 150) / 150.0);
        data.movement.push_back(m);
        data.channels[0].values.push_back(10 * m + 0.01 * i);
        data.channels[1].values.push_back(v);
        data.channels[2].values.push_back(3 * way + 4 * v + zero + 0.15 * random.normal());
      }
    }
    return diagnosed_families(observe(data), {});
  };
  for (const double jump : {0.0, 0.5}) {
    EXPECT_TRUE(diagnosed(jump).names.empty()) << jump;
    EXPECT_EQ(diagnosed(jump).unknown, jump > 0) << jump;
  }
}

TEST(SecondOpinion, MayTellWhatALateSensorLeavesAsADrift) {
  EXPECT_TRUE(agree({"temperature", "drift"}, {"temperature"}));
  EXPECT_TRUE(agree({"temperature", "drift"}, {"drift", "temperature"}));
  EXPECT_FALSE(agree({"drift"}, {"temperature"}));
  EXPECT_FALSE(agree({"temperature"}, {"drift", "temperature"}));
  EXPECT_FALSE(agree({"stribeck", "drift"}, {"stribeck"}));
}

}  // namespace
}  // namespace tribench::loop
