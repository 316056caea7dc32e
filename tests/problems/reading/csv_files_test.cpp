// SPDX-License-Identifier: MIT
//
// Several files as one campaign.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "foundation/error.hpp"
#include "problems/reading/csv.hpp"
#include "tests/support/paths.hpp"

namespace tribench {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(CsvFiles, SpareColumnsThatNotAllFilesHaveAreLeftOut) {
  const std::filesystem::path folder = testing::scratch_folder() / "spare_columns";
  std::filesystem::create_directories(folder);
  const auto write = [&](const char* name, const char* text) {
    std::ofstream(folder / name) << text;
    return folder / name;
  };
  const std::vector<std::filesystem::path> files = {write("a.csv", "time_s,load\n0,1\n1,2\n"),
                                                    write("b.csv", "time_s,load\n0,x\n1,2\n")};
  CsvOptions options;
  options.used = std::vector<std::string>();
  options.spare = true;
  EXPECT_EQ(read_csv(files[0], options).spare.size(), 1U);
  const DataFile both = read_csv_files(files, options);
  EXPECT_TRUE(both.spare.empty());
  EXPECT_EQ(both.data.channels.size(), 1U);
  EXPECT_EQ(both.data.rows(), 4U);
  std::filesystem::remove_all(folder);
}

TEST(CsvFiles, ARecordingThatIsGivenTwiceCountsOnce) {
  const std::filesystem::path folder = testing::scratch_folder() / "csv_twice";
  std::filesystem::create_directories(folder);
  std::vector<std::filesystem::path> files;
  for (const int start : {0, 500, 1}) {  // the third is another recording
    std::string text = "time_s,y\n";
    for (int i = 0; i < 100; ++i) text += fmt::format("{},{}\n", start + i, i * i + start % 500);
    files.push_back(folder / fmt::format("{}.csv", start));
    std::ofstream(files.back()) << text;
  }
  const DataFile all = read_csv_files(files);
  EXPECT_EQ(all.data.rows(), 200U);
  EXPECT_THAT(all.warnings, ::testing::ElementsAre(AllOf(HasSubstr("500.csv has the very rows of"),
                                                         HasSubstr("left out"))));
  std::filesystem::remove_all(folder);
}

TEST(CsvFiles, FilesThatDoNotNameTheSameUnitsAreNotJoined) {
  const std::filesystem::path folder = testing::scratch_folder() / "csv_units";
  std::filesystem::create_directories(folder);
  const auto joined = [&](const char* first, const char* second) -> std::string {
    std::ofstream(folder / "a.csv") << first << "\n0,1\n1,2\n";
    std::ofstream(folder / "b.csv") << second << "\n0,1\n1,2\n";
    const std::vector<std::filesystem::path> files = {folder / "a.csv", folder / "b.csv"};
    try {
      return fmt::format("{} rows", read_csv_files(files).data.rows());
    } catch (const Error& error) {
      return error.what();
    }
  };
  EXPECT_EQ(joined("q,tau\ndeg,N m", "q,tau\ndeg,N m"), "4 rows");
  EXPECT_EQ(joined("q,tau\ndeg,N m", "q,tau\nrad,mN m"), "4 rows");  // both become SI
  EXPECT_EQ(joined("q,tau", "q,tau"), "4 rows");
  EXPECT_THAT(
      joined("q,tau\ndeg,N m", "q,tau"),
      AllOf(HasSubstr("b.csv: 'tau' is motor_torque in a unit that is not named, and in the first "
                      "file motor_torque in 'N m'"),
            HasSubstr("--roles 'tau=ROLE[UNIT]'")));
  EXPECT_THAT(joined("q,tau\ndeg,N m", "q,tau\ndeg,A"), HasSubstr("'tau'"));
  std::filesystem::remove_all(folder);
}

struct Recording {
  double speed = 1;     // of its motion
  double current = 1;   // how its unit counts
  double position = 1;  // the same
};

std::string joined_recordings(const std::vector<Recording>& recordings) {
  const std::filesystem::path folder = testing::scratch_folder() / "csv_scales";
  std::filesystem::create_directories(folder);
  std::vector<std::filesystem::path> files;
  for (const Recording& one : recordings) {
    std::string text = "t,q,dq,current\n";
    for (int i = 0; i < 400; ++i) {
      const double t = 0.01 * i;
      const double v = one.speed * std::sin(2 * t);
      const double friction = (v > 0 ? 1 : -1) * (one.speed > 0 ? 1 : 0) + 0.8 * v;
      text += fmt::format("{:.2f},{:.6f},{:.6f},{:.6f}\n", t,
                          one.position * one.speed * (1 - std::cos(2 * t)) / 2, v,
                          one.current * (friction + 0.001 * std::sin(30.0 * i)));
    }
    files.push_back(folder / fmt::format("{}.csv", files.size()));
    std::ofstream(files.back()) << text;
  }
  CsvOptions options;
  options.roles = parse_roles("current=motor_current[A],q=position[rad]", "--roles");
  std::string said = "read";
  try {
    for (const std::string& warning : read_csv_files(files, options).warnings)
      said += "; " + warning;
  } catch (const Error& error) {
    said = error.what();
  }
  std::filesystem::remove_all(folder);
  return said;
}

TEST(CsvFiles, AFileWhoseUnitIsAnotherIsNamed) {
  EXPECT_THAT(joined_recordings({{1}, {0.7}, {1.5, 1000}}),
              AllOf(HasSubstr("2.csv: 'current' is about 1000 times as large here"),
                    HasSubstr("'current [UNIT]'")));
  EXPECT_THAT(
      joined_recordings({{1, 0.001}, {0.7}, {1.5}}),
      AllOf(HasSubstr("read;"), HasSubstr("0.csv: 'current' is about 1000 times as small here")));
  EXPECT_THAT(
      joined_recordings({{1}, {0.7, 1000}}),
      AllOf(HasSubstr("read;"), HasSubstr("1.csv: 'current' is about 1000 times as large here")));
  EXPECT_THAT(joined_recordings({{1}, {0.7, 1, 57.29578}, {1.5}}),
              HasSubstr("1.csv: 'q' changes 57.3 times as much with 'dq' here"));
}

TEST(CsvFiles, OrdinaryMotionsAreNoOtherUnits) {
  EXPECT_EQ(joined_recordings({{1}, {0.05}, {1.1}}), "read") << "twenty times as slow";
  EXPECT_EQ(joined_recordings({{0.05}, {1}}), "read");
  EXPECT_EQ(joined_recordings({{1}, {0.05}, {20}}), "read");
  EXPECT_EQ(joined_recordings({{1}, {0}}), "read") << "the joint rests in the second";
  EXPECT_EQ(joined_recordings({{0}, {1}, {2}}), "read");
}

}  // namespace
}  // namespace tribench
