// SPDX-License-Identifier: MIT
#include "foundation/suggestion.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tribench {
namespace {

TEST(NearestName, FindsATypoAndNothingWhenNothingIsNear) {
  const std::vector<std::string> names = {"symmetric", "asymmetric", "pysr"};
  EXPECT_EQ(nearest_name("symetric", names), "symmetric");
  EXPECT_EQ(nearest_name("pyrs", names), "pysr");
  EXPECT_EQ(nearest_name("zzzzzzzz", names), "");
}

TEST(NearestName, OfANameInPartsTheLastIsEnough) {
  const std::vector<std::string> names = {"A/j2/load", "peer/friction1d", "peer/friction2d"};
  EXPECT_EQ(nearest_name("friction2d", names), "peer/friction2d");
  EXPECT_EQ(nearest_name("riction2dx", names), "");
  EXPECT_EQ(nearest_name("", names), "");
}

// Two letters away is any other name of two letters.
TEST(NearestName, OfAShortNameSomethingStays) {
  EXPECT_EQ(nearest_name("y", {"q", "qd", "tau"}), "");
  EXPECT_EQ(nearest_name("dq", {"t", "i"}), "");
  EXPECT_EQ(nearest_name("qdd", {"qd", "tau"}), "qd");
  EXPECT_EQ(nearest_name("Y", {"x", "y"}), "y");
}

TEST(NearestName, ABeginningIsEnough) {
  const std::vector<std::string> names = {"--help", "--version"};
  EXPECT_EQ(nearest_name("--vers", names), "--version");
  EXPECT_EQ(nearest_name("--", names), "");
}

TEST(Suggestion, OffersANearNameElseWhatIsKnown) {
  EXPECT_EQ(did_you_mean("velocty", {"position", "velocity"}), "did you mean velocity?");
  EXPECT_EQ(did_you_mean("x", {"position", "velocity"}), "known: position, velocity");
  EXPECT_EQ(did_you_mean("x", {"position"}, "see the list"), "see the list");
  EXPECT_EQ(did_you_mean("x", {}), "");
}

TEST(Suggestion, ALongListIsCutAndSaysSo) {
  const std::string text = did_you_mean("x", std::vector<std::string>(1000, "abcdefgh"));
  EXPECT_LT(text.size(), 400U);
  EXPECT_THAT(text, testing::HasSubstr("and 970 more"));
}

}  // namespace
}  // namespace tribench
