// SPDX-License-Identifier: MIT
#include "algorithms/external/external_method.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <string>
#include <vector>

#include "algorithms/budget.hpp"
#include "foundation/error.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;

// What a program of this shell line answers where nobody else watches it.
FitResult answer_of(const std::string& line, ProgramLimits limits,
                    const std::atomic<bool>* stop = nullptr) {
  const std::vector<Input> inputs{{.name = "x", .low = 0, .high = 1}};
  const std::vector<double> x{0, 1};
  const std::vector<const double*> columns{x.data()};
  const std::vector<int> movement{0, 1};
  const TrainingData data{inputs, columns, x, movement};
  Budget budget({.stop = stop});
  FitContext context{data, find_operator_set("full"), budget, RandomStream(1)};
  return make_external_method({"bash", "-c", line}, {}, limits)->fit(context);
}

// What ends it.
std::string ended_by(const std::string& line, ProgramLimits limits) {
  try {
    answer_of(line, limits);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::failed);
    return error.what();
  }
  return "itself";
}

TEST(ExternalMethod, EndsAProgramBeyondItsLimits) {
  EXPECT_THAT(ended_by("sleep 900", {.wall_s = 0.3}), HasSubstr("more than 0.3 s of wall time"));
  EXPECT_THAT(ended_by("kill -STOP $$", {.wall_s = 0.3}), HasSubstr("wall time"));
  EXPECT_THAT(ended_by("exec >&- 2>&-; sleep 900", {.wall_s = 0.3}), HasSubstr("wall time"));
  EXPECT_THAT(ended_by("while :; do :; done", {.cpu_s = 0.3}),
              HasSubstr("more than 0.3 s of CPU time"));
  EXPECT_EQ(ended_by("echo '{\"front\": [\"x\"]}'", {.cpu_s = 60, .wall_s = 60}), "itself");
}

TEST(ExternalMethod, IsAskedToEndWhenTheUserStopsAndWhatItHasAnsweredCounts) {
  const std::atomic<bool> stop = true;
  const auto start = std::chrono::steady_clock::now();
  const FitResult answered = answer_of("echo '{\"front\": [\"x\"]}'; sleep 900", {}, &stop);
  EXPECT_EQ(answered.front.size(), 1U);
  EXPECT_THROW(answer_of("trap '' TERM; sleep 900", {}, &stop), Error);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

// A note is shown on a terminal, which obeys control characters.
TEST(ExternalMethod, ItsWordsAreOneLineWithoutControlCharacters) {
  EXPECT_EQ(answer_of(R"(echo '{"front": ["x"], "note": "red \u001b[31m\nand on"}')", {}).note,
            "red ?[31m and on");
  EXPECT_EQ(answer_of(R"(echo '{"unsupported": "no\u0007 data"}')", {}).note, "no? data");
}

// Which of two values was meant nobody knows; a log's line that is no JSON stays chatter.
TEST(ExternalMethod, AnAnswerThatCannotBeReadIsRefusedWithTheReason) {
  EXPECT_THAT(ended_by(R"(echo '{"front": ["x"]}'; echo '{"front": ["1"], "front": ["2"]}')", {}),
              HasSubstr("the key \"front\" stands twice"));
  EXPECT_THAT(ended_by(R"(echo '{"front": ["x"], "chosen": NaN}')", {}), HasSubstr("(NaN)"));
  EXPECT_EQ(ended_by(R"(echo '{"a": 1, "a": 2}'; echo '{"front": ["x"]}')", {}), "itself");
}

}  // namespace
}  // namespace tribench
