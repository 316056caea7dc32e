// SPDX-License-Identifier: MIT
//
// How often the methods of a finished run found the law of the noise-free problems exactly, beside
// what was published: the table of the Nguyen set.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "reports/record/record.hpp"

namespace tribench {

struct RecoveryFigure {
  std::string problem;
  std::string method;
  std::string operators;
  std::uint64_t recovered = 0;
  std::uint64_t runs = 0;  // failed ones too
  double median_cpu_s = 0;
};

// Recovered means a normalised mean squared error below 1e-12 on noise-free rows that were not
// fitted (the success criterion of the public deep-symbolic-optimization code).
bool is_recovered(const Record& record);

// From the run's results.csv: the problems of the Nguyen set, by method, operator set and number.
// Throws Error (bad_input) where there are none.
std::vector<RecoveryFigure> run_recovery_study(const std::filesystem::path& run);

// Published recovery of Nguyen 1 to 12 in percent without a linear token (DSR: Petersen et al.
// 2021, table 1), and the published mean of RNN + GP (Mundhenk et al. 2021).
inline constexpr int kPublishedDsr[12] = {100, 100, 100, 100, 72, 100, 35, 96, 100, 100, 100, 0};
inline constexpr double kPublishedRnnGp = 92;

}  // namespace tribench
