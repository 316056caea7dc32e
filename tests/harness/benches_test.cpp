// SPDX-License-Identifier: MIT
//
// Counts of the same program again and again, and of one with one per cent more work.
#include "harness/benches.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "reports/bench_comparison.hpp"
#include "tests/support/run_program.hpp"

namespace tribench {
namespace {

class BenchesTest : public ::testing::Test {
 protected:
  void SetUp() override {
#ifdef TRIBENCH_SANITIZED
    GTEST_SKIP() << "valgrind runs no program of a sanitizer";
#endif
    if (!std::filesystem::exists(TRIBENCH_PLANTED_BENCHES "/planted_bench_as_it_was")) {
      GTEST_SKIP() << "built without Google Benchmark";
    }
    if (testing::run_to_end({"sh", "-c", "command -v valgrind"}).status != 0) {
      GTEST_SKIP() << "no valgrind";
    }
  }
  // The program under a name of its own, so that both have the same.
  Night counted(const char* program, const char* place = "benches") const {
    const std::filesystem::path folder = folder_ / place;
    std::filesystem::create_directories(folder);
    std::filesystem::copy_file(std::filesystem::path(TRIBENCH_PLANTED_BENCHES) / program,
                               folder / "loop_bench",
                               std::filesystem::copy_options::overwrite_existing);
    const std::atomic<bool> stop = false;
    const BenchRun run = run_benches({.folder = folder, .repetitions = 3}, stop);
    EXPECT_THAT(run.complaints, ::testing::IsEmpty());
    Night night;
    night.benches = run.benches;
    night.bench_conditions = run.conditions;
    return night;
  }
  testing::TemporaryFolder folder_;
};

TEST_F(BenchesTest, TwentyOneRunsCountAlikeAndOnePerCentMoreWorkIsAlwaysFound) {
  std::vector<Night> runs;
  for (int k = 0; k < 21; ++k) runs.push_back(counted("planted_bench_as_it_was"));
  std::vector<double> counts;
  std::vector<double> times;
  for (const Night& run : runs) {
    ASSERT_EQ(run.benches.size(), 1U);
    counts.push_back(run.benches.front().instructions);
    times.push_back(run.benches.front().time);
  }
  const auto [least, most] = std::ranges::minmax(counts);
  const auto [soonest, latest] = std::ranges::minmax(times);
  std::printf("instructions %.0f .. %.0f, paired times within %.1f %%\n", least, most,
              100 * (latest / soonest - 1));
  EXPECT_LE(most / least, 1.001);
  EXPECT_GT(least, 3e5);  // the loop's, and no more than the loop's
  EXPECT_LT(most, 2e6);
  int pairs = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const BenchComparison same = compare_benches(runs[j], runs[i]);
      EXPECT_THAT(same.worse, ::testing::IsEmpty());
      ++pairs;
    }
  }
  EXPECT_EQ(pairs, 210);
  const Night slower = counted("planted_bench_one_per_cent_slower");
  for (const Night& run : runs) {
    const BenchComparison found = compare_benches(run, slower);
    ASSERT_EQ(found.worse.size(), 1U);
    EXPECT_NEAR(found.worse.front().ratio, 1.01, 1e-3);
  }
}

// What Google Benchmark reads of a machine before the first loop leaves pieces on the heap, and
// which ones differs from machine to machine, as does where the benches lie.
TEST_F(BenchesTest, CountTheSameWhateverUsedTheHeapBeforeAndWhereverTheProgramLies) {
  const Night fresh = counted("heap_bench_0");
  const Night used = counted("heap_bench_1000", "a/place/with a space/and another name");
  ASSERT_EQ(fresh.benches.size(), 2U);
  ASSERT_EQ(used.benches.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    const NightBench& a = fresh.benches[k];
    const NightBench& b = used.benches[k];
    EXPECT_GT(a.instructions, 1e5);
    EXPECT_EQ(a.instructions, b.instructions) << a.name;
    EXPECT_EQ(a.first_level_misses, b.first_level_misses) << a.name;
    EXPECT_EQ(a.last_level_misses, b.last_level_misses) << a.name;
  }
}

// A night counts one turn of each case: a program whose checks want more is never counted. What of
// it has been built is asked.
TEST_F(BenchesTest, EveryProgramEndsWellAfterOneTurnOfEachCase) {
  int programs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(TRIBENCH_BENCHES)) {
    if (!entry.is_regular_file() || ::access(entry.path().c_str(), X_OK) != 0) continue;
    const testing::ProgramRun run = testing::run_to_end(
        {"env", "TRIBENCH_NIGHT=1", entry.path().string(), "--benchmark_min_time=0"});
    EXPECT_EQ(run.status, 0) << entry.path() << run.errors;
    ++programs;
  }
  if (programs == 0) GTEST_SKIP() << "no bench is built";
}

}  // namespace
}  // namespace tribench
