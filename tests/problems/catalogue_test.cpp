// SPDX-License-Identifier: MIT
#include "problems/catalogue.hpp"

#include <gtest/gtest.h>

#include <set>

#include "foundation/error.hpp"

namespace tribench {
namespace {

TEST(Catalogue, NamesAreUniqueAndSummarised) {
  const Catalogue catalogue;
  std::set<std::string> names;
  for (const ProblemEntry& entry : catalogue.entries()) {
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
    EXPECT_FALSE(entry.summary.empty()) << entry.name;
  }
  EXPECT_GE(names.size(), 12U);
}

TEST(Catalogue, AMisspeltNameIsAnsweredWithTheNearest) {
  const Catalogue catalogue;
  try {
    catalogue.find("A/j2/no_laod");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    EXPECT_NE(std::string(error.what()).find("A/j2/no_load"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace tribench
