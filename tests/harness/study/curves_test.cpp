// SPDX-License-Identifier: MIT
#include "harness/curves.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "foundation/output_file.hpp"
#include "foundation/scratch_folder.hpp"
#include "foundation/text.hpp"
#include "reports/record/record_csv.hpp"

namespace tribench {
namespace {

Record record(const std::string& problem, std::uint64_t seed, double mae,
              const std::string& formula) {
  Record made;
  made.cell = problem + "|m|paper|" + std::to_string(seed);
  made.problem = problem;
  made.method = "m";
  made.operators = "paper";
  made.seed = seed;
  made.status = CellStatus::ok;
  made.mae_test = mae;
  made.formula = formula;
  return made;
}

std::map<std::string, int> counts(const std::vector<CurveRecord>& points) {
  std::map<std::string, int> all;
  for (const CurveRecord& point : points) {
    all[point.picture + "/" + (point.method.empty() ? "-" : point.method)] += 1;
    EXPECT_TRUE(std::isfinite(point.y));
  }
  return all;
}

TEST(Curves, DrawTheSeedWithTheMedianErrorBesideTheLawAndTheRows) {
  const std::vector<Record> records = {record("A/j2/no_load", 1, 0.3, "1*qd"),
                                       record("A/j2/no_load", 2, 0.1, "10*sgn_qd"),
                                       record("A/j2/no_load", 3, 0.2, "20*qd")};
  const std::vector<CurveRecord> points = sample_curves(records, Catalogue()).points;
  const auto all = counts(points);
  EXPECT_EQ(all.at("friction/m"), 42);
  EXPECT_EQ(all.at("error/m"), 10);
  EXPECT_EQ(all.at("profile/m"), 101);
  EXPECT_EQ(all.at("profile/-"), 101);
  EXPECT_EQ(all.at("friction/-"), 42 + 10);  // the law and the measured rows
  for (const CurveRecord& point : points) {
    if (point.method != "m") continue;
    EXPECT_EQ(point.cell, "A/j2/no_load|m|paper|3");
    if (point.picture == "friction") {
      EXPECT_NEAR(point.y, 20 * point.x, 1e-12);
    }
  }
}

TEST(Curves, LeaveOutWhatIsNotFinite) {
  const auto all =
      counts(sample_curves({record("A/j4/load", 1, 0.3, "log(qd)")}, Catalogue()).points);
  EXPECT_EQ(all.at("friction/m"), 3 * 21);  // three loads, the positive half
}

TEST(Curves, AProblemWhoseDataAreNotHereKeepsThoseOfItsFile) {
  const ScratchFolder scratch;
  const std::filesystem::path folder = scratch.path();
  const Catalogue nothing_measured(folder / "none");
  EXPECT_TRUE(sample_curves({}, nothing_measured).points.empty());
  std::vector<CellResult> results(2);
  results[0].record = record("emps/estimation", 1, 0.3, "velocity_m_s");
  results[1].record = record("A/j2/no_load", 1, 0.3, "1*qd");
  const auto problems_drawn = [&] {
    std::set<std::string> names;
    read_curves(folder / "curves.csv",
                [&](CurveRecord&& point) { names.insert(std::move(point.problem)); });
    return names;
  };
  using ::testing::ElementsAre;
  using ::testing::HasSubstr;
  EXPECT_THAT(write_curves(folder, results, nothing_measured),
              ElementsAre(HasSubstr("the pictures of emps/estimation are missing: ")));
  EXPECT_THAT(problems_drawn(), ElementsAre("A/j2/no_load"));

  const CurveRecord drawn = {
      "cell", "emps/estimation", "m", "paper", "error", "measured rows", "v", "i", 1, 1};
  CurveRecord old = drawn;
  old.problem = "A/j2/no_load";  // drawn anew, so that this one goes
  old.curve = "of yesterday";
  write_file(folder / "curves.csv", curves_csv({drawn, old}));
  EXPECT_THAT(write_curves(folder, results, nothing_measured),
              ElementsAre(HasSubstr("the pictures of emps/estimation are those of the run: ")));
  EXPECT_THAT(problems_drawn(), ElementsAre("A/j2/no_load", "emps/estimation"));
  EXPECT_THAT(read_file(folder / "curves.csv"), Not(HasSubstr("of yesterday")));
}

}  // namespace
}  // namespace tribench
