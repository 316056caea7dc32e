// SPDX-License-Identifier: MIT
//
// What a closed loop found, for everything that is written about it: loop.json (loop_json.hpp), the
// sentences (reports/loop_words.hpp), loop.md, the terminal and the page. The harness fills it from
// the diagnosis; nothing is computed from it that the diagnosis has not decided.
//
// A figure that does not exist is NaN, a text that does not exist is empty. Torques are in `unit`,
// everything else in the unit beside it. Families are named as in loop.json ("load_coulomb"); what
// people read is in `families`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "reports/record/loop_pictures.hpp"

namespace tribench {

// cannot_tell: nothing could be tested, neither the known effects nor what is left over; or (there
// are candidates then) something is there that too few movements show.
enum class LoopVerdict { none, effects, unknown, cannot_tell };
// "NONE", "EFFECTS", "UNKNOWN", "CANNOT_TELL"
std::string_view loop_verdict_name(LoopVerdict verdict);

inline constexpr double kNoFigure = std::numeric_limits<double>::quiet_NaN();

// A family of effects in words.
struct LoopFamily {
  std::string name;    // "load_coulomb"
  std::string title;   // a noun: "load-dependent Coulomb friction"
  std::string phrase;  // a sentence's inside: "Coulomb friction grows with the load"
};

// A movement that would settle something, by its short code.
struct LoopExperiment {
  std::string code;  // "R3"
  std::string text;  // "use two postures or a known payload"
};

struct LoopParameter {
  std::string name;
  double value = kNoFigure;
  double low = kNoFigure;  // 95 %
  double high = kNoFigure;
};

struct LoopAlias {
  std::string family;
  double correlation = kNoFigure;
  double gain_difference = kNoFigure;
  double error = kNoFigure;
  bool exact = false;  // the same column, whatever the data
  std::string separate_by;
};

// Of the searches on parts of the data: what fewer of them choose is not named.
// Stability selection takes 0.6 to 0.9 (Meinshausen, Buehlmann 2010).
inline constexpr double kStableShare = 0.6;

// Presliding as bristles whose deflection is a state: what has units of its own.
struct LoopBristles {
  std::string law;                   // "dahl", "lugre", "maxwell_slip"; empty: none were fitted
  double stiffness = kNoFigure;      // of relaxed bristles
  double stiffness_low = kNoFigure;  // 95 %
  double stiffness_high = kNoFigure;
  std::string stiffness_unit;  // "N m/rad"
  double sliding = kNoFigure;  // deflection from which on they slide: break-away
  std::string sliding_unit;
  double damping = kNoFigure;    // of lugre, in the target's unit over the velocity's
  double mae_after = kNoFigure;  // as LoopError::mae_after, with the state in the effect's place
  std::string formula;           // of the whole model, its states declared before it
};

struct LoopEffect {
  std::string family;
  std::string atom;  // its columns as the library writes them
  int order = 0;     // 1 for the first found
  double adjusted_p = kNoFigure;
  double gain = kNoFigure;  // nats, on movements left out
  double gain_error = kNoFigure;
  std::vector<LoopParameter> parameters;
  double rms = kNoFigure;
  double vif = kNoFigure;
  std::vector<LoopAlias> aliases;
  std::vector<std::string> separate_by;  // codes
  bool provisional = false;
  std::string objection;  // why it is not physical
  bool few_movements = false;
  bool told_by_others = false;  // the other effects can tell nine tenths of it
  bool another_shape = false;
  double chosen_share = kNoFigure;  // of the searches with movements left out
  std::vector<std::string> notes;
  LoopBristles bristles;
};

// A term whose coefficient differs from movement to movement though no column says why.
struct LoopVarying {
  struct OfMovement {
    std::string movement;
    double torque = 0;  // of its own part: root mean square, with a sign where there is one
  };
  // "coulomb_friction", "viscous_friction" or a family; empty: none. Without inputs it is a doubt.
  std::string term;
  double share = kNoFigure;  // of what is left: what it foretells in other parts of a movement
  std::vector<OfMovement> movements;
};

struct LoopLeftover {
  double p = kNoFigure;
  // Role names, or "movement" (varying); empty where nothing is left.
  std::vector<std::string> inputs;
  std::vector<std::string> proxies_removed;
  double chosen_share = kNoFigure;  // of the searches with movements left out
  struct Point {
    double x = 0;
    double y = 0;
    double error = 0;
  };
  std::vector<Point> curve;  // over the one input
  LoopVarying varying;
};

struct LoopUntestable {
  std::string family;
  std::string reason;
  double share = kNoFigure;
  std::size_t stretches = 0;
  std::string ask;  // a code
};

struct LoopCoincidence {
  std::string first;  // families that these data cannot tell apart
  std::string second;
  double correlation = kNoFigure;
  std::string separate_by;
};

struct LoopBurst {
  int movement = 0;
  std::string movement_name;
  double begin = kNoFigure;  // s, or row
  double end = kNoFigure;
  double peak = kNoFigure;
};

struct LoopCandidate {
  std::string family;
  std::string atom;
  double adjusted_p = kNoFigure;
  double score = kNoFigure;
  double gain = kNoFigure;
  double detectable = kNoFigure;  // rms from which on it would have been found
};

struct LoopMovementError {
  int movement = 0;
  double before = kNoFigure;
  double after = kNoFigure;
  std::size_t rows = 0;
};

// Mean absolute error of the simulated position, so many seconds ahead of where it was measured.
struct LoopMotion {
  double before = kNoFigure;
  double after = kNoFigure;
  std::string unit;
  double horizon_s = kNoFigure;
  bool held_out = false;  // on test movements; else on those of the fit
};

// Mean absolute errors on what took no part in the fit, before and after.
enum class LoopJudgedOn { other_movements, pieces_of_movements, rows_of_the_fit };

struct LoopError {
  std::size_t test_movements = 0;
  LoopJudgedOn judged_on = LoopJudgedOn::other_movements;
  std::string how;  // in words: "held out", "each movement left out in turn"
  double mae_before = kNoFigure;
  double mae_after = kNoFigure;
  double rmse_before = kNoFigure;
  double rmse_after = kNoFigure;
  double max_before = kNoFigure;
  double max_after = kNoFigure;
  double difference_low = kNoFigure;  // of before - after, 95 %
  double difference_high = kNoFigure;
  double ceiling = kNoFigure;     // the noise at least: no model does better
  double attainable = kNoFigure;  // the noise at most: a smooth model of these inputs gets there
  double closed_fraction = kNoFigure;
  double closed_low = kNoFigure;
  double closed_high = kNoFigure;
  double closed_fraction_high = kNoFigure;
  std::string ceiling_note;  // why a figure is missing
  bool confirmed = true;
  double means_before = kNoFigure;  // rms of the movements' mean errors
  double means_after = kNoFigure;
  std::vector<LoopMovementError> movements;
};

struct LoopNoise {
  double within_sd = kNoFigure;
  double between_sd = kNoFigure;
  double rho = kNoFigure;
  std::size_t rows = 0;
  std::size_t movements = 0;
  std::size_t stretches = 0;
  double effective_rows = kNoFigure;
};

struct LoopLearned {
  std::string family;
  std::string formula;
  double p = kNoFigure;
  double gain = kNoFigure;
  std::size_t found_on = 0;
  std::size_t tested_on = 0;
  bool accepted = false;
};

struct LoopNextMovement {
  std::string kind;
  double velocity = kNoFigure;
  double from = kNoFigure;
  double to = kNoFigure;
  double load_factor = kNoFigure;
  double duration = kNoFigure;
  struct Tone {
    double amplitude = 0;
    double frequency = 0;
  };
  std::vector<Tone> tones;
  double separation = kNoFigure;
  std::string between;
};

// A symbol of the formulas.
struct LoopSymbol {
  std::string name;    // "v"
  std::string column;  // of the data; empty where it is computed
  std::string unit;
  std::string meaning;     // "velocity"
  std::string recipe;      // how it is computed
  bool used = false;       // by the model
  double low = kNoFigure;  // in the rows used: where the model has been seen
  double high = kNoFigure;
  std::string formula = {};  // over q, where that says it: "sin(q)"
};

// A part of the model: the base or one effect.
struct LoopTerm {
  std::string family;   // empty: the base
  std::string formula;  // constants folded and rounded to four digits; for reading
};

// What became of the rows, in order.
struct LoopDataStep {
  std::string what;
  std::size_t rows = 0;  // that were left
  // Of rows in motion that were left out: why nobody looked there. Empty: there are none.
  std::string not_looked_at;
};

// A column without a role, and how much of what is left over a smooth function of it explains.
struct LoopUnusedColumn {
  std::string column;
  double share = kNoFigure;
};

struct LoopRecord {
  std::string title;  // the data's name
  LoopVerdict verdict = LoopVerdict::none;
  std::string target;
  std::string unit;
  double alpha_library = kNoFigure;
  double alpha_leftover = kNoFigure;
  std::size_t flips = 0;
  std::uint64_t seed = 0;
  LoopNoise noise;
  double friction_rms = kNoFigure;  // of the friction itself, the rigid body's part taken off
  std::vector<LoopEffect> effects;
  LoopLeftover leftover;
  std::vector<LoopUntestable> untestable;
  std::vector<LoopCoincidence> aliased;
  std::vector<LoopBurst> bursts;
  std::vector<LoopCandidate> candidates;
  double shortest_wave = kNoFigure;  // that was looked for unless its ratio was told
  std::string shortest_wave_unit;    // "rad" or "m"
  std::vector<std::string> needed;   // where it cannot tell: what would be
  std::vector<LoopUnusedColumn> unused_columns;
  LoopError error;
  LoopMotion motion;
  std::string base;
  std::string base_formula;
  std::string formula;
  std::vector<LoopTerm> terms;
  std::vector<LoopSymbol> symbols;
  std::string code;  // the model in C
  std::vector<std::string> notes;
  std::vector<std::string> warnings;
  std::vector<LoopDataStep> steps;
  std::vector<LoopLearned> learned;
  std::vector<LoopNextMovement> next_movements;
  LoopPictures pictures;
  std::vector<LoopFamily> families;
  std::vector<LoopExperiment> experiments;
};

}  // namespace tribench
