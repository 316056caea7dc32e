// SPDX-License-Identifier: MIT
#include "harness/cli/program.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <string>

namespace tribench {
namespace {

TEST(Program, PinsTheBlocksOfLargeProductsBeforeItDoesAnything) {
  Eigen::setCpuCacheSizes(48 << 10, 2 << 20, 32 << 20);
  std::string name = "tribench";
  std::string option = "--version";
  char* words[] = {name.data(), option.data(), nullptr};
  EXPECT_EQ(run_program(2, words, Registry()), 0);
  EXPECT_EQ(Eigen::l1CacheSize(), 32 << 10);
}

}  // namespace
}  // namespace tribench
