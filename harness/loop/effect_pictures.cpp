// SPDX-License-Identifier: MIT
//
// The picture of an effect in its own coordinate. No family is known by name: of the coordinates
// that its columns suggest (a signal or its size, the argument of a magnitude, the product of two
// signals, the phase of a sine), of the torque and the torque against the motion, and of the ways
// to part the rows (direction, speeding up, driving), the simplest is taken over which the fitted
// effect is one curve.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"
#include "algorithms/loop_model/smoothers.hpp"
#include "harness/loop/loop_series.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kBins = 30;
constexpr std::size_t kFoldedBins = 36;
constexpr std::size_t kMostMarks = 200;
// A way of looking that explains less than this much more is not worth being less simple.
constexpr double kWorthIt = 0.02;
// Where an effect has faded to this part of its range the picture ends, if that leaves out most.
constexpr double kFaded = 0.03;
constexpr double kMostlyFaded = 0.6;

struct Coordinate {
  LoopAxis axis;
  Eigen::VectorXd values;
};

// How the rows are parted: by the sign of this, or not at all.
struct Parting {
  LoopSplit positive = LoopSplit::all;
  LoopSplit negative = LoopSplit::all;
  Eigen::VectorXd sign;
};

struct Look {
  Coordinate coordinate;
  Parting parting;
  bool against_motion = false;
};

std::vector<Expression> columns_of(const LoopRows& all, const EffectFinding& effect) {
  std::vector<Expression> columns;
  for (const Atom& atom : all.diagnosis.after.atoms) {
    if (all.diagnosis.families[atom.family].name != effect.family) continue;
    columns.insert(columns.end(), atom.columns.begin(), atom.columns.end());
  }
  return columns;
}

Eigen::VectorXd values_of(const Observations& data, std::size_t column) {
  return Eigen::Map<const Eigen::VectorXd>(data.signals[column].values.data(),
                                           static_cast<Eigen::Index>(data.rows()));
}

Eigen::VectorXd evaluated(const Expression& formula, const Observations& data) {
  return evaluate_columns(std::span(&formula, 1), data).col(0);
}

// The signals of the columns, signs aside.
std::vector<std::size_t> signals_of(const std::vector<Expression>& columns,
                                    const Observations& data) {
  std::set<std::size_t> used;
  for (const Expression& column : columns) {
    for (const Node& node : column.nodes()) {
      if (node.is_variable() && !data.signals[node.variable].name.starts_with("sgn_")) {
        used.insert(node.variable);
      }
    }
  }
  return {used.begin(), used.end()};
}

// The only signal of a formula that is a multiple of it, and the factor.
struct Multiple {
  std::size_t signal = 0;
  double factor = 0;
};
std::optional<Multiple> multiple_of_one(const Expression& formula) {
  std::set<std::size_t> used;
  for (const Node& node : formula.nodes()) {
    if (node.is_variable()) used.insert(node.variable);
  }
  if (used.size() != 1) return std::nullopt;
  const std::size_t signal = *used.begin();
  std::vector<double> point(signal + 1, 0.0);
  Evaluator evaluator;
  const auto at = [&](double x) {
    point[signal] = x;
    return evaluator.evaluate_at(formula, point);
  };
  const double factor = at(1);
  const double tolerance = 1e-9 * std::abs(factor);
  const bool linear = std::abs(at(0)) <= tolerance && std::abs(at(2) - 2 * factor) <= 2 * tolerance;
  if (!linear || factor == 0) return std::nullopt;
  return Multiple{signal, std::abs(factor)};
}

// The arguments of the functions with this operation.
std::vector<Expression> arguments_of(const std::vector<Expression>& columns,
                                     std::initializer_list<Op> operations) {
  std::vector<Expression> all;
  for (const Expression& column : columns) {
    for (std::size_t i = 0; i < column.size(); ++i) {
      if (std::ranges::count(operations, column.node(i).op) == 0) continue;
      Expression argument = subtree(column, column.last_child(i));
      if (std::ranges::count(all, argument) == 0) all.push_back(std::move(argument));
    }
  }
  return all;
}

// Folded over the longest period of the columns' sines, where the rows hold more than one.
std::optional<Coordinate> folded(const std::vector<Expression>& columns, const LoopRows& all) {
  std::optional<Multiple> slowest;
  for (const Expression& argument : arguments_of(columns, {Op::sin, Op::cos})) {
    const std::optional<Multiple> one = multiple_of_one(argument);
    if (one && (!slowest || one->factor < slowest->factor)) slowest = one;
  }
  if (!slowest) return std::nullopt;
  Eigen::VectorXd x = values_of(all.data, slowest->signal);
  const double period = 2 * std::numbers::pi / slowest->factor;
  if (!(x.maxCoeff() - x.minCoeff() > 1.5 * period)) return std::nullopt;
  LoopAxis axis = axis_of(all.data, all.data.signals[slowest->signal].name);
  axis.period = period;
  x = x.unaryExpr([&](double q) { return q - period * std::floor(q / period); });
  return Coordinate{axis, x};
}

