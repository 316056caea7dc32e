// SPDX-License-Identifier: MIT
#include "harness/study/night_study.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "foundation/error.hpp"
#include "foundation/random.hpp"

namespace tribench {
namespace {

// Two methods on two problems, 20 seeds, 10 streams; "quiet" draws nothing by chance.
RunFolder made_streams() {
  RunFolder run;
  for (const std::string problem : {"p1", "p2"}) {
    for (const std::string method : {"noisy", "quiet"}) {
      for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        RandomStream own(key_of(fmt::format("{}|{}|{}", problem, method, seed)));
        const double level = own.normal();
        for (int stream = 1; stream <= 10; ++stream) {
          Record record;
          record.problem = problem;
          record.method = fmt::format("{}.{}", method, stream);
          record.operators = "paper";
          record.seed = seed;
          record.cell = fmt::format("{}|{}|paper|{}", problem, record.method, seed);
          record.status = CellStatus::ok;
          record.mae_test = std::exp(0.3 * level + (method == "noisy" ? 0.02 * own.normal() : 0.0));
          run.records.push_back(record);
        }
      }
    }
  }
  return run;
}

NightStudyOptions small_night_study() {
  NightStudyOptions options;
  options.pairs = 40;
  options.sequences = 2;
  options.nights = 10;
  options.trials = 5;
  options.before = 8;
  options.threads = 1;
  options.quiet = true;
  return options;
}

TEST(NightStudy, FindsMoreTheLargerTheLossAndHoldsItsRate) {
  const NightStudy study = run_night_study(made_streams(), small_night_study());
  ASSERT_EQ(study.series.size(), 4U);
  EXPECT_EQ(study.pairs.asked, 40U);
  EXPECT_LE(study.pairs.by_comparison + study.pairs.by_nights, 2U);
  EXPECT_LE(study.sequences.by_nights, 1U);
  int quiet = 0;
  int creeps = 0;
  for (const Detection& each : study.detections) {
    EXPECT_LE(each.found[0], each.found[1]);
    EXPECT_LE(each.found[1], each.found[2]);
    if (each.method == "quiet") {
      ++quiet;
      EXPECT_EQ(each.found[0], each.trials) << each.loss;  // every seed is worse
    }
    if (each.method == "noisy" && each.loss == 0.10) EXPECT_EQ(each.found[0], each.trials);
    if (each.method == "noisy" && each.creep) {
      ++creeps;
      EXPECT_GE(each.found[1] + 1, each.trials);
    }
  }
  EXPECT_EQ(quiet, 10);
  EXPECT_EQ(creeps, 2);
}

TEST(NightStudy, IsTheSameWithAnyNumberOfThreads) {
  NightStudyOptions options = small_night_study();
  options.pairs = 10;
  options.sequences = 1;
  options.trials = 2;
  const NightStudy one = run_night_study(made_streams(), options);
  options.threads = 3;
  const NightStudy three = run_night_study(made_streams(), options);
  EXPECT_EQ(one.pairs.undecided, three.pairs.undecided);
  ASSERT_EQ(one.detections.size(), three.detections.size());
  for (std::size_t k = 0; k < one.detections.size(); ++k) {
    EXPECT_EQ(one.detections[k].found[1], three.detections[k].found[1]) << k;
  }
}

TEST(NightStudy, RefusesARunWithoutStreams) {
  RunFolder run;
  run.path = "somewhere";
  run.records.resize(1);
  run.records.front().method = "pysr";
  try {
    streams_of(run);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("somewhere"));
  }
}

TEST(NightStudy, RunsEveryMethodUnderAsManyNamesAsThereAreStreams) {
  Grid grid;
  grid.methods.resize(2);
  grid.methods[0].name = "pysr";
  grid.methods[1].name = "parfam";
  const Grid streams = grid_of_streams(grid, 3);
  ASSERT_EQ(streams.methods.size(), 6U);
  EXPECT_EQ(streams.methods[2].name, "pysr.3");
  EXPECT_EQ(streams.methods[3].name, "parfam.1");
}

}  // namespace
}  // namespace tribench
