// SPDX-License-Identifier: MIT
//
// States: what friction remembers of the motion, each a channel z that obeys a declared first-order
// law. A formula reads a state like an input; whoever fits, judges, proves, simulates or exports it
// takes the law from here and nowhere else.
//
// v is the first drive (a velocity, unit U/s), l the second (a load, optional); bristle laws keep a
// deflection in U (m, rad), so that its coefficient in a formula is a stiffness.
//
//   lag(x, time_constant)          z' = (x - z) / T
//   dahl(v, sliding)               z' = v - |v| z / d                                  Dahl 1968
//   lugre(v, sliding, breakaway, stribeck_velocity)
//                                  z' = v - |v| z / g(v),                   Canudas de Wit 1995 (1)
//                                  g = sliding + (breakaway - sliding) exp(-(v/vs)^2)
//   slip(v, limit)                 z' = v, held at |z| <= limit: a Maxwell element, Iwan 1966
//   gms(v, limit, breakaway, stribeck_velocity, attraction)
//                                  z' = v while it sticks; once |z| >= L(v) it slips,
//                                  z' = (L(v) sgn v - z) limit / (L(v) T), until v turns;
//                                  L as g above                     Al-Bender et al. 2005 (19),
//                                  (20)
//   backlash(v, l, half_gap, drift) z' = v + c l, held at |z| <= half_gap: where a gear's flank
//                                  stands in its play; the load pushes it to one side
//   warmth(v[, l], time_constant)  z' = (|v l| - z) / T (|v| without l): temperature from
//   dissipated
//                                  power, up to a factor
//
// Integration: drives run linearly over a step. lag is exact for that (warmth: for a power that
// does), the others are exact for the displacement; a step in which v turns is cut there, g and L
// are taken at the mean speed of each part (exact where v is constant, second order where not).
// Stable for every step, however long: |z| never exceeds state_range, in double and in float alike.
//
// NaN in a drive or in time makes the state NaN from there on: leave such rows out before.
// Deterministic (foundation/elementary). Thread-safe: no state but the caller's memory.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tribench {

enum class StateLaw { lag, dahl, lugre, slip, gms, backlash, warmth };

struct StateParameter {
  std::string name;
  std::string unit;         // "s", "U" (that of the velocity times s), "U/s", ...
  bool may_be_any = false;  // else above 0
};

struct StateLawInfo {
  StateLaw law;
  std::string name;
  std::string summary;
  std::size_t least_drives = 1;
  std::size_t most_drives = 1;
  std::vector<StateParameter> parameters;
};

const std::vector<StateLawInfo>& state_laws();  // in the order of the enumeration
const StateLawInfo& state_law_info(StateLaw law);
// Throws Error (bad_input) at `place` with the nearest name.
StateLaw find_state_law(std::string_view name, std::string_view place = {});

// A state of a formula: which law, which columns drive it, its parameters in the law's order.
struct StateDeclaration {
  std::string name;  // as the formula calls it
  StateLaw law = StateLaw::lag;
  std::vector<std::size_t> drives;  // places among the inputs
  std::vector<double> parameters;

  bool operator==(const StateDeclaration&) const = default;
};

// Throws Error (bad_input) at the state's name where drives or parameters are too many or too few,
// a drive is none of `inputs` columns, or a parameter is not finite or (most laws) not above 0.
void check_state(const StateDeclaration& state, std::size_t inputs);

// The two ends of a step, or one end: the drives' values.
template <typename T>
struct BasicDrive {
  T velocity = 0;  // or whatever the law's first drive is
  T load = 1;      // 1 where the law has no second drive
};
using StateDrive = BasicDrive<double>;

// What a state carries from step to step.
template <typename T>
struct BasicStateMemory {
  T z = 0;
  bool slips = false;  // gms alone
};
using StateMemory = BasicStateMemory<double>;

// At the start of a movement. The state there is not known; it is taken to be at rest: bristles
// relaxed, a lag settled at its drive, warmth cold. `start_influence` (state_column.hpp) says how
// long that shows.
template <typename T>
BasicStateMemory<T> state_at_rest(StateLaw law, const BasicDrive<T>& drive);

// One step of dt >= 0 seconds over which the drives run linearly from one end to the other. For one
// with constant drives give them twice. About 10 ns; columns are faster (state_column.hpp).
template <typename T>
void advance(StateLaw law, std::span<const T> parameters, BasicStateMemory<T>& memory,
             const BasicDrive<T>& from, const BasicDrive<T>& to, T dt);

extern template StateMemory state_at_rest(StateLaw, const StateDrive&);
extern template BasicStateMemory<float> state_at_rest(StateLaw, const BasicDrive<float>&);
extern template void advance(StateLaw, std::span<const double>, StateMemory&, const StateDrive&,
                             const StateDrive&, double);
extern template void advance(StateLaw, std::span<const float>, BasicStateMemory<float>&,
                             const BasicDrive<float>&, const BasicDrive<float>&, float);

// z' at a point; for who integrates states together with a motion by a solver of its own. gms and
// the held laws are discontinuous: `advance` steps over that, a solver must step to it.
double state_rate(StateLaw law, std::span<const double> parameters, const StateMemory& memory,
                  const StateDrive& drive);

struct StateRange {
  double low = 0;
  double high = 0;
};
// Where z stays for ever, from rest on, while the drives stay in their ranges (one for each drive
// of the law). For bristles |z| <= max g: Canudas de Wit et al. 1995, property 1.
StateRange state_range(StateLaw law, std::span<const double> parameters,
                       std::span<const StateRange> drives);

}  // namespace tribench
