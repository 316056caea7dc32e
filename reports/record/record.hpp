// SPDX-License-Identifier: MIT
//
// One row of results per cell, a failed cell's too; what the judge writes and every report reads.
// Torques are in the problem's torque unit (N m for A and B), times in s. A figure that does not
// exist is NaN, a judgement that was not made is no value; both are empty fields in CSV. The names
// of the columns, and how each is written, are in record_columns.hpp.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tribench {

inline constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

enum class CellStatus : std::uint8_t { failed, ok };

// Why a cell failed. `other`: a reason that this program does not write, kept as it was read.
enum class FailureKind : std::uint8_t {
  none,
  timeout,
  cpu_limit,
  out_of_memory,
  crashed,
  error,
  unsupported,
  quarantined,
  other
};

struct FailureReason {
  FailureKind kind = FailureKind::none;
  std::string detail;  // the signal of a crash, the message of an error

  bool operator==(const FailureReason&) const = default;
};

// Failures that depend on the machine's pace and memory as well as on the code.
bool is_limit(FailureKind kind);

// Whether the formula has a finite value everywhere in its input box.
enum class Singularity : std::uint8_t { proved_free, refuted, undecided };
// Whether a physical property holds everywhere in the box.
enum class PhysicsProof : std::uint8_t { proved, refuted, undecided };
// Whether 2001 points on a grid over the box would have shown a singularity.
enum class GridCheck : std::uint8_t { seen, missed };

// The words of the files, those of the enumerators; "" for no value.
std::string_view record_word(std::optional<CellStatus> value);
std::string_view record_word(std::optional<Singularity> value);
std::string_view record_word(std::optional<PhysicsProof> value);
std::string_view record_word(std::optional<GridCheck> value);

// The reverse; false, and `value` untouched, where the text is no such word. "" is no value.
bool read_record_word(std::string_view text, std::optional<CellStatus>& value);
bool read_record_word(std::string_view text, std::optional<Singularity>& value);
bool read_record_word(std::string_view text, std::optional<PhysicsProof>& value);
bool read_record_word(std::string_view text, std::optional<GridCheck>& value);

// "timeout", "crashed (SIGSEGV)", "error (no formula: ...)"; "" for none. Reading accepts any text
// and loses nothing of it: reason_text(read_reason(text)) == text.
std::string reason_text(const FailureReason& reason);
FailureReason read_reason(std::string_view text);

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

  // How it ended; no value until the cell has run.
  std::optional<CellStatus> status;
  FailureReason reason;

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

  std::optional<Singularity> singularity;
  std::string witness;  // JSON object, or empty
  // Of a refuted formula.
  std::optional<GridCheck> grid_check;
  // Physics, of a formula that is proved free and has a velocity among its inputs. Dissipative: f v
  // >= 0; monotone: f grows with v beyond a quarter of the largest speed; odd: f(-v) = -f(v).
  std::optional<PhysicsProof> dissipative;
  std::optional<PhysicsProof> monotone;
  std::optional<PhysicsProof> odd;
  std::string formula;
  std::string note;
};

inline bool is_ok(const Record& record) { return record.status == CellStatus::ok; }
// What a cell is placed by: its error on test rows to ten digits, 0 where it is rounding alone
// (below 1e-12 of the target), infinity where there is none.
double placing_error(const Record& record);
void mark_failed(Record& record, FailureKind kind, std::string detail = {});

// A fit that the clock ended cannot be repeated; the record's note says so.
void note_end_by_clock(Record& record);

// Of a further search for the same record: seconds, evaluations, instructions, the larger memory,
// and that the clock ended it.
void add_costs(Record& record, const Record& further);
bool was_ended_by_clock(const Record& record);
// Where the fit took more than its budget, by more than a tenth (and half a second), the note says
// how much of how much: beside others that kept to theirs its figures are no fair ones.
void note_overspending(Record& record, double seconds, std::uint64_t evaluations);

// Takes out what time and machine decide: two records of equal results are equal then.
void forget_costs(Record& record);

// One formula of a cell's front.
struct FrontRecord {
  std::string cell;
  int complexity = 0;
  int nodes = 0;
  double mae_train = kMissing;
  double mae_test = kMissing;
  std::optional<Singularity> singularity;
  bool chosen = false;
  std::string formula;
  double weighted_rms = kMissing;  // of the rows that were fitted, where they were weighted
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