void add_signal(std::vector<Coordinate>& all, const Observations& data, std::size_t column) {
  const Eigen::VectorXd x = values_of(data, column);
  LoopAxis axis = axis_of(data, data.signals[column].name);
  const bool both_signs = x.minCoeff() < 0 && x.maxCoeff() > 0;
  // A place or a time has no size, only a value.
  const Role role = data.signals[column].role;
  const bool has_size = role != Role::position && role != Role::time && role != Role::temperature;
  if (both_signs && has_size) {
    LoopAxis size = axis;
    size.magnitude = true;
    all.push_back({size, x.cwiseAbs()});
  }
  all.push_back({axis, x});
}

std::string rounded_text(Expression formula, const Observations& data) {
  for (const std::size_t i : constant_positions(formula)) {
    set_constant(formula, i, std::stod(fmt::format("{:.3g}", formula.node(i).value)));
  }
  return print(formula, data.names());
}

// Of a sum that begins with a signal, that signal's; else not known.
std::string unit_of(const Expression& sum, const Observations& data) {
  if (sum.node(sum.root()).op != Op::add) return {};
  const Node& first = sum.node(sum.left_child(sum.root()));
  return first.is_variable() ? data.signals[first.variable].unit : std::string();
}

// Simplest first.
std::vector<Coordinate> coordinates(const std::vector<Expression>& columns, const LoopRows& all) {
  const Observations& data = all.data;
  if (std::optional<Coordinate> turn = folded(columns, all)) return {*turn};
  std::vector<Coordinate> found;
  std::vector<std::size_t> signals = signals_of(columns, data);
  if (signals.empty()) {
    const Signal* v = data.find("v");
    if (v != nullptr) signals.push_back(static_cast<std::size_t>(v - data.signals.data()));
  }
  for (const std::size_t column : signals) add_signal(found, data, column);
  for (const Expression& argument : arguments_of(columns, {Op::abs})) {
    if (argument.size() < 2) continue;
    found.push_back({{rounded_text(argument, data), unit_of(argument, data), true, 0},
                     evaluated(argument, data).cwiseAbs()});
  }
  if (signals.size() == 2) {
    const Signal& a = data.signals[signals[0]];
    const Signal& b = data.signals[signals[1]];
    found.push_back(
        {{a.name + "*" + b.name, a.unit + " " + b.unit, true, 0},
         values_of(data, signals[0]).cwiseProduct(values_of(data, signals[1])).cwiseAbs()});
  }
  return found;
}

std::vector<Parting> partings(const std::vector<Expression>& columns, const Observations& data) {
  std::vector<Parting> all = {{}};
  const Eigen::VectorXd way = direction(data);
  all.push_back({LoopSplit::forward, LoopSplit::backward, way});
  for (const std::size_t column : signals_of(columns, data)) {
    const Eigen::VectorXd sign = way.cwiseProduct(values_of(data, column));
    if (data.signals[column].role == Role::acceleration) {
      all.push_back({LoopSplit::speeding_up, LoopSplit::slowing_down, sign});
    }
    if (data.signals[column].role == Role::gravity_torque) {
      all.push_back({LoopSplit::driving, LoopSplit::back_driving, sign});
    }
  }
  return all;
}

std::vector<std::vector<std::size_t>> parts_of(const LoopRows& all, const Parting& parting) {
  if (parting.sign.size() == 0) return {all.rows};
  std::vector<std::vector<std::size_t>> parts(2);
  for (const std::size_t i : all.rows) {
    parts[parting.sign[static_cast<Eigen::Index>(i)] < 0 ? 1 : 0].push_back(i);
  }
  return parts;
}

Bins bins_of(const Coordinate& coordinate, const std::vector<std::size_t>& rows) {
  return coordinate.axis.period > 0
             ? equal_widths(rows, coordinate.values, kFoldedBins, kFewestRowsOfBin)
             : equal_counts(rows, coordinate.values, kBins, kFewestRowsOfBin);
}

