// SPDX-License-Identifier: MIT
#include "foundation/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace tribench {
namespace {

// Known answers of Random123's kat_vectors for philox4x32-10.
TEST(Philox, GivesThePublishedAnswers) {
  EXPECT_EQ(philox_block({0, 0, 0, 0}, {0, 0}),
            (std::array<std::uint32_t, 4>{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(
      philox_block({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
      (std::array<std::uint32_t, 4>{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(
      philox_block({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
      (std::array<std::uint32_t, 4>{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(RandomStream, ASplitDoesNotDependOnHowFarTheParentHasAdvanced) {
  RandomStream fresh(7);
  RandomStream used(7);
  for (int i = 0; i < 11; ++i) used.next();
  EXPECT_EQ(fresh.split(3).next(), used.split(3).next());
  EXPECT_NE(fresh.split(3).next(), fresh.split(4).next());
  EXPECT_NE(fresh.split("island").next(), fresh.split("islanc").next());
}

TEST(RandomStream, HasTheMomentsOfItsDistributions) {
  RandomStream random(1);
  constexpr int kDraws = 200000;
  double uniform = 0;
  double normal = 0;
  double square = 0;
  double poisson = 0;
  std::vector<int> counts(7);
  for (int i = 0; i < kDraws; ++i) {
    uniform += random.uniform();
    const double x = random.normal();
    normal += x;
    square += x * x;
    poisson += static_cast<double>(random.poisson(1.66));
    ++counts[random.below(7)];
  }
  // Five standard errors.
  EXPECT_NEAR(uniform / kDraws, 0.5, 5 * std::sqrt(1.0 / 12 / kDraws));
  EXPECT_NEAR(normal / kDraws, 0, 5 / std::sqrt(kDraws));
  EXPECT_NEAR(square / kDraws, 1, 5 * std::sqrt(2.0 / kDraws));
  EXPECT_NEAR(poisson / kDraws, 1.66, 5 * std::sqrt(1.66 / kDraws));
  for (const int count : counts) EXPECT_NEAR(count, kDraws / 7.0, 5 * std::sqrt(kDraws / 7.0));
}

}  // namespace
}  // namespace tribench
