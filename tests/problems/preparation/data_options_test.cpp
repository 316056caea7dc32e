// SPDX-License-Identifier: MIT
#include "problems/preparation/data_options_toml.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "foundation/error.hpp"
#include "foundation/scratch_folder.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;

DataOptions options_of(const std::string& toml) {
  const toml::table root = parse_toml(toml, "grid.toml");
  return read_data_options(TomlTable(root, "grid.toml", "[[problem]]", data_option_keys()));
}

std::string refusal(const std::string& toml) {
  try {
    options_of(toml);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    return error.what();
  }
  return "no error";
}

constexpr const char* kText = "run,phi,i,tau\n1,90,100,2\n1,180,,3\n2,270,300,4\n";

TEST(DataOptions, ATableOfTomlSaysWhatTheCommandLineSays) {
  const ScratchFolder folder;
  const std::filesystem::path file = folder.path() / "log.csv";
  std::ofstream(file) << kText;
  const DataOptions options = options_of(
      "roles = 'phi=position[deg@motor], i=motor_current[mA]'\nwhere = 'run=1'\n"
      "drop_missing = true\ngear_ratio = 2.0\ntorque_constant = '0.5@motor'\n");
  const std::vector<std::filesystem::path> files = {file};
  const DataFile read = read_named_columns(files, options, std::vector<std::string>{"phi", "i"});
  ASSERT_EQ(read.data.rows(), 1U);
  EXPECT_EQ(read.dropped_rows, 1U);
  EXPECT_NEAR(read.data.at("phi").values[0], std::numbers::pi / 4, 1e-15);
  EXPECT_NEAR(read.data.at("i").values[0], 0.1, 1e-15);
  EXPECT_EQ(read.data.at("i").role, Role::motor_torque);
  EXPECT_EQ(read.data.at("i").unit, "N m");
  EXPECT_THAT(read.warnings,
              ::testing::Contains(::testing::HasSubstr("in mA (--roles): read as A")));
}

TEST(DataOptions, ATableOfTomlMaySayTheRateOfItsRows) {
  const ScratchFolder folder;
  const std::filesystem::path file = folder.path() / "log.csv";
  std::ofstream(file) << kText;
  const std::vector<std::filesystem::path> files = {file};
  const DataFile read =
      read_named_columns(files, options_of("sample_rate = 500.0"), std::vector<std::string>{"phi"});
  ASSERT_NE(read.data.find(Role::time), nullptr);
  EXPECT_EQ(read.data.find(Role::time)->values, (std::vector<double>{0, 0.002, 0.004}));
  EXPECT_THAT(refusal("sample_rate = 0.0"), HasSubstr("sample_rate"));
}

// A number or a word, and what is written is read again.
TEST(DataOptions, AJointMayBeAWord) {
  for (const char* joint : {"4", "'elbow'"}) {
    toml::table written;
    insert_data_options(written, options_of(std::string("joint = ") + joint));
    const DataOptions again =
        read_data_options(TomlTable(written, "again.toml", "", data_option_keys()));
    EXPECT_EQ(again.joint.value_or(-1), *joint == '4' ? 4 : -1);
    EXPECT_EQ(again.joint_word, *joint == '4' ? "" : "elbow");
  }
  EXPECT_THAT(refusal("joint = '1000'"), HasSubstr("grid.toml:1"));
}

TEST(DataOptions, AnEmptyTableLeavesTheColumnsAsTheyAre) {
  const ScratchFolder folder;
  const std::filesystem::path file = folder.path() / "log.csv";
  std::ofstream(file) << kText;
  const std::vector<std::filesystem::path> files = {file};
  const DataFile read =
      read_named_columns(files, options_of(""), std::vector<std::string>{"phi", "tau"});
  EXPECT_EQ(read.data.rows(), 3U);
  EXPECT_EQ(read.data.at("tau").role, Role::none);
  EXPECT_EQ(read.data.at("phi").values[0], 90);
}

// Rows before the first that is left out stay where they are.
TEST(DataOptions, WhereKeepsTheTextsOfTheRowsThatAreLeft) {
  const ScratchFolder folder;
  const std::filesystem::path file = folder.path() / "log.csv";
  std::ofstream(file)
      << "run,place,tau\n1,here,2\n1,there,3\n2,here,4\n1,a place far from here,5\n";
  DataOptions options;
  options.where = "run=1";
  const DataFile data = read_data(std::vector{file}, options);
  ASSERT_EQ(data.texts.size(), 1U);
  EXPECT_THAT(data.texts[0].values,
              ::testing::ElementsAre("here", "there", "a place far from here"));
}

TEST(DataOptions, ARefusalNamesTheKeyAndItsLine) {
  EXPECT_THAT(refusal("joint = 1\nroles = 'q=positon'"), HasSubstr("grid.toml:2"));
  EXPECT_THAT(refusal("gear_ratio = 0.0"), HasSubstr("gear_ratio"));
  EXPECT_THAT(refusal("torque_constant = 'much'"), HasSubstr("grid.toml:1"));
  EXPECT_THAT(refusal("role = 'q=position'"), HasSubstr("roles"));
}

}  // namespace
}  // namespace tribench
