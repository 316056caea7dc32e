// SPDX-License-Identifier: MIT
//
// The effects the loop knows, as data: a family is a physical cause; its atoms are columns written
// as formulas over signals (observations.hpp) and shape parameters, on a grid of shapes. Adding an
// effect is adding an entry (or a file: --save-effect writes one, `read_effects` reads it back);
// no code knows a family by name.
//
//   column "sgn_v*exp(-(abs(v)/vs)^delta)", shapes vs (scale v) and delta
//
// Shapes are multiples of a signal's scale (its 99 % quantile of |x|, or its span for q and d), so
// that one library serves a joint in rad/s and a screw in m/s.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/expression/expression.hpp"
#include "problems/preparation/observations.hpp"

namespace tribench::loop {

// Where a shape has its values from: its own grid, or the gear ratios that are given or usual.
enum class ShapeValues { grid, gear_ratios };

struct ShapeTemplate {
  std::string name;
  std::string scale;  // signal whose scale multiplies grid, low and high; "g/a", "1/q"; empty: 1
  std::vector<double> grid;  // one atom for each value (the product over all shapes)
  double low = 0;            // bounds of the refinement; low == high: not refined
  double high = 0;
  // No smaller than the smallest |signal| of the rows: an effect that has faded before the slowest
  // row shows its tail alone, and a size at 0 made of a tail is worth nothing.
  bool recorded = false;
  // Its one value is the mean of the signal `scale`: the place on an axis whose origin says nothing
  // (a temperature, a time).
  bool reference = false;
  // Gear ratios are taken as they are: no scale, not refined, and they exclude one another.
  ShapeValues values = ShapeValues::grid;
};

// What tells an atom from one of another family that can draw the same curve: beside Coulomb and
// viscous friction sgn(v) exp(-|v|/v0) may be Stribeck or viscous friction that is not proportional
// to speed. Of friction against speed, with the base.
enum class SpeedCurve { any, falls, rises };

// Whether there is less friction somewhere than at the slowest row, in one direction. A row each.
bool falls_with_speed(std::span<const double> friction, std::span<const double> v);

struct AtomTemplate {
  std::vector<std::string> columns;
  std::vector<std::string> coefficients;  // names of the columns' coefficients, for the report
  std::vector<ShapeTemplate> shapes = {};
  // Only beside another atom of the family: what an effect that is there may have besides
  // (harmonics, a phase that drifts).
  bool beside_another = false;
  // The same, and only in motion both ways: what differs by direction (a sense forwards only is one
  // half of each).
  bool by_direction = false;
  // What there is in one direction alone: only in motion both ways, else it is the whole effect.
  bool one_way = false;
  // Rare, and looked for only where the others leave something over: beside them it would make each
  // of them harder to find.
  bool last_resort = false;
  // Only where no inertia is fitted with the base: what a part of it is next to.
  bool without_inertia = false;
  SpeedCurve curve = SpeedCurve::any;
};

// What a coefficient must satisfy to be physical; a finding that does not is demoted to UNKNOWN.
struct Sanity {
  std::string coefficient;  // of an atom; applies wherever an atom has it
  int sign = 0;             // +1, -1: required sign; 0: any
  double largest = 0;       // largest magnitude; 0: any
  std::string why;
};

// A cause that has the same column as this one, whatever the data.
struct KnownAlias {
  std::string name;
  std::string separate_by;        // R1 ... R9 and what to do
  std::string coefficient = {};   // only of atoms that have it; empty: of all
  std::string unless_known = {};  // a signal that would tell the two apart; empty: none does
};

struct EffectFamily {
  std::string name;     // "stribeck"
  std::string id;       // of the specification's table: "E1"
  std::string summary;  // one line
  std::string phrase;   // "friction falls with speed from standstill (Stribeck)"
  std::string source;
  std::vector<AtomTemplate> atoms;
  std::vector<Sanity> sanity = {};
  std::vector<KnownAlias> known_aliases = {};
  std::vector<std::string> separate_by = {};  // experiments: "R3", ...
  bool angular = false;     // makes sense for an angle only, not for a position in m
  bool changeable = false;  // may differ from movement to movement and leave no trace in any signal
  std::string origin = {};  // of a learned effect: the movements it was found on, as text
  std::string title = {};   // a short noun for tables and cards; empty: the name
  std::string first_experiment() const { return separate_by.empty() ? "" : separate_by[0]; }
};

// What the name of an effect begins with that a method has grown from data.
inline constexpr std::string_view kLearnedPrefix = "learned:";

// The built-in families, in the order in which they are listed.
const std::vector<EffectFamily>& builtin_effects();
std::vector<std::string> builtin_effect_names();

// What R1 ... R9 ask for, in words.
std::string experiment_text(std::string_view rule);

// A TOML file with [[effect]] tables, as --save-effect writes it; what is written is read back to
// the same families. examples/effects/ holds one made by hand. Throws Error (bad_input).
std::vector<EffectFamily> read_effects(const std::filesystem::path& file);
std::string write_effects(std::span<const EffectFamily> effects);

// A shape parameter in place: the constants of the columns that hold it.
struct Shape {
  struct Place {
    std::size_t column;
    std::size_t node;
  };
  std::string name;
  double value = 0;
  double low = 0;
  double high = 0;
  std::vector<Place> places;
  ShapeValues values = ShapeValues::grid;
  bool refined() const { return high > low; }
};

// Waves a turn of the output, of its own ripples: what repeats more often is the gear's.
inline constexpr int kMostWavesOfOutput = 8;

// The shape of a load that holds the inertia behind the gear: g + J*a.
inline constexpr std::string_view kInertiaInLoad = "J";

// Columns with definite shapes, over the signals of one data set.
struct Atom {
  std::size_t family = 0;
  std::string label;  // its columns as text, shapes in place
  std::vector<Expression> columns;
  std::vector<std::string> coefficients;
  std::vector<Shape> shapes;
  bool beside_another = false;
  bool one_way = false;
  bool last_resort = false;
  bool without_inertia = false;
  SpeedCurve curve = SpeedCurve::any;

  void set_shape(std::size_t shape, double value);
};

// Turns of the motor for one of the joint, or rad of the motor for a metre where the position is in
// m: those given, else the usual ones. Of a screw the preferred leads of ISO 3408-2 (2.5 to 40 mm).
std::vector<double> gear_ratios_for(const Observations& data, std::span<const double> given);

// All atoms of a family that these data have the signals for; empty where none.
// missing: receives what is not there (of the least demanding atom), in words: "no temperature",
// "temperature: it is constant".
std::vector<Atom> instantiate(const EffectFamily& family, std::size_t number,
                              const Observations& data, std::span<const double> gear_ratios,
                              std::vector<std::string>& missing);

// The scale of a signal: what 1 % of |x| exceed; span between 1 % and 99 % of q, T, t and d.
double signal_scale(const Observations& data, std::string_view name);

}  // namespace tribench::loop
