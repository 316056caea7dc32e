// SPDX-License-Identifier: MIT
#include "foundation/text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "foundation/error.hpp"
#include "foundation/scratch_folder.hpp"

namespace tribench {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Text, SplitsAtSeparatorsAndTrimsThePieces) {
  EXPECT_THAT(split(" a , b\t", ','), ElementsAre("a", "b"));
  EXPECT_THAT(split("a,,b,", ','), ElementsAre("a", "", "b", ""));
  EXPECT_THAT(split(" \n", ','), IsEmpty());
  EXPECT_EQ(trimmed("\r\n x y \t"), "x y");
}

TEST(Text, AFileIsReadWholeAndAMissingOneIsNamed) {
  const ScratchFolder folder;
  const std::string bytes("a\0b\r\n", 5);
  std::ofstream(folder.path() / "bytes", std::ios::binary) << bytes;
  EXPECT_EQ(read_file(folder.path() / "bytes"), bytes);
  EXPECT_FALSE(read_file_if_there(folder.path() / "none"));
  EXPECT_FALSE(read_file_if_there(folder.path()));
  try {
    read_file(folder.path() / "none");
    FAIL() << "a missing file was read";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    EXPECT_THAT(error.what(), testing::HasSubstr("none"));
  }
}

}  // namespace
}  // namespace tribench
