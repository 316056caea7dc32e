// SPDX-License-Identifier: MIT
#include "harness/study/log_study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <string>

namespace tribench {
namespace {

// Whatever unit, layout and sensor a log is told in, it is read as what it is.
TEST(LogStudy, NoTellingIsMisread) {
  for (std::uint64_t seed = 301; seed < 307; ++seed) {
    const LogCase one = make_log_case(seed, 2, 20);
    const simulation::ControlledRun run = simulation::run_under_control(one.plan, one.seed);
    for (const LogKnowledge knowledge : {LogKnowledge::told, LogKnowledge::bare}) {
      const ToldLog log = tell_log(run, knowledge, RandomStream(seed));
      EXPECT_EQ(misread_channel(run, log), "") << one.name << ": " << log.summary;
    }
  }
}

// The check itself sees a wrong unit.
TEST(LogStudy, AWrongUnitIsSeen) {
  const LogCase one = make_log_case(1, 2, 20);
  const simulation::ControlledRun run = simulation::run_under_control(one.plan, one.seed);
  ToldLog log = tell_log(run, LogKnowledge::told, RandomStream(1));
  log.torque_scale *= 1000;
  EXPECT_THAT(misread_channel(run, log), ::testing::HasSubstr("motor_torque is read"));
}

TEST(LogStudy, EverySeedHasItsRun) {
  EXPECT_EQ(make_log_case(10, 2, 20).name, "none/10");
  EXPECT_EQ(make_log_case(9, 2, 20).name, "linear_stribeck_exponential/9");
  EXPECT_TRUE(make_log_case(3, 2, 20).plan.gravity);  // no load friction without a load
}

// After Ctrl-C nothing more is asked, and what is left out is counted.
TEST(LogStudy, IsStoppedInGoodOrder) {
  const std::atomic<bool> stop = true;
  LogStudyOptions options;
  options.logs = 3;
  options.stop = &stop;
  const LogStudy study = run_log_study("/bin/false", options);
  EXPECT_EQ(study.left_out, 3U);
  EXPECT_TRUE(study.outcomes.empty());
}

}  // namespace
}  // namespace tribench
