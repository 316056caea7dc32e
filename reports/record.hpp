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
  double mae_truth = kMissing;           // against the noise-free law on the test rows
  double mae_ceiling = kMissing;         // of the noise-free target itself: the noise ceiling
  double mae_law = kMissing;             // of the true law, where it is a formula of the inputs
  double mae_refitted = kMissing;        // of the true law, its constants fitted to the same rows
  double mae_truth_refitted = kMissing;  // of that against the noise-free law
  // Mean absolute error of the simulated position on the test movements, rad or m, where the
  // problem declares what that needs and the formula moves the joint through all of them.
  double motion_error = kMissing;
  double relative_error_train = kMissing;  // 100 |y - f| / |y|, 2-norms, percent
  double relative_error_test = kMissing;

  int complexity = 0;  // the paper's count
  int nodes = 0;
  int complexity_adaptation = 0;  // of the second stage alone, where there is one

  std::uint64_t evaluations = 0;  // node-rows
  double fit_cpu_s = kMissing;
  double fit_wall_s = kMissing;
  double fit_instructions = kMissing;  // of the fit, where the kernel lets them be counted
  double peak_memory_mib = kMissing;
  double eval_ns_per_row = kMissing;

  std::string singularity;  // proved_free, refuted, undecided
  std::string witness;      // JSON object, or empty
  // Of a refuted formula: whether 2001 points on a grid over the box would have shown it, "seen" or
  // "missed".
  std::string grid_check;
  // Physics, of a formula that is proved free and has a velocity among its inputs: proved, refuted
  // or undecided. Dissipative: f v >= 0; monotone: f grows with v beyond a quarter of the largest
  // speed; odd: f(-v) = -f(v).
  std::string dissipative;
  std::string monotone;
  std::string odd;
  std::string formula;
  std::string note;
};

// Takes out what time and machine decide: two records of equal results are equal then.
void forget_costs(Record& record);

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

// A cell that the grid asks for; planned.csv lets a report say what is still missing.
struct PlannedCell {
  std::string cell;
  std::string problem;
  std::string method;
  std::string operators;
  std::uint64_t seed = 0;
};

// One point of a picture that belongs to a cell or, with an empty `cell`, to the problem itself
// (its data, its true law). Reports draw what they are given and know no problem; the harness
// samples the chosen formulas once per method and operator set (the seed with the median error)
// on up to about 200 points a curve.
//
//   picture  what the report draws: "friction" (x: velocity in rad/s, y: friction torque),
//            "error" (x: velocity, y: prediction minus measured, on test rows; thinned),
//            "profile" (x: time in s, y: torque along the sinusoidal velocity profile), or any
//            other name: drawn as lines over x
//   curve    the line it belongs to within the picture: "g = -20 N m", "true law", "measured", ...
//            a name that starts with "measured" is drawn as points, all others as lines
struct CurveRecord {
  std::string cell;
  std::string problem;
  std::string method;     // empty for the problem's own curves
  std::string operators;  // empty for the problem's own curves
  std::string picture;
  std::string curve;
  std::string x_name;  // axis titles with unit: "velocity in rad/s"
  std::string y_name;
  double x = kMissing;
  double y = kMissing;
};

// Best training error so far against what was spent.
struct TraceRecord {
  std::string cell;
  std::uint64_t evaluations = 0;
  double cpu_s = 0;
  double train_error = kMissing;
};

}  // namespace tribench
