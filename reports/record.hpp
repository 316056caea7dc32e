// SPDX-License-Identifier: MIT
//
// One row of results per cell, a failed cell's too; what the judge writes and every report reads.
// Torques are in the problem's torque unit (N m for A and B), times in s. A figure that does not
// exist is NaN, and an empty field in CSV.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace tribench {

inline constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

struct Record {
  // Which cell: the key names it everywhere.
  std::string cell;  // "A/j2/load|pysr|paper|1"
  std::string problem;
  std::string dataset;
  int joint = 0;
  bool load = false;
  std::string method;
  std::string operators;
  std::uint64_t seed = 0;

  // How it ended: "ok" or "failed", and why: timeout, cpu_limit, out_of_memory, crashed (SIGSEGV),
  // error (message), unsupported (message).
  std::string status;
  std::string reason;

  double mae_train = kMissing;
  double mae_test = kMissing;
  double rmse_test = kMissing;
  double max_error_test = kMissing;
  double r2_test = kMissing;
  double mae_truth = kMissing;             // against the noise-free law on the test rows
  double relative_error_train = kMissing;  // 100 |y - f| / |y|, 2-norms, percent
  double relative_error_test = kMissing;

  int complexity = 0;  // the paper's count
  int nodes = 0;
  int complexity_adaptation = 0;  // of the second stage alone, where there is one

  std::uint64_t evaluations = 0;  // node-rows
  double fit_cpu_s = kMissing;
  double fit_wall_s = kMissing;
  double peak_memory_mib = kMissing;
  double eval_ns_per_row = kMissing;

  std::string singularity;  // proved_free, refuted, undecided
  std::string witness;      // JSON object, or empty
  std::string formula;
  std::string note;
};

// One formula of a cell's front.
struct FrontRecord {
  std::string cell;
  int complexity = 0;
  int nodes = 0;
  double mae_train = kMissing;
  double mae_test = kMissing;
  std::string singularity;
  bool chosen = false;
  std::string formula;
};

// Best training error so far against what was spent.
struct TraceRecord {
  std::string cell;
  std::uint64_t evaluations = 0;
  double cpu_s = 0;
  double train_error = kMissing;
};

}  // namespace tribench
