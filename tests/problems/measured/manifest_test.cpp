// SPDX-License-Identifier: MIT
#include "problems/measured/manifest.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "foundation/error.hpp"
#include "problems/file_hash.hpp"
#include "problems/measured/entries.hpp"
#include "tests/support/paths.hpp"

namespace tribench::measured {
namespace {

using ::testing::HasSubstr;

constexpr const char* kHead =
    "name = \"x\"\ntitle = \"t\"\nsource = \"s\"\nlicence = \"MIT\"\n"
    "[[file]]\nname = \"j1.csv\"\nsha256 = \"00\"\nrows = 3\n";

std::string complaint(const std::string& text) {
  try {
    parse_manifest(text, "x.toml");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Manifest, TheEmbeddedSetsAreComplete) {
  std::set<std::string> problems;
  for (const Manifest& manifest : shipped_manifests()) {
    EXPECT_FALSE(manifest.licence.empty()) << manifest.name;
    EXPECT_FALSE(manifest.source.empty()) << manifest.name;
    EXPECT_FALSE(manifest.problems.empty()) << manifest.name;
    for (const File& file : manifest.files) {
      EXPECT_EQ(file.sha256.size(), 64U) << file.name;
      EXPECT_GT(file.rows, 0U) << file.name;
    }
    for (const ProblemPlan& plan : manifest.problems) {
      EXPECT_TRUE(problems.insert(plan.name).second) << plan.name;
      EXPECT_TRUE(std::any_of(manifest.files.begin(), manifest.files.end(), [&](const File& file) {
        return file.name == plan.file;
      })) << plan.file;
    }
  }
  EXPECT_EQ(shipped_manifests().size(), 6U);
  EXPECT_EQ(problems.size(), 1U + 2 + 7 + 4 + 5 + 5);
}

TEST(Manifest, AProblemMayStandForSeveralJoints) {
  const Manifest manifest = parse_manifest(
      std::string(kHead) +
          "[columns]\nload_A = {role = \"gravity_torque\", unit = \"A\"}\n"
          "[[problem]]\nname = \"x/j{joint}\"\nsummary = \"joint {joint}\"\njoints = [1, 3]\n"
          "file = \"j{joint}.csv\"\ntarget = \"y\"\ninputs = [\"v\"]\ndecimate = 5\n"
          "movements = {column = \"run\", pieces = 2}\n"
          "derived = [{name = \"y\", difference = [\"a\", \"b\"], role = \"friction_torque\"}]\n",
      "x.toml");
  ASSERT_EQ(manifest.problems.size(), 2U);
  const ProblemPlan& plan = manifest.problems[1];
  EXPECT_EQ(plan.name, "x/j3");
  EXPECT_EQ(plan.file, "j3.csv");
  EXPECT_EQ(plan.joint, 3);
  EXPECT_EQ(plan.decimate, 5);
  EXPECT_EQ(plan.movements.kind, MovementRule::Kind::column);
  EXPECT_EQ(plan.movements.pieces, 2);
  EXPECT_EQ(plan.columns.at("load_A").role, Role::gravity_torque);
  ASSERT_EQ(plan.derived.size(), 1U);
  EXPECT_EQ(plan.derived[0].kind, DerivedChannel::Kind::difference);
}

TEST(Manifest, MistakesAreNamedWithTheirLine) {
  const std::string problem = std::string(kHead) + "[[problem]]\n";
  EXPECT_THAT(complaint("name = "), HasSubstr("x.toml:1"));
  EXPECT_THAT(complaint("name = \"x\"\n"), HasSubstr("'title' is missing"));
  EXPECT_THAT(complaint(std::string("licens = 1\n") + kHead), HasSubstr("did you mean licence?"));
  EXPECT_THAT(complaint(problem + "name = 3\n"), HasSubstr("x.toml:10: 'name' has the wrong type"));
  const std::string good = problem +
                           "name = \"p\"\nsummary = \"s\"\nfile = \"j1.csv\"\ntarget = \"y\"\n"
                           "inputs = [\"v\"]\n";
  EXPECT_EQ(complaint(good), "no error");
  EXPECT_THAT(complaint(good + "decimat = 3\n"), HasSubstr("did you mean decimate?"));
  EXPECT_THAT(complaint(good + "decimate = 0\n"), HasSubstr("at least 1"));
  EXPECT_THAT(complaint(good + "derived = [{name = \"z\"}]\n"), HasSubstr("sign_of"));
  EXPECT_THAT(complaint(good + "columns = {v = {role = \"velocty\"}}\n"), HasSubstr("velocity"));
}

TEST(Manifest, AnUnknownSetIsAnsweredWithTheNearest) {
  try {
    find_manifest(shipped_manifests(), "screw-drive");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean screw-drives?"));
  }
}

class OwnManifests : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::remove_all(data_);
    std::filesystem::create_directories(data_ / "mine");
  }
  void TearDown() override { std::filesystem::remove_all(data_); }
  void write(const std::string& name, const std::string& problem) const {
    std::ofstream(data_ / "mine/rows.csv") << "v,tau\n1,2\n2,4\n3,6\n4,8\n";
    std::ofstream(data_ / "mine/manifest.toml")
        << "name = \"" + name +
               "\"\ntitle = \"My rig\"\nsource = \"a shelf\"\n"
               "licence = \"none\"\n[[file]]\nname = \"rows.csv\"\nsha256 = \"" +
               sha256_of(data_ / "mine/rows.csv") + "\"\n[[problem]]\nname = \"" + problem +
               "\"\nsummary = \"s\"\nfile = \"rows.csv\"\ntarget = \"tau\"\ninputs = [\"v\"]\n"
               "movements = {pieces = 4}\n";
  }
  std::string refusal() const {
    try {
      known_manifests(data_);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  }

  const std::filesystem::path data_ = testing::scratch_folder() / "tribench_own_manifests";
};

TEST_F(OwnManifests, LieBesideTheirDataAndMakeProblems) {
  write("mine", "mine/one");
  EXPECT_EQ(known_manifests(data_).size(), shipped_manifests().size() + 1);
  std::vector<ProblemEntry> entries;
  add_entries(entries, data_);
  const auto entry = std::ranges::find(entries, "mine/one", &ProblemEntry::name);
  ASSERT_NE(entry, entries.end());
  EXPECT_THAT(entry->source, HasSubstr("a shelf"));
  const Problem problem = entry->make(1);
  EXPECT_EQ(problem.stages.front().train.rows(), 3U);
  EXPECT_EQ(problem.test.rows(), 1U);
  std::ofstream(data_ / "mine/rows.csv", std::ios::app) << "5,10\n";
  EXPECT_THROW(entry->make(1), Error);
}

TEST_F(OwnManifests, AreRefusedWhereTheirNamesDoNotHold) {
  write("yours", "yours/one");
  EXPECT_THAT(refusal(), HasSubstr("called 'yours' and its folder 'mine'"));
  write("mine", "mine/a|b");
  EXPECT_THAT(refusal(), HasSubstr("manifest.toml"));
  write("mine", "emps/estimation");
  EXPECT_THAT(refusal(), HasSubstr("two problems are called 'emps/estimation'"));
  std::ofstream(data_ / "mine/manifest.toml") << "name = \"mine\"\ntitel = 1\n";
  EXPECT_THAT(refusal(), HasSubstr("mine/manifest.toml"));
}

}  // namespace
}  // namespace tribench::measured
