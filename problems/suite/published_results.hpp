// SPDX-License-Identifier: MIT
//
// What others reached on the tables of a suite: one figure a table and method, from a file of
// theirs (SRBench's, say), which is no part of the project. Shares of laws recovered stand in the
// suite itself (SuiteReference), errors of friction models in reports/published.hpp.
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace tribench::suite {

// Where they stand: a CSV file with the columns `dataset` and `method`, and those named here.
struct PublishedTable {
  std::string file;  // in the folder of data; empty: nothing is published
  std::string r2 = "r2";
  std::string seconds;   // of a fit; empty: not told
  std::string symbolic;  // 0: a method that gives no formula; empty: all give one
  std::string where;     // COLUMN=VALUE: these lines alone
  std::string note;      // how to read them
};

struct PublishedResult {
  std::string dataset;
  std::string method;
  bool symbolic = true;
  double r2 = 0;  // on unseen rows
  double seconds = std::numeric_limits<double>::quiet_NaN();
};

// In the file's order; lines without a figure are left out. Throws Error (bad_input) with file and
// line: a column is missing, a cell is no number, a table and method occur twice.
std::vector<PublishedResult> read_published_results(const PublishedTable& table,
                                                    const std::filesystem::path& data);

}  // namespace tribench::suite
