// SPDX-License-Identifier: MIT
//
// Residual -> missing effect -> refit -> verdict: the procedure of the specification, section 4,
// from observations and a base model to findings. No files, no printing: loop_json.hpp writes it
// down.
//
// A movement of the test set is never looked at before the verdict stands.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/loop_model/loop_model.hpp"
#include "foundation/random.hpp"

namespace tribench::loop {

// Shorter movements are left out.
inline constexpr std::size_t kFewestRowsOfMovement = 5;

struct DiagnosisOptions {
  double alpha_library = 0.003;
  double alpha_leftover = 0.002;
  std::size_t flips = 1999;
  // The paper's own raw data hold seven at once: both branches, their curvature, three terms of the
  // load and two ripples.
  std::size_t max_effects = 8;
  double test_share = 0.2;  // of the movements; 0: no movements are held out
  // Empty: the usual ratios are scanned, and the scan is paid for in the statistics.
  std::vector<double> gear_ratios;
  bool physical_vetoes = true;
  bool resample = false;  // search again with movements left out: how sure each effect is
  bool ceiling = false;   // bound the noise too: what else could be had (ceiling.hpp)
  std::vector<EffectFamily> learned;  // families beside the built-in ones
  std::vector<std::string> families;  // to be tested; empty: all
  std::vector<std::string> without;   // rules left out, to see what they are worth (rules.hpp)
  // The searches without some movements run side by side, with the same answer; a base that is a
  // method takes one thread (its budget is one).
  int threads = 1;
  // Told after each search: how many have ended, of how many. Empty: nobody. From any thread, one
  // at a time.
  std::function<void(std::size_t, std::size_t)> progress;
  bool has(std::string_view rule) const { return std::ranges::count(without, rule) == 0; }
};

// cannot_tell: nothing could be tested, neither the library nor what is left over.
enum class Verdict { none, effects, unknown, cannot_tell };
// "NONE", "EFFECTS", "UNKNOWN", "CANNOT_TELL"
std::string_view verdict_name(Verdict verdict);

struct ParameterFinding {
  std::string name;
  double value = 0;
  double low = 0;  // 95 %
  double high = 0;
};

struct AliasFinding {
  std::string family;
  double correlation = 0;
  double gain_difference = 0;
  double error = 0;
  bool exact = false;
  std::string separate_by;
};

struct EffectFinding {
  std::string family;
  std::string phrase;
  std::string atom;  // its columns as written in the library
  int order = 0;     // 1 for the first found
  double adjusted_p = 1;
  double gain = 0;
  double gain_error = 0;
  std::vector<ParameterFinding> parameters;
  double rms_contribution = 0;
  double vif = 1;
  std::vector<AliasFinding> aliases;
  std::vector<std::string> separate_by;
  bool few_movements = false;  // carried by few movements: ask for more of them
  bool provisional = false;    // shares an input with the leftover, or is not physical
  std::string objection;       // why it is not physical; empty where it is
  // This cause, but a curve that the library does not have: more is left over in its own inputs.
  bool another_shape = false;
  // Share of the searches with some movements left out that choose it too; NaN where there are
  // none.
  double chosen_share = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::string> notes;
};

struct CurvePoint {
  double x = 0;
  double y = 0;
  double error = 0;
};

struct LeftoverFinding {
  double p = 1;
  std::vector<std::string> inputs;   // role names; empty where nothing is left
  std::vector<std::string> signals;  // the same as signals
  std::vector<std::string> proxies_removed;
  std::vector<CurvePoint> curve;  // over the one input
};

struct UntestableFinding {
  std::string family;
  std::string reason;
  double share = 0;
  std::size_t clusters = 0;
  std::string ask;
};

struct CoincidingFamilies {
  std::string first;
  std::string second;
  double correlation = 0;
  std::string separate_by;
};

// Largest correlation of any two columns of two families, given the base; 1 on the diagonal.
struct AliasMap {
  std::vector<std::string> families;
  Eigen::MatrixXd correlation;
};

struct EventFinding {
  int movement = 0;
  std::string movement_name;
  double begin = 0;  // s, or row where there is no time
  double end = 0;
  double peak = 0;  // in the target's unit
};

struct CandidateFinding {
  std::string family;
  std::string atom;
  double adjusted_p = 1;
  double score = 0;
  double gain = std::numeric_limits<double>::quiet_NaN();
  // The root mean square that it would have needed to be found nine times in ten, in the target's
  // unit.
  double detectable = std::numeric_limits<double>::quiet_NaN();
};

struct MovementError {
  int movement = 0;
  double before = 0;  // mean absolute error
  double after = 0;
  std::size_t rows = 0;
  double mean_before = 0;  // of the error with its sign
  double mean_after = 0;
};

enum class JudgedOn { other_movements, pieces_of_one_movement, rows_of_the_fit };

struct ErrorFinding {
  std::size_t test_movements = 0;
  JudgedOn judged_on = JudgedOn::other_movements;
  std::string how;  // in words: "held out", "each movement left out in turn"
  double mae_before = std::numeric_limits<double>::quiet_NaN();
  double mae_after = std::numeric_limits<double>::quiet_NaN();
  double rmse_before = std::numeric_limits<double>::quiet_NaN();
  double rmse_after = std::numeric_limits<double>::quiet_NaN();
  double max_before = std::numeric_limits<double>::quiet_NaN();
  double max_after = std::numeric_limits<double>::quiet_NaN();
  // Root mean square of the movements' mean errors: what noise within them does not hide.
  double means_before = std::numeric_limits<double>::quiet_NaN();
  double means_after = std::numeric_limits<double>::quiet_NaN();
  double difference_low = std::numeric_limits<double>::quiet_NaN();  // before - after, 95 %
  double difference_high = std::numeric_limits<double>::quiet_NaN();
  // Where asked for (DiagnosisOptions::ceiling): the noise lies between `ceiling`, which no model
  // does better than, and `attainable`, which a smooth one reaches; the share of the gap that was
  // closed between the two figures that follow from them, the first with its 95 % interval.
  double ceiling = std::numeric_limits<double>::quiet_NaN();
  double attainable = std::numeric_limits<double>::quiet_NaN();
  double closed_fraction = std::numeric_limits<double>::quiet_NaN();
  double closed_low = std::numeric_limits<double>::quiet_NaN();
  double closed_high = std::numeric_limits<double>::quiet_NaN();
  double closed_fraction_high = std::numeric_limits<double>::quiet_NaN();
  std::string ceiling_note;  // why a figure is missing
  std::vector<MovementError> movements;
  bool confirmed = true;  // the effects' improvement holds on the test movements
};

struct Diagnosis {
  Verdict verdict = Verdict::none;
  DiagnosisOptions options;
  std::uint64_t seed = 0;
  Noise noise;
  std::size_t rows = 0;
  std::size_t stretches = 0;
  std::size_t movements = 0;
  double correlation_rows = 1;  // how many rows the noise lasts
  std::vector<EffectFinding> effects;
  LeftoverFinding leftover;
  std::vector<UntestableFinding> untestable;
  std::vector<CoincidingFamilies> aliased;
  AliasMap alias_map;
  std::vector<EventFinding> events;
  ErrorFinding error;
  std::vector<CandidateFinding> candidates;  // of the first round
  std::vector<std::string> needed;           // where it cannot tell: what would be
  std::vector<std::string> notes;
  LoopModel before;  // fitted to the training movements
  LoopModel after;
  std::vector<int> test_movements;
  std::vector<char> masked;  // per row of the data: part of an event
  std::vector<EffectFamily> families;
};

// With forty movements or more a fifth of them is held out. With fewer, which leave too few to
// judge by, all take part in the verdict and the whole procedure is repeated with each movement (a
// tenth of them where movements and rows are many) left out in turn to judge it; a single movement
// is cut into five pieces for that. Deterministic
// given the seed. Cost: some tens of milliseconds for 6 000 rows. Throws Error (bad_input) where
// there are too few rows to fit the base.
Diagnosis diagnose(const Observations& data, const BaseMaker& base, const DiagnosisOptions& options,
                   std::uint64_t seed);

}  // namespace tribench::loop
