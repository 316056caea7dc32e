// SPDX-License-Identifier: MIT
#include "foundation/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <optional>

namespace tribench {
namespace {

namespace fs = std::filesystem;

TEST(ScratchFolder, OnlyItsOwnerMayEnterAndNothingStays) {
  std::optional<ScratchFolder> folder(std::in_place);
  const fs::path path = folder->path();
  EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_all);
  fs::create_directory(path / "inner");
  std::ofstream(path / "inner" / "file") << "text";
  folder.reset();
  EXPECT_FALSE(fs::exists(path));
}

TEST(ScratchFolder, TwoHaveDifferentNames) {
  const ScratchFolder one;
  const ScratchFolder other;
  EXPECT_NE(one.path(), other.path());
}

}  // namespace
}  // namespace tribench
