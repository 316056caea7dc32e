// SPDX-License-Identifier: MIT
#include "algorithms/effects/effect_library.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "algorithms/expression/text.hpp"

namespace tribench::loop {
namespace {

constexpr std::array<double, 7> kUsualGearRatios = {50, 80, 100, 101, 120, 121, 160};
// Of a signal's values: those beyond its scale.
constexpr double kBeyond = 0.01;
constexpr std::array<double, 5> kUsualLeads = {0.040, 0.020, 0.010, 0.005, 0.0025};  // m

bool is_linear_axis(const Observations& data) {
  const Signal* position = data.find("q");
  return position != nullptr && position->unit == "m";
}

// The value that the share `part` of the others exceeds.
double upper_quantile(std::vector<double> values, double part) {
  const auto at = static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, values.begin() + at, std::ranges::greater());
  return values[static_cast<std::size_t>(at)];
}

// The mean over the movements' means would weigh a long movement less; the plain mean will do for
// a reference that is subtracted.
double mean(std::span<const double> values) {
  double sum = 0;
  for (const double x : values) sum += x;
  return sum / static_cast<double>(values.size());
}

// Data to instantiate over, and the scales of its signals: each looks at all rows, and every atom
// of a family asks for the same ones.
struct ScaledData {
  const Observations& data;
  std::map<std::string, double, std::less<>> known = {};

  double scale_of(std::string_view name) {
    const auto found = known.find(name);
    if (found != known.end()) return found->second;
    return known.emplace(name, signal_scale(data, name)).first->second;
  }
};

// The value of a shape in the data's units.
double scaled(const ShapeTemplate& shape, double value, ScaledData& over) {
  if (shape.scale.empty()) return value;
  if (const std::size_t slash = shape.scale.find('/'); slash != std::string::npos) {
    return value * over.scale_of(shape.scale.substr(0, slash)) /
           over.scale_of(shape.scale.substr(slash + 1));
  }
  const Signal* signal = over.data.find(shape.scale);
  if (signal == nullptr) return value;
  if (shape.reference) return mean(signal->values);
  return value * over.scale_of(shape.scale);
}

// The least a shape may be in the data's units.
double least(const ShapeTemplate& shape, ScaledData& over) {
  const double low = scaled(shape, shape.low, over);
  const Signal* signal = over.data.find(shape.scale);
  if (!shape.recorded || signal == nullptr) return low;
  double smallest = std::numeric_limits<double>::infinity();
  for (const double x : signal->values) smallest = std::min(smallest, std::abs(x));
  return std::max(low, smallest);
}

// Else an effect and what differs of it by direction are one.
bool moves_both_ways(const Observations& data) {
  const Signal* v = data.find("v");
  if (v == nullptr || v->values.empty()) return false;
  const auto [low, high] = std::ranges::minmax(v->values);
  return low < 0 && high > 0;
}

bool fits_inertia(const Observations& data) {
  return std::ranges::any_of(data.rigid, [&](const std::string& name) {
    const Signal* signal = data.find(name);
    return signal != nullptr && signal->role == Role::acceleration;
  });
}

std::vector<std::string> variables_of(const AtomTemplate& atom) {
  std::vector<std::string> names;
  for (const std::string& column : atom.columns) parse_collecting_names(column, names);
  std::erase_if(names, [&](const std::string& name) {
    return std::ranges::count(atom.shapes, name, &ShapeTemplate::name) > 0;
  });
  return names;
}

Atom make_atom(const AtomTemplate& source, std::size_t family, ScaledData& over,
               std::span<const double> values) {
  std::vector<std::string> names = over.data.names();
  const std::size_t signals = names.size();
  Atom atom;
  atom.family = family;
  atom.coefficients = source.coefficients;
  atom.beside_another = source.beside_another || source.by_direction;
  atom.one_way = source.one_way;
  atom.without_inertia = source.without_inertia;
  atom.last_resort = source.last_resort;
  atom.curve = source.curve;
  for (std::size_t k = 0; k < source.shapes.size(); ++k) {
    const ShapeTemplate& shape = source.shapes[k];
    names.push_back(shape.name);
    const bool fixed = !(shape.high > shape.low);
    const double value = scaled(shape, values[k], over);
    atom.shapes.push_back({shape.name,
                           value,
                           fixed ? value : least(shape, over),
                           fixed ? value : scaled(shape, shape.high, over),
                           {},
                           shape.values});
  }
  for (std::size_t c = 0; c < source.columns.size(); ++c) {
    const Expression parsed = parse(source.columns[c], names);
    std::vector<Node> nodes(parsed.nodes().begin(), parsed.nodes().end());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (!nodes[i].is_variable() || nodes[i].variable < signals) continue;
      const std::size_t k = nodes[i].variable - signals;
      nodes[i] = Node::constant(atom.shapes[k].value);
      atom.shapes[k].places.push_back({c, i});
    }
    atom.columns.emplace_back(std::move(nodes));
  }
  for (const std::string& column : source.columns) {
    atom.label += (atom.label.empty() ? "" : ", ") + column;
  }
  return atom;
}

