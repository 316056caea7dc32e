// SPDX-License-Identifier: MIT
#include "foundation/parallel_for.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace tribench {
namespace {

TEST(ParallelFor, DoesEveryPieceOnce) {
  for (const int threads : {0, 1, 4}) {
    std::vector<int> done(100, 0);
    parallel_for(
        done.size(), threads, [&](std::size_t i) { ++done[i]; }, 3);
    EXPECT_EQ(done, std::vector<int>(100, 1)) << threads;
  }
}

// Without it the process ends by std::terminate.
TEST(ParallelFor, ThrowsTheFirstExceptionByIndexForAnyNumberOfThreads) {
  for (const int threads : {1, 4}) {
    std::vector<int> done(50, 0);
    try {
      parallel_for(done.size(), threads, [&](std::size_t i) {
        done[i] = 1;
        if (i % 10 == 7) throw std::runtime_error(std::to_string(i));
      });
      FAIL() << "no exception";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "7") << threads;
    }
    EXPECT_EQ(done, std::vector<int>(50, 1)) << threads;
  }
}

}  // namespace
}  // namespace tribench
