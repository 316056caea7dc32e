// SPDX-License-Identifier: MIT
#include "algorithms/effects/effect_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"
#include "foundation/formula_name.hpp"
#include "foundation/plain_name.hpp"
#include "foundation/suggestion.hpp"
#include "problems/preparation/observations.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kMostColumnsOfAtom = 16;
constexpr std::size_t kMostNodes = 200;  // of a column

void require_signal(const std::string& name, std::string_view what, const std::string& place) {
  const std::vector<std::string> known = known_signal_names();
  if (std::ranges::count(known, name) > 0) return;
  throw_bad_input(fmt::format("{} '{}' is no signal", what, name), place,
                  did_you_mean(name, known, fmt::format("signals: {}", fmt::join(known, " "))));
}

// The columns over signals and shapes, whose names stand in this order.
struct ReadColumns {
  std::vector<std::string> names;
  std::vector<Expression> columns;
};

ReadColumns read_columns(const AtomTemplate& atom, const std::string& place) {
  if (atom.columns.empty()) {
    throw_bad_input("an effect has no columns", place, "give it columns = [\"sgn_v*abs(g)\"]");
  }
  if (atom.columns.size() > kMostColumnsOfAtom) {
    throw_bad_input(fmt::format("an effect has {} columns, more than {}", atom.columns.size(),
                                kMostColumnsOfAtom),
                    place, "make several effects of it");
  }
  ReadColumns read;
  for (const std::string& column : atom.columns) {
    read.columns.push_back(parse_collecting_names(column, read.names));  // throws: no formula
    if (read.columns.back().size() <= kMostNodes) continue;
    throw_bad_input(fmt::format("a column has {} operations, more than {}",
                                read.columns.back().size(), kMostNodes),
                    place, "write it shorter");
  }
  return read;
}

void check_names(const AtomTemplate& atom, const ReadColumns& read, const std::string& place) {
  const std::vector<std::string> signals = known_signal_names();
  std::set<std::string> shapes;
  for (const ShapeTemplate& shape : atom.shapes) {
    require_formula_name(shape.name, place);
    if (std::ranges::count(signals, shape.name) > 0) {
      throw_bad_input(fmt::format("the shape '{}' is called like a signal", shape.name), place,
                      "give it another name, in the columns too");
    }
    if (!shapes.insert(shape.name).second) {
      throw_bad_input(fmt::format("the shape '{}' stands there twice", shape.name), place,
                      "leave one of them out");
    }
    if (std::ranges::count(read.names, shape.name) == 0) {
      throw_bad_input(fmt::format("no column holds the shape '{}'", shape.name), place,
                      "leave the shape out, or write it into a column");
    }
  }
  for (const std::string& name : read.names) {
    if (!shapes.contains(name)) require_signal(name, "in a column", place);
  }
  std::set<std::string> coefficients;
  for (const std::string& name : atom.coefficients) {
    require_plain_name(name, "a coefficient", place);
    if (coefficients.insert(name).second) continue;
    throw_bad_input(fmt::format("two coefficients are called '{}'", name), place,
                    "give one of them another name");
  }
}

// "v", "g/a", "1/q" or empty.
void check_scale(const ShapeTemplate& shape, const std::string& place) {
  const std::string what = fmt::format("the scale of '{}',", shape.name);
  if (shape.scale.empty()) {
    if (!shape.reference && !shape.recorded) return;
    throw_bad_input(fmt::format("the shape '{}' has no scale", shape.name), place,
                    "'reference' and 'recorded' speak of the signal that is its scale");
  }
  const std::size_t slash = shape.scale.find('/');
  const bool is_inverse = slash != std::string::npos && shape.scale.starts_with("1/");
  if (!is_inverse) require_signal(shape.scale.substr(0, slash), what, place);
  if (slash != std::string::npos) require_signal(shape.scale.substr(slash + 1), what, place);
}

// Whether a column says anything with this value of a shape, the others at the first of their
// grids: somewhere it is a number, and not 0 everywhere.
bool says_something(const AtomTemplate& atom, const ReadColumns& read, const std::string& shape,
                    double value) {
  // In the signals' scales: fast and slow, as an effect may have faded. Each signal has its own, as
  // effects are written in differences (v - v_lag30).
  constexpr std::array kPoints = {0.7, -0.7, 1.3, -1.3, 0.03, -0.03, 1e-3, -1e-3};
  Evaluator evaluator;
  for (const Expression& column : read.columns) {
    bool says = false;
    for (const double at : kPoints) {
      std::vector<double> point;
      for (const std::string& name : read.names) {
        const auto found = std::ranges::find(atom.shapes, name, &ShapeTemplate::name);
        const bool is_shape = found != atom.shapes.end();
        const double signal = at * (1 + 0.1 * static_cast<double>(point.size()));
        point.push_back(!is_shape             ? signal
                        : name == shape       ? value
                        : found->grid.empty() ? 100
                                              : found->grid.front());
      }
      const double there = evaluator.evaluate_at(column, std::span<const double>(point));
      says = says || (std::isfinite(there) && there != 0);
    }
    if (!says) return false;
  }
  return true;
}

void check_grid(const AtomTemplate& atom, const ReadColumns& read, const ShapeTemplate& shape,
                const std::string& place) {
  for (const double value : shape.grid) {
    if (shape.high > shape.low && (value < shape.low || value > shape.high)) {
      throw_bad_input(fmt::format("the shape '{}' has {} on its grid, outside {} .. {}", shape.name,
                                  value, shape.low, shape.high),
                      place, "widen low and high, or leave the value out");
    }
    if (!says_something(atom, read, shape.name, value)) {
      throw_bad_input(
          fmt::format("with {} = {} a column is 0 or no number everywhere", shape.name, value),
          place, "leave the value out of the grid");
    }
  }
}

bool is_experiment(std::string_view rule) { return experiment_text(rule) != rule; }

}  // namespace

void check_atom(const AtomTemplate& atom, const std::string& place) {
  const ReadColumns read = read_columns(atom, place);
  check_names(atom, read, place);
  for (const ShapeTemplate& shape : atom.shapes) {
    check_scale(shape, place);
    check_grid(atom, read, shape, place);
  }
}

void check_family(const EffectFamily& family, const std::string& place) {
  std::string_view name = family.name;
  if (name.starts_with(kLearnedPrefix)) name.remove_prefix(kLearnedPrefix.size());
  require_plain_name(name, "an effect", place);
  for (const std::string& rule : family.separate_by) {
    if (is_experiment(rule)) continue;
    throw_bad_input(fmt::format("there is no experiment '{}'", rule), place, "give R1 to R9");
  }
  std::vector<std::string> coefficients;
  for (const AtomTemplate& atom : family.atoms) {
    coefficients.insert(coefficients.end(), atom.coefficients.begin(), atom.coefficients.end());
  }
  const auto require_coefficient = [&](const std::string& name) {
    if (std::ranges::count(coefficients, name) > 0) return;
    throw_bad_input(fmt::format("the effect has no coefficient '{}'", name), place,
                    did_you_mean(name, coefficients));
  };
  for (const Sanity& one : family.sanity) require_coefficient(one.coefficient);
  for (const KnownAlias& one : family.known_aliases) {
    if (!one.coefficient.empty()) require_coefficient(one.coefficient);
    if (!one.unless_known.empty()) require_signal(one.unless_known, "'unless_known'", place);
  }
}

}  // namespace tribench::loop
