// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "foundation/error.hpp"
#include "problems/suite/suite_problem.hpp"
#include "tests/support/paths.hpp"

namespace tribench::suite {
namespace {

constexpr const char* kSmall = R"(
[suite]
name = "small"
rows = 200
test_rows = 300
[grid]
methods = ["pysr"]
[[problem]]
name = "product"
law = "x*y"
unit = "N m"
inputs = [
  { name = "x", low = 1e-3, high = 1e3, draw = "log", sign = "either", unit = "m" },
  { name = "y", low = 2, high = 5, draw = "whole", test_low = 2, test_high = 9 },
]
[[reference]]
method = "other"
seconds = 2
recovered = 0.5
)";

// Knows three laws, whatever the text.
Law read_product(const std::string& formula, std::span<const std::string> /*names*/) {
  if (formula == "log(x)") return [](std::span<const double> p) { return std::log(p[0]); };
  return [](std::span<const double> p) { return p.size() == 1 ? p[0] : p[0] * p[1]; };
}

std::string complaint(const std::string& toml) {
  try {
    read_suite(toml, "s.toml");
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

std::string with_input(const std::string& input) {
  return "[suite]\nname = \"s\"\nrows = 3\ntest_rows = 3\n[[problem]]\nname = \"p\"\nlaw = "
         "\"x\"\ninputs = [{ " +
         input + " }]\n";
}

// A file of results as others publish them, in a folder of its own.
std::filesystem::path published_folder(const std::string& text) {
  const std::filesystem::path folder = testing::scratch_folder() / "tribench published results";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "published.csv") << text;
  return folder;
}

const PublishedTable kPublished = {"published.csv", "r2_median",    "seconds",
                                   "formula",       "edition=2021", ""};

TEST(Suite, PublishedResultsAreReadFromTheLinesThatItSays) {
  const auto folder = published_folder(
      "edition,dataset,method,formula,r2_median,seconds\n"
      "2021,cloud,GP,1,0.5,7\n2025,cloud,GP,1,0.6,8\n2021,cloud,XGB,0,0.7,9\n2021,cloud,DSR,1,,"
      "9\n");
  const std::vector<PublishedResult> read = read_published_results(kPublished, folder);
  ASSERT_EQ(read.size(), 2U);  // of DSR there is no figure
  EXPECT_EQ(read[0].dataset, "cloud");
  EXPECT_EQ(read[0].method, "GP");
  EXPECT_EQ(read[0].r2, 0.5);
  EXPECT_EQ(read[0].seconds, 7);
  EXPECT_TRUE(read[0].symbolic);
  EXPECT_FALSE(read[1].symbolic);
}

TEST(Suite, AMistakeInPublishedResultsIsNamedWithItsLine) {
  const auto refusal = [](const std::string& lines) {
    const auto folder =
        published_folder("edition,dataset,method,formula,r2_median,seconds\n" + lines);
    try {
      read_published_results(kPublished, folder);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refusal("2021,cloud,GP,1,0.5,7\n"), "accepted");
  EXPECT_NE(refusal("2021,cloud,GP,1,good,7\n").find("published.csv:2"), std::string::npos);
  EXPECT_NE(refusal("2021,cloud,GP,1,0.5,7\n2021,cloud,GP,1,0.6,7\n").find("stands twice"),
            std::string::npos);
  PublishedTable other = kPublished;
  other.r2 = "r2_mediam";
  EXPECT_THROW(read_published_results(other, published_folder("edition,dataset,method,r2_median\n"
                                                              "2021,a,b,1\n")),
               Error);
  EXPECT_NE(complaint("[suite]\nname = \"s\"\n[published]\nfile = \"a.csv\"\nwhere = \"2021\"\n")
                .find("COLUMN=VALUE"),
            std::string::npos);
}

TEST(Suite, AMistakeIsNamedWithItsPlaceAndMend) {
  EXPECT_EQ(complaint(with_input("name = \"x\", low = 1, high = 2")), "accepted");
  EXPECT_NE(complaint(with_input("name = \"x\", low = 2, high = 1")).find("s.toml:8"),
            std::string::npos);
  EXPECT_NE(complaint(with_input("name = \"x\", low = 0, high = 1, draw = \"log\"")).find("low"),
            std::string::npos);
  EXPECT_NE(complaint(with_input("name = \"x\", low = 1, high = 2, draw = \"logg\""))
                .find("did you mean log"),
            std::string::npos);
  EXPECT_NE(
      complaint(with_input("name = \"x\", low = 1, high = 2, draw = \"lattice\"")).find("step"),
      std::string::npos);
  EXPECT_NE(complaint(with_input("name = \"x\", lo = 1, high = 2")).find("did you mean low"),
            std::string::npos);
  EXPECT_NE(complaint("[suite]\nname = \"s\"\n[[problem]]\nname = \"p\"\n").find("no data"),
            std::string::npos);
  const std::string twice = "[[problem]]\nname = \"p\"\nfile = \"a.csv\"\n";
  EXPECT_NE(complaint("[suite]\nname = \"s\"\n" + twice + twice).find("two problems"),
            std::string::npos);
  EXPECT_NE(complaint("[grid]\nname = \"s\"\n").find("suite"), std::string::npos);
}

TEST(Suite, DrawsAreWhatTheySay) {
  const Suite suite = read_suite(kSmall, "small.toml");
  const Problem problem = make_suite_problem(suite, suite.find("product"), read_product, {}, 1);
  EXPECT_EQ(problem.name, "small/product");
  EXPECT_EQ(problem.target_unit, "N m");
  EXPECT_EQ(problem.inputs[0].low, -1e3);
  EXPECT_EQ(problem.inputs[1].high, 9);
  const Table& train = problem.stages[0].train;
  ASSERT_EQ(train.rows(), 200U);
  ASSERT_EQ(problem.test.rows(), 300U);
  int negative = 0;
  int small = 0;
  std::set<double> whole;
  for (std::size_t r = 0; r < train.rows(); ++r) {
    negative += train.columns[0][r] < 0 ? 1 : 0;
    small += std::abs(train.columns[0][r]) < 1 ? 1 : 0;
    whole.insert(train.columns[1][r]);
    EXPECT_EQ(train.target[r], train.columns[0][r] * train.columns[1][r]);
  }
  EXPECT_NEAR(negative, 100, 30);
  EXPECT_NEAR(small, 100, 30);  // three decades on either side of 1
  EXPECT_EQ(whole, (std::set<double>{2, 3, 4, 5}));
  EXPECT_GT(*std::ranges::max_element(problem.test.columns[1]), 5);
  EXPECT_NE(
      make_suite_problem(suite, suite.find("product"), read_product, {}, 2).stages[0].train.target,
      train.target);
}

TEST(Suite, ALatticeHasEveryPointAndLeavesOutWhereTheLawIsNotFinite) {
  const Suite suite = read_suite(
      "[suite]\nname = \"s\"\n[[problem]]\nname = \"p\"\nlaw = \"log(x)\"\ninputs = [{ name = "
      "\"x\", low = 0, high = 1, draw = \"lattice\", step = 0.1, test_step = 0.01 }, { name = "
      "\"y\", low = 1, high = 2, draw = \"lattice\", step = 1 }]\n",
      "s.toml");
  const Problem problem = make_suite_problem(suite, suite.problems[0], read_product, {}, 1);
  EXPECT_EQ(problem.stages[0].train.rows(), 20U);  // 11 points less x = 0, twice
  EXPECT_EQ(problem.test.rows(), 200U);
  EXPECT_EQ(problem.stages[0].train.columns[0][0], 0.1);
}

TEST(Suite, ALatticeStaysBelowItsHighEndWhereNoStepMeetsIt) {
  const Suite suite = read_suite(
      "[suite]\nname = \"s\"\n[[problem]]\nname = \"p\"\nlaw = \"x\"\ninputs = [{ name = "
      "\"x\", low = 0, high = 1, draw = \"lattice\", step = 0.4, test_step = 0.3 }]\n",
      "s.toml");
  const Problem problem = make_suite_problem(suite, suite.problems[0], read_product, {}, 1);
  EXPECT_EQ(problem.stages[0].train.columns[0], (std::vector<double>{0, 0.4, 0.8}));
}

constexpr const char* kLattice = "name = \"x\", low = 0, high = 1, draw = \"lattice\", step = 0.1";

std::string lattice_suite(const std::string& head, const std::string& problem,
                          const std::string& of_input = {}) {
  return "[suite]\nname = \"s\"\n" + head + "[[problem]]\nname = \"p\"\nlaw = \"x\"\n" + problem +
         "inputs = [{ " + kLattice + of_input + " }]\n";
}

TEST(Suite, UnseenRowsOfALatticeAreDrawnBetweenItsPointsWhereNothingIsSaidOfThem) {
  const Suite suite = read_suite(lattice_suite("", "test_rows = 50\n"), "s.toml");
  const Problem problem = make_suite_problem(suite, suite.problems[0], read_product, {}, 1);
  const std::vector<double>& train = problem.stages[0].train.columns[0];
  const std::vector<double>& test = problem.test.columns[0];
  EXPECT_EQ(train.size(), 11U);
  EXPECT_EQ(test.size(), 50U);
  for (const double x : test) {
    EXPECT_TRUE(x >= 0 && x <= 1);
    EXPECT_EQ(std::ranges::count(train, x), 0);
  }
  EXPECT_EQ(make_suite_problem(suite, suite.problems[0], read_product, {}, 1).test.columns[0],
            test);
  EXPECT_NE(make_suite_problem(suite, suite.problems[0], read_product, {}, 2).test.columns[0],
            test);
}

TEST(Suite, ANumberOfRowsThatALatticeOrATableWouldNotTakeIsRefused) {
  const auto expect = [](const std::string& toml, const std::string& text) {
    const std::string said = complaint(toml);
    EXPECT_NE(said.find(text), std::string::npos) << said;
  };
  expect(lattice_suite("", "test_rows = 50\nrows = 20\n"),
         "s.toml:7:8: 'rows' is 20 and a lattice");
  expect(lattice_suite("", "test_rows = 50\n", ", test_step = 0.01"), "s.toml:6:13: 'test_rows'");
  expect(lattice_suite("", ""),
         "s.toml:3:1: nothing says how many rows of 'p' to draw; give 'test_rows'");
  expect(lattice_suite("rows = 20\n", "test_rows = 50\n"),
         "s.toml:3:8: 'rows' is given and no problem");
  expect(lattice_suite("test_rows = 9\n", "", ", test_step = 0.01"), "s.toml:3:13: 'test_rows'");
  expect(lattice_suite("", "", ", test_low = 0, test_step = 0.1"),
         "the test points of problem 'p' are its training points");
  expect("[suite]\nname = \"s\"\n[[problem]]\nname = \"p\"\nfile = \"a.csv\"\nrows = 9\n",
         "s.toml:6:8: 'rows' is 9 and a table");
  expect(with_input("name = \"x\", low = 0, high = 1, step = 0.1"),
         "'step' of input 'x' is of no lattice");
  EXPECT_EQ(complaint(lattice_suite("test_rows = 9\n", "")), "accepted");
  EXPECT_EQ(complaint(lattice_suite("", "", ", test_step = 0.01")), "accepted");
}

TEST(Suite, ALawThatIsFiniteNowhereIsRefused) {
  const Suite suite = read_suite(
      "[suite]\nname = \"s\"\nrows = 3\ntest_rows = 3\n[[problem]]\nname = \"p\"\nlaw = "
      "\"log(x)\"\ninputs = [{ name = \"x\", low = 1, high = 2, sign = \"negative\" }]\n",
      "s.toml");
  EXPECT_THROW(make_suite_problem(suite, suite.problems[0], read_product, {}, 1), Error);
}

TEST(Suite, TablesAndSuitesOfOnesOwnLieInTheFolderOfData) {
  const std::filesystem::path data = testing::scratch_folder() / "suite_data";
  std::filesystem::remove_all(data);
  std::filesystem::create_directories(data / "suites");
  std::ofstream table(data / "rows.csv");
  table << "a,b,target\n";
  for (int r = 0; r < 8; ++r) table << r << ',' << 2 * r << ',' << 3 * r << '\n';
  table.close();
  std::ofstream(data / "splits.csv") << "dataset,seed,test_rows\np,11,0 7\np,12,1 2\n";
  std::ofstream(data / "suites/mine.toml")
      << "[suite]\nname = \"mine\"\nsplits = \"splits.csv\"\n[[problem]]\nname = \"p\"\nfile = "
         "\"rows.csv\"\n";
  const std::vector<Suite> suites = known_suites(data);
  EXPECT_EQ(suites.back().name, "mine");
  EXPECT_EQ(suites.size(), shipped_suites().size() + 1);
  const Problem first = make_suite_problem(suites.back(), suites.back().problems[0], {}, data, 1);
  EXPECT_EQ(first.test.target, (std::vector<double>{0, 21}));
  EXPECT_EQ(first.inputs[1].name, "b");
  EXPECT_EQ(first.inputs[1].high, 12);
  const Problem second = make_suite_problem(suites.back(), suites.back().problems[0], {}, data, 2);
  EXPECT_EQ(second.test.target, (std::vector<double>{3, 6}));
  const Problem third = make_suite_problem(suites.back(), suites.back().problems[0], {}, data, 3);
  EXPECT_EQ(third.test.target, first.test.target);  // round and round
}

}  // namespace
}  // namespace tribench::suite
