// SPDX-License-Identifier: MIT
#include "foundation/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>

#include "foundation/error.hpp"

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
  const std::string process = std::to_string(::getpid());
  EXPECT_EQ(one.path().filename().string().find(process), std::string::npos) << "can be foretold";
}

class TemporaryFilesTest : public ::testing::Test {
 protected:
  void TearDown() override {
    before_ ? ::setenv("TMPDIR", before_->c_str(), 1) : ::unsetenv("TMPDIR");
  }

 private:
  static std::optional<std::string> now() {
    const char* value = std::getenv("TMPDIR");
    return value == nullptr ? std::nullopt : std::optional<std::string>(value);
  }
  std::optional<std::string> before_ = now();
};

TEST_F(TemporaryFilesTest, AFolderThatIsNotThereIsNamed) {
  ::setenv("TMPDIR", "/tribench/not/there", 1);
  try {
    const ScratchFolder folder;
    ADD_FAILURE() << folder.path();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::environment);
    EXPECT_EQ(error.place(), "/tribench/not/there");
  }
}

TEST_F(TemporaryFilesTest, AnEmptyNameIsNone) {
  ::setenv("TMPDIR", "", 1);
  EXPECT_EQ(ScratchFolder().path().parent_path(), "/tmp");
}

}  // namespace
}  // namespace tribench
