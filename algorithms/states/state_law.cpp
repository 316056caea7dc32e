// SPDX-License-Identifier: MIT
#include "algorithms/states/state_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "algorithms/expression/build.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/states/law_step.hpp"
#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "foundation/suggestion.hpp"

namespace tribench {
namespace states {

double exponential(double x) { return elementary::exp(x); }

float exponential(float x) {
  thread_local FloatEvaluator evaluator;
  static const Expression kExp = build::function(Op::exp, build::input(0));
  return evaluator.evaluate_at(kExp, std::span<const float>(&x, 1));
}

}  // namespace states

namespace {

using namespace states;

std::vector<StateLawInfo> make_laws() {
  const StateParameter stribeck = {"stribeck_velocity", "U/s"};
  return {
      {StateLaw::lag, "lag", "a channel through a first-order lag", 1, 1, {{"time_constant", "s"}}},
      {StateLaw::dahl, "dahl", "bristles that slide at one deflection", 1, 1, {{"sliding", "U"}}},
      {StateLaw::lugre,
       "lugre",
       "bristles that slide on a Stribeck curve",
       1,
       1,
       {{"sliding", "U"}, {"breakaway", "U"}, stribeck}},
      {StateLaw::slip, "slip", "a Maxwell-slip element", 1, 1, {{"limit", "U"}}},
      {StateLaw::gms,
       "gms",
       "a generalised Maxwell-slip element",
       1,
       1,
       {{"limit", "U"}, {"breakaway", "U"}, stribeck, {"attraction", "s"}}},
      {StateLaw::backlash,
       "backlash",
       "where a gear stands in its play, pushed by its load",
       2,
       2,
       {{"half_gap", "U"}, {"drift", "U/s per unit of load", true}}},
      {StateLaw::warmth, "warmth", "temperature as lagged power", 1, 2, {{"time_constant", "s"}}},
  };
}

}  // namespace

const std::vector<StateLawInfo>& state_laws() {
  static const std::vector<StateLawInfo> kLaws = make_laws();
  return kLaws;
}

const StateLawInfo& state_law_info(StateLaw law) {
  return state_laws().at(static_cast<std::size_t>(law));
}

StateLaw find_state_law(std::string_view name, std::string_view place) {
  std::vector<std::string> names;
  for (const StateLawInfo& info : state_laws()) {
    if (info.name == name) return info.law;
    names.push_back(info.name);
  }
  throw_bad_input(fmt::format("there is no state law '{}'", name), std::string(place),
                  did_you_mean(name, names));
}

void check_state(const StateDeclaration& state, std::size_t inputs) {
  const StateLawInfo& law = state_law_info(state.law);
  if (state.drives.size() < law.least_drives || state.drives.size() > law.most_drives) {
    throw_bad_input(fmt::format("'{}' is driven by {} inputs here", law.name, state.drives.size()),
                    state.name,
                    law.least_drives == law.most_drives
                        ? fmt::format("name {}", law.most_drives)
                        : fmt::format("name {} or {}", law.least_drives, law.most_drives));
  }
  for (const std::size_t drive : state.drives) {
    if (drive >= inputs) throw_bad_input("it is driven by no input", state.name, "name an input");
  }
  if (state.parameters.size() != law.parameters.size()) {
    throw_bad_input(fmt::format("'{}' has {} parameters, {} are given", law.name,
                                law.parameters.size(), state.parameters.size()),
                    state.name, "give each once");
  }
  for (std::size_t k = 0; k < law.parameters.size(); ++k) {
    const double value = state.parameters[k];
    if (std::isfinite(value) && (law.parameters[k].may_be_any || value > 0)) continue;
    throw_bad_input(
        fmt::format("{} is {}", law.parameters[k].name, value), state.name,
        law.parameters[k].may_be_any ? "give a finite number" : "give a number above 0");
  }
}

template <typename T>
BasicStateMemory<T> state_at_rest(StateLaw law, const BasicDrive<T>& drive) {
  return {law == StateLaw::lag ? drive.velocity : T(0), false};
}

template <typename T>
void advance(StateLaw law, std::span<const T> p, BasicStateMemory<T>& memory,
             const BasicDrive<T>& from, const BasicDrive<T>& to, T dt) {
  advance_by_law(law, p, memory, from, to, dt);
}

template StateMemory state_at_rest(StateLaw, const StateDrive&);
template BasicStateMemory<float> state_at_rest(StateLaw, const BasicDrive<float>&);
template void advance(StateLaw, std::span<const double>, StateMemory&, const StateDrive&,
                      const StateDrive&, double);
template void advance(StateLaw, std::span<const float>, BasicStateMemory<float>&,
                      const BasicDrive<float>&, const BasicDrive<float>&, float);

double state_rate(StateLaw law, std::span<const double> p, const StateMemory& memory,
                  const StateDrive& drive) {
  const double v = drive.velocity;
  const double z = memory.z;
  const auto while_held = [z](double rate, double limit) {
    return std::abs(z) >= limit && z * rate > 0 ? 0 : rate;
  };
  switch (law) {
    case StateLaw::lag:
      return (v - z) / p[0];
    case StateLaw::warmth:
      return (power_of(drive) - z) / p[0];
    case StateLaw::dahl:
      return v - std::abs(v) * z / p[0];
    case StateLaw::lugre:
      return v - std::abs(v) * z / sliding_curve(p[0], p[1], p[2], v);
    case StateLaw::slip:
      return while_held(v, p[0]);
    case StateLaw::backlash:
      return while_held(v + p[1] * drive.load, p[0]);
    case StateLaw::gms: {
      const double level = sliding_curve(p[0], p[1], p[2], v);
      const bool slips = z * v >= 0 && (memory.slips || std::abs(z) >= level);
      return slips ? (level * sign_of(v) - z) * p[0] / (level * p[3]) : v;
    }
  }
  return 0;
}

StateRange state_range(StateLaw law, std::span<const double> p,
                       std::span<const StateRange> drives) {
  const auto largest = [](const StateRange& range) {
    return std::max(std::abs(range.low), std::abs(range.high));
  };
  switch (law) {
    case StateLaw::lag:
      return drives[0];
    case StateLaw::warmth: {
      double power = 1;
      for (const StateRange& drive : drives) power *= largest(drive);
      return {0, power};
    }
    case StateLaw::lugre:
    case StateLaw::gms: {
      const double most = std::max(p[0], p[1]);
      return {-most, most};
    }
    default:
      return {-p[0], p[0]};
  }
}

}  // namespace tribench
