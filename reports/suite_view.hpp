// SPDX-License-Identifier: MIT
//
// A run of a suite as others report theirs: how many problems were recovered, by which method, in
// what time, beside published shares. From records and suites.json alone.
//
// Recovered: the fraction of variance unexplained on unseen rows, 1 - R2, is at most the suite's
// bound; of a constant law, which has no variance, the squared error's share of the squared value.
// A failed cell is not recovered.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "reports/record/record.hpp"
#include "reports/run_folder.hpp"
#include "reports/statistics/intervals.hpp"
#include "reports/suite_ranks.hpp"

namespace tribench {

// Its name in a run's folder.
inline constexpr const char* kSuiteFile = "suites.json";

struct SuiteProblemInfo {
  std::string problem;  // "nguyen/1"
  std::string law;      // empty where none is known
  int nodes = 0;        // of the law: how difficult it is
};

struct SuiteReferencePoint {
  std::string method;
  double seconds = 0;  // wall clock of a problem, theirs
  double recovered = 0;
  double low = 0;
  double high = 0;
};

struct SuiteInfo {
  std::string name;
  std::string summary;
  double recovered_below = 0;
  std::string reference_note;
  std::vector<SuiteProblemInfo> problems;
  std::vector<SuiteReferencePoint> references;
  std::vector<SuiteResult> results;
  std::string results_note;
};

std::string suites_json(const std::vector<SuiteInfo>& suites);
// Empty without the file; what is damaged is said in `complaints`.
std::vector<SuiteInfo> read_suites(const std::filesystem::path& file,
                                   std::vector<std::string>& complaints);

// A method with an operator set on a suite.
struct SuiteMethodRow {
  std::string method;
  std::string operators;
  std::size_t problems = 0;
  std::size_t cells = 0;
  std::size_t failed = 0;
  double recovered = 0;         // mean over problems of the share of seeds
  ConfidenceInterval interval;  // over problems, 95 %
  // Of the same: R2 on unseen rows of at least 0.999, 0.99, 0.9.
  std::array<double, 3> r2_at_least{};
  double r2_median = 0;
  double fit_cpu_s = 0;  // medians over cells
  double fit_wall_s = 0;
  double evaluations = 0;
  // By the size of the law: small, middle, large thirds of the suite's problems; NaN without laws.
  std::array<double, 3> recovered_by_size{};
};

struct SuiteView {
  SuiteInfo suite;
  std::vector<SuiteMethodRow> rows;       // the most recovered first
  std::array<int, 2> size_bounds{};       // the largest law of the first and the second third
  std::vector<std::string> never_solved;  // problems with cells, recovered by no method
  SuiteRanks ranks;
};

// Suites that the run has no record of are left out.
std::vector<SuiteView> view_suites(const std::vector<SuiteInfo>& suites,
                                   const std::vector<Record>& records);

// heading: of the suite ("###").
std::string suites_markdown(const std::vector<SuiteView>& views, std::string_view heading);
nlohmann::ordered_json suite_views_json(const std::vector<SuiteView>& views);

}  // namespace tribench
