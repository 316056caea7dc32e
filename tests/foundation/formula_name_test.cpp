// SPDX-License-Identifier: MIT
#include "foundation/formula_name.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "foundation/error.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;

TEST(FormulaName, IsAnIdentifierAndNoFunction) {
  for (const char* name : {"v", "_v", "sgn_v", "q2", "exponent", "Tau_m"}) {
    EXPECT_TRUE(is_formula_name(name)) << name;
  }
  for (const char* name : {"", "x+y", "2", "1e5", "exp", "sgn", "sgn_", "x;system(\"id\")",
                           "q [deg]", "a b", "\xcf\x89", "v\n", "-v", "x.y"}) {
    EXPECT_FALSE(is_formula_name(name)) << name;
  }
}

TEST(FormulaName, HasAMendThatIsOne) {
  const std::pair<const char*, const char*> mends[] = {
      {"q [deg]", "q_deg"}, {"x+y", "x_y"},    {"1e5", "x1e5"},  {"exp", "exp_"}, {"", "x"},
      {"  ", "x"},          {"sgn_", "sgn_x"}, {"\xcf\x89", "x"}};
  for (const auto& [name, mend] : mends) {
    EXPECT_EQ(formula_name_for(name), mend) << name;
  }
  for (const char* name : {"x;system(\"id\")", "a\nb", "--", "2", "sgn_"}) {
    EXPECT_TRUE(is_formula_name(formula_name_for(name))) << name << ": " << formula_name_for(name);
  }
}

TEST(FormulaName, IsRefusedWithItsMendAndWithoutControlCharacters) {
  try {
    require_formula_name("q [deg]\n", "data.csv");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    EXPECT_THAT(error.what(), HasSubstr("data.csv: 'q [deg]\\x0a' cannot name an input"));
    EXPECT_THAT(error.what(), HasSubstr("call it q_deg"));
  }
  EXPECT_NO_THROW(require_formula_name("qd", "data.csv"));
}

}  // namespace
}  // namespace tribench