void expand(const AtomTemplate& source, std::size_t family, ScaledData& over,
            std::span<const double> gear_ratios, std::vector<double>& values,
            std::vector<Atom>& out) {
  if (values.size() == source.shapes.size()) {
    out.push_back(make_atom(source, family, over, values));
    return;
  }
  const ShapeTemplate& shape = source.shapes[values.size()];
  const std::span<const double> grid =
      shape.values == ShapeValues::gear_ratios ? gear_ratios : std::span<const double>(shape.grid);
  for (const double value : grid) {
    if (shape.recorded && scaled(shape, value, over) < least(shape, over)) continue;
    values.push_back(value);
    expand(source, family, over, gear_ratios, values, out);
    values.pop_back();
  }
}

// A signal's name for those who have not read a formula yet.
std::string signal_words(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 10> kWords = {{
      {"v", "velocity"},
      {"a", "acceleration"},
      {"q", "position"},
      {"g", "gravity torque"},
      {"T", "temperature"},
      {"t", "time through the campaign"},
      {"d", "reversal"},
      {kSeenDistance, "reversal"},
      {"v2", "other joint's velocity"},
      {"a2", "other joint's acceleration"},
  }};
  const auto known = std::ranges::find(kWords, name, [](const auto& pair) { return pair.first; });
  return std::string(known == kWords.end() ? name : known->second);
}

}  // namespace

double signal_scale(const Observations& data, std::string_view name) {
  const Signal* signal = data.find(name);
  if (signal == nullptr || signal->values.empty()) return 1;
  // A distance since reversal is measured against the range of the joint.
  if (is_distance(name) && data.find("q") != nullptr) return signal_scale(data, "q");
  if (name == "q" || name == "T" || name == "t") {
    std::vector<double> turned = signal->values;
    for (double& x : turned) x = -x;
    return upper_quantile(signal->values, kBeyond) + upper_quantile(std::move(turned), kBeyond);
  }
  std::vector<double> magnitudes = signal->values;
  for (double& x : magnitudes) x = std::abs(x);
  return upper_quantile(std::move(magnitudes), kBeyond);
}

void Atom::set_shape(std::size_t shape, double value) {
  shapes[shape].value = value;
  for (const Shape::Place& place : shapes[shape].places) {
    set_constant(columns[place.column], place.node, value);
  }
}

std::vector<double> gear_ratios_for(const Observations& data, std::span<const double> given) {
  if (!given.empty()) return {given.begin(), given.end()};
  if (!is_linear_axis(data)) return {kUsualGearRatios.begin(), kUsualGearRatios.end()};
  std::vector<double> ratios;
  for (const double lead : kUsualLeads) ratios.push_back(2 * std::numbers::pi / lead);
  return ratios;
}

std::vector<Atom> instantiate(const EffectFamily& family, std::size_t number,
                              const Observations& data, std::span<const double> gear_ratios,
                              std::vector<std::string>& missing) {
  missing.clear();
  std::vector<Atom> atoms;
  ScaledData over{data};
  if (family.angular && is_linear_axis(data)) {
    missing = {"no angle: the position is in m"};
    return atoms;
  }
  for (const AtomTemplate& source : family.atoms) {
    if ((source.by_direction || source.one_way) && !moves_both_ways(data)) continue;
    if (source.without_inertia && fits_inertia(data)) continue;
    std::vector<std::string> lacking;
    for (const std::string& name : variables_of(source)) {
      const auto withheld = std::ranges::find(data.withheld, name, &WithheldSignal::name);
      if (withheld != data.withheld.end()) {
        lacking.push_back(fmt::format("{}: {}", signal_words(name), withheld->why));
      } else if (data.find(name) == nullptr) {
        lacking.push_back("no " + signal_words(name));
      }
    }
    if (lacking.empty()) {
      std::vector<double> values;
      expand(source, number, over, gear_ratios, values, atoms);
      const bool faded = std::ranges::count(source.shapes, true, &ShapeTemplate::recorded) > 0;
      if (atoms.empty() && faded) missing = {"no slow rows"};
    } else if (missing.empty() || lacking.size() < missing.size()) {
      missing = lacking;
    }
  }
  if (!atoms.empty()) missing.clear();
  return atoms;
}

bool falls_with_speed(std::span<const double> friction, std::span<const double> v) {
  for (const double direction : {1.0, -1.0}) {
    double slowest = std::numeric_limits<double>::infinity();
    double there = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < v.size(); ++i) {
      if (!(direction * v[i] > 0)) continue;
      const double against = direction * friction[i];
      least = std::min(least, against);
      if (std::abs(v[i]) < slowest) {
        slowest = std::abs(v[i]);
        there = against;
      }
    }
    if (least < there) return true;
  }
  return false;
}

}  // namespace tribench::loop
