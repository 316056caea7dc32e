// SPDX-License-Identifier: MIT
#include "foundation/output_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <functional>
#include <future>
#include <set>
#include <string>

#include "foundation/error.hpp"
#include "foundation/scratch_folder.hpp"
#include "foundation/text.hpp"

namespace tribench {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(OutputFile, ALinkStaysALink) {
  const ScratchFolder folder;
  write_file(folder.path() / "file", "old");
  fs::create_symlink("file", folder.path() / "link");
  write_file(folder.path() / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
  EXPECT_EQ(read_file(folder.path() / "file"), "new");
}

TEST(OutputFile, ALinkToWhatIsNotThereYetStaysALink) {
  const ScratchFolder folder;
  fs::create_directory(folder.path() / "place");
  fs::create_symlink("place/second", folder.path() / "first");
  fs::create_symlink("file", folder.path() / "place/second");
  write_file(folder.path() / "first", "new");
  EXPECT_TRUE(fs::is_symlink(folder.path() / "first"));
  EXPECT_TRUE(fs::is_symlink(folder.path() / "place/second"));
  EXPECT_EQ(read_file(folder.path() / "place/file"), "new");
}

TEST(OutputFile, LinksInARingAreAnErrorAndNothingIsLeft) {
  const ScratchFolder folder;
  fs::create_symlink("ring", folder.path() / "ring");
  try {
    write_file(folder.path() / "ring", "text");
    FAIL() << "written";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("ring"), HasSubstr("symbolic links")));
  }
  EXPECT_TRUE(fs::is_symlink(folder.path() / "ring"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
  EXPECT_FALSE(fs::exists(".partial"));
}

// A device that is replaced by a file (/dev/null, as root) is lost to the whole machine.
TEST(OutputFile, WhatIsNoFileIsWrittenToAsItIs) {
  const ScratchFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  auto reader = std::async(std::launch::async, [&pipe] { return read_file(pipe); });
  write_file(pipe, "text");
  EXPECT_EQ(reader.get(), "text");
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(OutputFile, ANameThatNoFileCanHaveIsTheUsersToMend) {
  const ScratchFolder folder;
  write_file(folder.path() / "file", "text");
  fs::create_symlink("ring", folder.path() / "ring");
  const auto write = [](const fs::path& file) { write_file(file, "text"); };
  for (const std::string name : {"no folder/file", "file/below", ".", "ring"}) {
    for (const std::function<void(const fs::path&)>& way :
         {std::function(write), std::function(try_output_file)}) {
      try {
        way(folder.path() / name);
        ADD_FAILURE() << "written: " << name;
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::bad_input) << name;
        EXPECT_THAT(error.what(), HasSubstr("name a file in a folder that is there"));
      }
    }
  }
}

TEST(OutputFile, TryingOneLeavesItAndItsFolderAsTheyAre) {
  const ScratchFolder folder;
  write_file(folder.path() / "file", "text");
  fs::create_symlink("not there yet", folder.path() / "link");
  for (const std::string name : {"file", "link", "another"}) try_output_file(folder.path() / name);
  try_output_file("/dev/null");
  EXPECT_EQ(read_file(folder.path() / "file"), "text");
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.path())) {
    names.insert(entry.path().filename());
  }
  EXPECT_THAT(names, ElementsAre("file", "link"));
}

TEST(OutputFile, SaysWhyItCannotBeWritten) {
  try {
    write_file("/dev/full", "text");
    FAIL() << "written";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::failed);
    EXPECT_THAT(error.what(), HasSubstr("No space left"));
  }
}

}  // namespace
}  // namespace tribench