// Share of the effect's variance that bins along the coordinate explain.
double explained(const LoopRows& all, const Look& look, const Eigen::VectorXd& effect) {
  double within = 0;
  double squares = 0;
  std::size_t rows = 0;
  for (const std::vector<std::size_t>& part : parts_of(all, look.parting)) {
    const Bins bins = bins_of(look.coordinate, part);
    const std::vector<double> mean = means(bins, effect);
    for (std::size_t b = 0; b < bins.rows.size(); ++b) {
      for (const std::size_t i : bins.rows[b]) {
        const double value = effect[static_cast<Eigen::Index>(i)];
        within += (value - mean[b]) * (value - mean[b]);
        squares += value * value;
        ++rows;
      }
    }
  }
  return rows > 0 && squares > 0 ? 1 - within / squares : 0;
}

Look best_look(const LoopRows& all, const EffectFinding& effect, const Eigen::VectorXd& value) {
  const std::vector<Expression> columns = columns_of(all, effect);
  const Eigen::VectorXd braking = value.cwiseProduct(direction(all.data));
  Look best;
  double best_share = -1;
  for (const Parting& parting : partings(columns, all.data)) {
    for (const Coordinate& coordinate : coordinates(columns, all)) {
      for (const bool against : {true, false}) {
        const Look look{coordinate, parting, against};
        const double share = explained(all, look, against ? braking : value);
        if (share > best_share + kWorthIt) {
          best = look;
          best_share = share;
        }
      }
    }
  }
  return best;
}

// Rows up to where the effect has faded, where most of the axis lies beyond.
std::vector<std::size_t> unfaded(const LoopRows& all, const Look& look,
                                 const Eigen::VectorXd& effect) {
  const Eigen::VectorXd& x = look.coordinate.values;
  if (look.coordinate.axis.period > 0) return all.rows;
  std::vector<std::size_t> order = all.rows;
  std::ranges::stable_sort(order, {},
                           [&](std::size_t i) { return x[static_cast<Eigen::Index>(i)]; });
  if (order.size() < 2 * kFewestRowsOfBin) return all.rows;
  const double low = x[static_cast<Eigen::Index>(order.front())];
  const double high = x[static_cast<Eigen::Index>(order.back())];
  double largest = 0;
  for (const std::size_t i : order) {
    largest = std::max(largest, std::abs(effect[static_cast<Eigen::Index>(i)]));
  }
  double last = low;
  for (const std::size_t i : order) {
    const auto row = static_cast<Eigen::Index>(i);
    if (std::abs(effect[row]) > kFaded * largest) last = x[row];
  }
  if (low < 0 || !(last - low < kMostlyFaded * (high - low))) return all.rows;
  const double end = low + 2 * (last - low);
  std::erase_if(order, [&](std::size_t i) { return x[static_cast<Eigen::Index>(i)] > end; });
  return order.size() < 2 * kFewestRowsOfBin ? all.rows : order;
}

// Where movements begin, of a picture over the campaign.
std::vector<double> movement_marks(const LoopRows& all, const Look& look) {
  if (look.coordinate.axis.channel != role_name(Role::time)) return {};
  std::vector<double> marks;
  for (std::size_t i = 0; i < all.data.rows(); ++i) {
    if (i == 0 || all.data.movement[i] != all.data.movement[i - 1]) {
      marks.push_back(look.coordinate.values[static_cast<Eigen::Index>(i)]);
    }
  }
  return marks.size() > kMostMarks ? std::vector<double>() : marks;
}

}  // namespace

LoopEffectPicture effect_picture(const LoopRows& all, const EffectFinding& effect) {
  const EffectShare share = effect_share(all, effect);
  const Look look = best_look(all, effect, share.value);
  LoopEffectPicture picture{effect.family, look.coordinate.axis, look.against_motion, {}, {}};
  if (look.coordinate.values.size() == 0) return picture;
  Eigen::VectorXd partial = target_vector(all.data) - all.after + share.value;
  Eigen::VectorXd fitted = share.value;
  if (look.against_motion) {
    const Eigen::VectorXd way = direction(all.data);
    partial = partial.cwiseProduct(way);
    fitted = fitted.cwiseProduct(way);
  }
  LoopRows some = all;
  some.rows = unfaded(all, look, fitted);
  const std::vector<std::vector<std::size_t>> parts = parts_of(some, look.parting);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const Bins bins = bins_of(look.coordinate, parts[p]);
    if (bins.rows.empty()) continue;
    LoopSeries series;
    series.split = p == 0 ? look.parting.positive : look.parting.negative;
    series.x = means(bins, look.coordinate.values);
    series.measured = means(bins, partial);
    series.spread = mean_errors(bins, partial, all.rows_of_noise);
    series.after = means(bins, fitted);
    series.band = means(bins, share.half);
    series.rows = counts(bins);
    picture.series.push_back(std::move(series));
  }
  picture.marks = movement_marks(all, look);
  return picture;
}

}  // namespace tribench::loop
