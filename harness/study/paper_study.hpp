// SPDX-License-Identifier: MIT
//
// A finished run beside the paper's three tables: each method's error and its spread over the
// seeds, the paper's figure where it has one, and the noise ceiling, which no formula over the
// permitted inputs goes far below. Differences with a known cause are said in words.
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace tribench {

struct PaperRow {
  std::string method;
  std::string operators;
  std::size_t seeds = 0;   // that gave a formula
  std::size_t failed = 0;  // cells that did not
  double mae_nm = 0;       // median over the seeds, test movements
  double low_nm = 0;
  double high_nm = 0;
  double complexity = 0;     // median; of the adaptation alone where there is one
  std::size_t singular = 0;  // formulas refuted
  double paper_mae_nm = std::numeric_limits<double>::quiet_NaN();
  int paper_complexity = 0;  // 0 where the paper has no such row
};

struct PaperProblem {
  int table = 0;
  std::string name;
  // Mean |target - truth| on the test movements, median over the run's seeds: noise, ripple and
  // whatever no permitted input shows.
  double ceiling_nm = 0;
  std::vector<PaperRow> rows;  // by error
  std::vector<std::string> remarks;
};

// From DIR/results.csv; problems in the paper's order, those the run has no cell of left out, with
// "unadapted" problems under Table 3. Throws Error (bad_input) where there is none at all.
std::vector<PaperProblem> run_paper_study(const std::filesystem::path& run);

std::string paper_study_markdown(const std::vector<PaperProblem>& problems);

}  // namespace tribench
