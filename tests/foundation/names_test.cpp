// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <string>

#include "foundation/error.hpp"
#include "foundation/plain_name.hpp"
#include "foundation/shell_word.hpp"

namespace tribench {
namespace {

TEST(PlainName, AdmitsWhatNeitherFilesNorPagesNorShellsCanMisread) {
  for (const char* name : {"pysr", "paper+safe_div", "v1.2-rc", "2nd"}) {
    EXPECT_TRUE(is_plain_name(name)) << name;
  }
  for (const std::string& name :
       {std::string(), std::string("=cmd"), std::string("-x"), std::string("+1"), std::string("@a"),
        std::string(".."), std::string("x/../../../Y"), std::string("a b"), std::string("a|b"),
        std::string("<b>"), std::string("a\nb"), std::string("a\x01"), std::string("\xff"),
        std::string(65, 'a')}) {
    EXPECT_FALSE(is_plain_name(name)) << name;
    EXPECT_THROW(require_plain_name(name, "a method", "g.toml"), Error) << name;
  }
}

TEST(ShellWord, IsReadBackByAShell) {
  EXPECT_EQ(shell_word("grids/paper.toml"), "grids/paper.toml");
  EXPECT_EQ(shell_word(""), "''");
  EXPECT_EQ(shell_word("a b"), "'a b'");
  EXPECT_EQ(shell_word("it's; rm -rf *"), "'it'\\''s; rm -rf *'");
  EXPECT_EQ(shell_word("a\nb"), "'a\nb'");
}

}  // namespace
}  // namespace tribench
