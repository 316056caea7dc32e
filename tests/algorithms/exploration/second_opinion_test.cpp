// SPDX-License-Identifier: MIT
#include "algorithms/exploration/second_opinion.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "problems/dataset.hpp"
#include "problems/preparation/observations.hpp"
#include "tests/support/movements_with_offsets.hpp"

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

// No friction, but not nothing.
TEST(SecondOpinion, MovementsThatDifferBeyondTheirNoiseHoldSomethingElse) {
  for (const double offset : {0.0, 0.7}) {
    const NamedFamilies found =
        diagnosed_families(observe(testing::movements_with_offsets(16, offset, 5)), {});
    EXPECT_TRUE(found.names.empty()) << offset;
    EXPECT_EQ(found.unknown, offset > 0) << offset;
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
