// SPDX-License-Identifier: MIT
#include "problems/measured/data_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "foundation/error.hpp"
#include "problems/file_hash.hpp"
#include "tests/support/paths.hpp"

namespace tribench::measured {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// SHA-256 of "abc": FIPS 180-2, appendix B.1.
constexpr const char* kHashOfAbc =
    "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";

class DataFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    root_ = testing::scratch_folder() /
            ("tribench_data_" +
             std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(root_);
    fs::create_directories(root_ / "source");
    write("source/a.csv", "abc");
    manifest_.name = "little";
    manifest_.source = "somewhere";
    manifest_.files = {{"a.csv", kHashOfAbc, 1}};
  }
  void TearDown() override { fs::remove_all(root_); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(root_ / name, std::ios::binary) << text;
  }

  fs::path root_;
  Manifest manifest_;
};

TEST_F(DataFolder, HashesAreThoseOfTheStandard) {
  EXPECT_EQ(sha256_of(root_ / "source/a.csv"), kHashOfAbc);
  write("source/empty", "");
  EXPECT_EQ(sha256_of(root_ / "source/empty"),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  write("source/million", std::string(1000000, 'a'));
  EXPECT_EQ(sha256_of(root_ / "source/million"),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  EXPECT_THROW(sha256_of(root_ / "source/none"), Error);
}

TEST_F(DataFolder, FilesAreGoodMissingOrChanged) {
  EXPECT_EQ(check_set(manifest_, root_ / "source")[0].state, FileState::good);
  EXPECT_EQ(check_set(manifest_, root_ / "nowhere")[0].state, FileState::missing);
  write("source/a.csv", "abd");
  const FileCheck check = check_set(manifest_, root_ / "source")[0];
  EXPECT_EQ(check.state, FileState::changed);
  EXPECT_EQ(check.found.size(), 64U);
}

TEST_F(DataFolder, ASetIsAddedOnlyWhenEveryHashIsGood) {
  const fs::path added = add_set(manifest_, root_ / "source", root_ / "data");
  EXPECT_EQ(check_set(manifest_, added)[0].state, FileState::good);
  // The folder that holds the set's folder will do too.
  EXPECT_EQ(add_set(manifest_, root_ / "data", root_ / "again"), root_ / "again/little");
  write("source/a.csv", "abd");
  try {
    add_set(manifest_, root_ / "source", root_ / "other");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("somewhere"));
  }
  EXPECT_FALSE(fs::exists(root_ / "other"));
}

TEST_F(DataFolder, AFolderThatIsNamedMustBeThere) {
  EXPECT_EQ(find_data_folder(root_), root_);
  EXPECT_THROW(find_data_folder(root_ / "nowhere"), Error);
}

TEST(SharedData, EveryFileHasItsHash) {
  const auto data = testing::shared_data();
  if (!data) GTEST_SKIP() << testing::kNoSharedData;
  for (const Manifest& manifest : shipped_manifests()) {
    for (const FileCheck& check : check_set(manifest, *data / manifest.name)) {
      EXPECT_EQ(check.state, FileState::good) << check.set << "/" << check.file;
    }
  }
}

}  // namespace
}  // namespace tribench::measured
