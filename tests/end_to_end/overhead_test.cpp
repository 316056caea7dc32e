// SPDX-License-Identifier: MIT
//
// What the harness itself costs: processes, messages, judging, the journal. Counted in CPU time of
// the program and its workers, which a loaded machine does not disturb much.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <iostream>

#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/sanitized.hpp"

namespace tribench::testing {
namespace {

double children_cpu_s() {
  rusage use{};
  getrusage(RUSAGE_CHILDREN, &use);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(use.ru_utime) + seconds(use.ru_stime);
}

TEST(Overhead, IsBelowEightMillisecondsOfCpuACell) {
  if (kIsSanitized) GTEST_SKIP() << kNothingToMeasure;
  const TemporaryFolder folder;
  // Fits of microseconds on one problem, made once: all that is left is the harness.
  constexpr int kCells = 400;
  std::string grid = "[grid]\nproblems = [\"A/j2/no_load\"]\nmethods = [\"mean_*\"]\n";
  for (int i = 0; i < kCells; ++i) {
    grid += "[[method]]\nname = \"mean_" + std::to_string(i) + "\"\nalgorithm = \"test_mean\"\n";
  }
  write_text(folder / "grid.toml", grid);
  const auto run = [&](const std::string& out) {
    const double before = children_cpu_s();
    EXPECT_EQ(run_to_end({test_program().string(), "run", (folder / "grid.toml").string(), "--out",
                          (folder / out).string(), "--jobs", "1", "--quiet"})
                  .status,
              0);
    return children_cpu_s() - before;
  };
  const double ms_a_cell = 1000 * run("a") / kCells;
  std::cout << "overhead: " << ms_a_cell << " ms of CPU a cell\n";
  EXPECT_LT(ms_a_cell, 8.0);
}

}  // namespace
}  // namespace tribench::testing
