// SPDX-License-Identifier: MIT
#include "foundation/text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/stat.h>

#include <csignal>
#include <fstream>
#include <string>
#include <thread>

#include "foundation/error.hpp"
#include "foundation/scratch_folder.hpp"

namespace tribench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Text, SplitsAtSeparatorsAndTrimsThePieces) {
  EXPECT_THAT(split(" a , b\t", ','), ElementsAre("a", "b"));
  EXPECT_THAT(split("a,,b,", ','), ElementsAre("a", "", "b", ""));
  EXPECT_THAT(split(" \n", ','), IsEmpty());
  EXPECT_EQ(trimmed("\r\n x y \t"), "x y");
}

TEST(Text, IsClippedBetweenCharacters) {
  EXPECT_EQ(clipped("abc", 3), "abc");
  EXPECT_EQ(clipped("abcd", 3), "abc...");
  EXPECT_EQ(clipped("ab\xe2\x82\xac!", 4), "ab...");
  EXPECT_EQ(clipped("ab\xe2\x82\xac!", 5), "ab\xe2\x82\xac...");
}

TEST(Text, IsUtf8OrNot) {
  EXPECT_TRUE(is_utf8(""));
  EXPECT_TRUE(is_utf8("a \xc2\xb5m \xe2\x82\xac \xf0\x9f\x98\x80"));
  for (const char* text : {"a\xff", "\xb5m", "\xe2\x82", "\xc0\xaf", "\xe0\x80\xaf", "\xed\xa0\x80",
                           "\xf0\x80\x80\xaf", "\xf4\x90\x80\x80"})
    EXPECT_FALSE(is_utf8(text));
}

TEST(Text, ControlCharactersAreSeenAndShownAsWhatTheyAreNot) {
  EXPECT_FALSE(holds_control_characters("\xc3\xa9 \xc2\xb5m ~"));  // e acute, micro
  for (const char* text : {"a\x1b[31m", "\x07", "a\tb", "\x7f", "\xc2\x9b"}) {
    EXPECT_TRUE(holds_control_characters(text)) << text;
  }
  EXPECT_EQ(without_control_characters("Torque\n(Nm)\x1b[31m\xc2\x9b\xc2\xb5"),
            "Torque (Nm)?[31m?\xc2\xb5");
  EXPECT_EQ(lines_without_control_characters("a\x07\nb\tc\n"), "a?\nb c\n");
}

// The complaint of reading it; empty where it is read.
std::string complaint_of(const std::filesystem::path& file, std::size_t largest) {
  try {
    read_file(file, largest);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    EXPECT_EQ(error.place(), file.string());
    return error.what();
  }
  return {};
}

// Without a bound the program would read until its memory ends.
TEST(Text, ASentenceBeginsWithALargeLetter) {
  EXPECT_EQ(capitalised("lag of the drive"), "Lag of the drive");
  EXPECT_EQ(capitalised("2 waves"), "2 waves");
  EXPECT_EQ(capitalised("\xC3\xA4 bc"), "\xC3\xA4 bc") << "not one of ASCII's";
  EXPECT_EQ(capitalised(""), "");
}

TEST(Text, ADeviceWithoutAnEndIsRefused) {
  EXPECT_THAT(complaint_of("/dev/zero", kLargestTextFile), HasSubstr("no text"));
  EXPECT_THAT(complaint_of("/dev/urandom", kLargestTextFile), HasSubstr("no text"));
  EXPECT_THAT(complaint_of("/dev", kLargestTextFile), HasSubstr("a folder"));
  EXPECT_EQ(read_file("/dev/null"), "");
  EXPECT_FALSE(read_file_if_there("/dev/zero"));
  EXPECT_FALSE(open_file_if_there("/dev/zero"));
}

TEST(Text, APipeIsReadToItsEndOrToTheBound) {
  const ScratchFolder folder;
  const std::filesystem::path pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_FALSE(read_file_if_there(pipe));  // and does not wait for a writer
  std::string text;
  while (text.size() < 200'000) text += "1.5,-2\n";
  const auto written = [&] {
    return std::thread([&] { std::ofstream(pipe, std::ios::binary) << text; });
  };
  std::signal(SIGPIPE, SIG_IGN);
  std::thread whole = written();
  EXPECT_EQ(read_file(pipe), text);
  whole.join();
  std::thread cut = written();
  EXPECT_THAT(complaint_of(pipe, std::size_t{1} << 16), HasSubstr("longer than"));
  cut.join();
}

TEST(Text, AFileIsReadUpToItsBound) {
  const ScratchFolder folder;
  const std::filesystem::path file = folder.path() / "file";
  std::ofstream(file) << std::string(100'000, 'x');
  EXPECT_EQ(read_file(file, 100'000).size(), 100'000U);
  EXPECT_THAT(complaint_of(file, 99'999), HasSubstr("longer than"));
  EXPECT_EQ(read_file("/proc/self/stat").empty(), false);  // its size is said to be 0
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
