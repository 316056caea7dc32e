// SPDX-License-Identifier: MIT
#include "algorithms/external/external_method.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "algorithms/budget.hpp"
#include "foundation/error.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;

// What ends a program of this shell line where nobody else watches it.
std::string ended_by(const std::string& line, ProgramLimits limits) {
  const std::vector<Input> inputs{{.name = "x", .low = 0, .high = 1}};
  const std::vector<double> x{0, 1};
  const std::vector<const double*> columns{x.data()};
  const std::vector<int> movement{0, 1};
  const TrainingData data{inputs, columns, x, movement};
  Budget budget({});
  FitContext context{data, find_operator_set("full"), budget, RandomStream(1)};
  try {
    make_external_method({"bash", "-c", line}, {}, limits)->fit(context);
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

}  // namespace
}  // namespace tribench
