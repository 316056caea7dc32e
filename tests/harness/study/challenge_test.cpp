// SPDX-License-Identifier: MIT
#include "harness/study/challenge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace tribench {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

ChallengeResult result_of(const std::string& script) {
  return run_challenge_world({"bash", "-c", script}, {}, 20).value();
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

TEST(ChallengeWorld, TheLastLineNeedsNoEnd) {
  const ChallengeResult result = result_of("read hello; printf '{\"verdict\": null}'");
  EXPECT_EQ(result.verdict, "abstained") << result.reason;
}

}  // namespace
}  // namespace tribench
