// SPDX-License-Identifier: MIT
#include "harness/study/challenge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>

namespace tribench {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

ChallengeResult result_of(const std::string& script, double wall_s = 20) {
  return run_challenge_world({"bash", "-c", script}, {}, wall_s).value();
}

TEST(ChallengeWorld, AProgramWithoutAVerdictIsTold) {
  EXPECT_THAT(result_of("read hello; exit 3").reason,
              AllOf(HasSubstr("printed no line"), HasSubstr("ended with status 3"),
                    HasSubstr("nothing on its standard error"), HasSubstr("{\"verdict\"")));
  EXPECT_THAT(result_of("read hello; echo thinking; echo; echo lost >&2; kill -9 $$").reason,
              AllOf(HasSubstr("'thinking'"), HasSubstr("SIGKILL: lost")));
  EXPECT_THAT(result_of("read hello; exec >&- 2>&-; sleep 987").reason, HasSubstr("still runs"));
}

TEST(ChallengeWorld, AProgramThatEndsBeforeItIsSpokenToIsTold) {
  EXPECT_THAT(result_of("exec 0<&-; echo lost >&2; exit 4").reason, HasSubstr("status 4: lost"));
}

// Of what it asks for more than a pipe holds is never read.
TEST(ChallengeWorld, AProgramThatDoesNotReadHasNoMoreTimeThanAnyOther) {
  const std::string asks =
      R"(echo '{"movement": {"kind": "constant", "velocity_rad_s": 0.1, "from_rad": -0.5, )"
      R"("to_rad": 0.5, "rest_s": 0}}')";
  const auto begin = std::chrono::steady_clock::now();
  const ChallengeResult result =
      result_of("read hello; for i in $(seq 40); do " + asks + "; done; sleep 30", 1);
  EXPECT_THAT(result.reason, HasSubstr("took too long"));
  EXPECT_GT(result.movements, 1U);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(15));
}

TEST(ChallengeWorld, TheLastLineNeedsNoEnd) {
  const ChallengeResult result = result_of("read hello; printf '{\"verdict\": null}'");
  EXPECT_EQ(result.verdict, "abstained") << result.reason;
}

// A value that is no cell would be taken for several, and the message be about lines of a file.
TEST(ChallengeWorld, AMovementThatIsNoneIsRefusedInItsOwnWords) {
  const auto refusal = [](const std::string& movement) {
    return result_of("read hello; echo '{\"movement\": " + movement +
                     "}'; read answer; echo \"$answer\" >&2; exit 3")
        .reason;
  };
  EXPECT_THAT(refusal("5"), HasSubstr("movement: 5 is no movement; write {"));
  EXPECT_THAT(refusal("[1, 2]"), HasSubstr("[1,2] is no movement"));
  EXPECT_THAT(refusal("{}"), HasSubstr("{} is no movement"));
  EXPECT_THAT(refusal(R"({"kind": "constant", "velocity_rad_s": [0.1, 2]})"),
              HasSubstr("'velocity_rad_s' is [0.1,2], which is no number and no word"));
  EXPECT_THAT(refusal(R"({"kind": "constant", "velocity_rad_s": null})"),
              HasSubstr("'velocity_rad_s' is null"));
  EXPECT_THAT(refusal(R"({"kind": "con,stant", "velocity_rad_s": 1, "from_rad": 0, "to_rad": 1})"),
              HasSubstr("\"movement: there is no kind 'con,stant'"));
  const std::string digits(300, '7');
  const std::string shown = std::string(60, '7') + "...'";
  EXPECT_THAT(refusal(R"({"kind": "constant", "from_rad": 0, "to_rad": 1, "velocity_rad_s": ")" +
                      digits + "\"}"),
              HasSubstr("'" + shown + " is no velocity_rad_s"));
  EXPECT_THAT(refusal("{\"" + digits + "\": 1}"), HasSubstr("there is no column '" + shown));
  EXPECT_THAT(refusal(digits + digits), AllOf(HasSubstr("a number out of range in JSON"),
                                              HasSubstr("777...'"), Not(HasSubstr(digits))));
}

TEST(ChallengeWorld, AMisspeltVerdictIsNoVerdict) {
  const auto reason = [](const char* verdict) {
    return result_of("read hello; echo '" + std::string(verdict) + "'").reason;
  };
  EXPECT_THAT(reason(R"({"verdict": {"familes": ["stribeck"]}})"),
              HasSubstr("a verdict has no 'familes'"));
  EXPECT_THAT(reason(R"({"verdict": {}})"), HasSubstr("lists its families"));
  EXPECT_THAT(reason(R"({"verdict": {"families": "stribeck"}})"), HasSubstr("lists its families"));
  EXPECT_THAT(reason(R"({"verdict": {"families": [3]}})"), HasSubstr("lists its families"));
  EXPECT_THAT(reason(R"({"verdict": {"families": [], "unknown": "no"}})"),
              HasSubstr("'unknown' is true or false"));
  EXPECT_THAT(reason(R"({"verdict": "NONE"})"), HasSubstr("it is no object"));
  EXPECT_THAT(reason(R"({"verdct": {"families": []}})"), HasSubstr("'movement' or a 'verdict'"));
  EXPECT_EQ(reason(R"({"verdict": {"families": []}})"), "");
}

}  // namespace
}  // namespace tribench
