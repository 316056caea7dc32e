// SPDX-License-Identifier: MIT
//
// Pictures of the recording and what is left of it: friction against velocity, residuals against
// each input, what is left over in two of them, and movements as they were measured.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "algorithms/loop_model/smoothers.hpp"
#include "foundation/order_statistics.hpp"
#include "harness/loop/loop_series.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kFrictionBins = 18;  // a direction and load level
constexpr std::size_t kInputBins = 30;     // a direction
constexpr std::size_t kMapBins = 18;       // a side
constexpr std::size_t kTraceRows = 1500;

Eigen::VectorXd values_of(const Observations& data, std::string_view name) {
  const Signal* signal = data.find(name);
  const auto n = static_cast<Eigen::Index>(data.rows());
  if (signal == nullptr) return Eigen::VectorXd::Zero(n);
  return Eigen::Map<const Eigen::VectorXd>(signal->values.data(), n);
}

std::vector<std::size_t> rows_with(const std::vector<std::size_t>& rows,
                                   const Eigen::VectorXd& values, double sign) {
  std::vector<std::size_t> out;
  for (const std::size_t i : rows) {
    if (values[static_cast<Eigen::Index>(i)] * sign > 0) out.push_back(i);
  }
  return out;
}

bool load_matters(const LoopRows& all) {
  const Signal* g = all.data.find("g");
  if (g == nullptr) return false;
  const auto column = static_cast<std::size_t>(g - all.data.signals.data());
  for (const Atom& atom : all.diagnosis.after.atoms) {
    for (const Expression& formula : atom.columns) {
      for (const Node& node : formula.nodes()) {
        if (node.is_variable() && node.variable == column) return true;
      }
    }
  }
  return false;
}

// Rows by a third of the load each, where an effect uses it; else all of them.
std::vector<std::vector<std::size_t>> load_levels(const LoopRows& all) {
  if (!load_matters(all)) return {all.rows};
  const Eigen::VectorXd load = values_of(all.data, "g").cwiseAbs();
  std::vector<double> sizes;
  for (const std::size_t i : all.rows) sizes.push_back(load[static_cast<Eigen::Index>(i)]);
  const double low = quantile(sizes, 1.0 / 3);
  const double high = quantile(sizes, 2.0 / 3);
  if (!(high > low)) return {all.rows};
  std::vector<std::vector<std::size_t>> levels(3);
  for (const std::size_t i : all.rows) {
    const double size = load[static_cast<Eigen::Index>(i)];
    levels[size <= low ? 0 : size <= high ? 1 : 2].push_back(i);
  }
  return levels;
}

double mean_of(const std::vector<std::size_t>& rows, const Eigen::VectorXd& values) {
  double sum = 0;
  for (const std::size_t i : rows) sum += values[static_cast<Eigen::Index>(i)];
  return rows.empty() ? 0 : sum / static_cast<double>(rows.size());
}

LoopTrace trace_of(const LoopRows& all, int movement, const char* why) {
  const Observations& data = all.data;
  const std::size_t begin =
      static_cast<std::size_t>(std::ranges::find(data.movement, movement) - data.movement.begin());
  std::size_t end = begin;
  while (end < data.rows() && data.movement[end] == movement) ++end;
  LoopTrace trace;
  trace.movement = data.movement_names[static_cast<std::size_t>(movement)];
  trace.why = why;
  trace.held_out = std::ranges::binary_search(all.diagnosis.held_out, movement);
  // Without a time the movement's number stands for it, the same in every row.
  trace.has_time = end - begin > 1 && data.time[end - 1] > data.time[begin];
  const std::size_t step = (end - begin + kTraceRows - 1) / kTraceRows;
  for (std::size_t i = begin; i < end; i += std::max<std::size_t>(1, step)) {
    const auto row = static_cast<Eigen::Index>(i);
    trace.x.push_back(trace.has_time ? data.time[i] - data.time[begin]
                                     : static_cast<double>(i - begin));
    trace.measured.push_back(data.target[i]);
    trace.before.push_back(all.before[row]);
    trace.after.push_back(all.after[row]);
  }
  return trace;
}

// What differs from movement to movement, in the order of the recording.
LoopInputPicture varying_picture(const VaryingFinding& varying) {
  std::vector<VaryingFinding::OfMovement> movements = varying.movements;
  std::ranges::sort(movements, {}, &VaryingFinding::OfMovement::movement);
  LoopInputPicture picture;
  picture.x = {"movement", "", false, 0};
  picture.leftover = true;
  LoopSeries series;
  for (const VaryingFinding::OfMovement& one : movements) {
    series.x.push_back(one.movement + 1);
    series.measured.push_back(one.torque);
  }
  picture.series.push_back(std::move(series));
  return picture;
}

}  // namespace

LoopFrictionPicture friction_picture(const LoopRows& all) {
  LoopFrictionPicture picture;
  if (all.data.find("v") == nullptr) return picture;
  picture.x = axis_of(all.data, "v");
  picture.rigid_part_removed = all.has_rigid;
  const Eigen::VectorXd v = values_of(all.data, "v");
  const Eigen::VectorXd load = values_of(all.data, "g").cwiseAbs();
  const Eigen::VectorXd measured = target_vector(all.data) - all.rigid;
  const Eigen::VectorXd before = all.before - all.rigid;
  const Eigen::VectorXd after = all.after - all.rigid;
  const std::vector<std::vector<std::size_t>> levels = load_levels(all);
  for (const std::vector<std::size_t>& level : levels) {
    for (const double sign : {-1.0, 1.0}) {
      const Bins bins = equal_counts(rows_with(level, v, sign), v, kFrictionBins, kFewestRowsOfBin);
      if (bins.rows.empty()) continue;
      LoopSeries series;
      series.split = levels.size() > 1 ? LoopSplit::load_level : LoopSplit::all;
      series.level = levels.size() > 1 ? mean_of(level, load) : 0;
      series.x = means(bins, v);
      series.measured = means(bins, measured);
      series.spread = deviations(bins, measured);
      series.before = means(bins, before);
      series.after = means(bins, after);
      series.rows = counts(bins);
      picture.series.push_back(std::move(series));
    }
  }
  return picture;
}

std::vector<LoopInputPicture> input_pictures(const LoopRows& all) {
  const Eigen::VectorXd y = target_vector(all.data);
  const Eigen::VectorXd before = y - all.before;
  const Eigen::VectorXd after = y - all.after;
  const Eigen::VectorXd way = direction(all.data);
  std::vector<LoopInputPicture> pictures;
  if (const auto& varying = all.diagnosis.leftover.varying) {
    pictures.push_back(varying_picture(*varying));
  }
  for (const Signal& signal : all.data.signals) {
    if (!worth_a_look(signal)) continue;
    LoopInputPicture picture;
    picture.x = axis_of(all.data, signal.name);
    picture.leftover = std::ranges::count(all.diagnosis.leftover.signals, signal.name) > 0;
    const Eigen::VectorXd x = values_of(all.data, signal.name);
    for (const double sign : {1.0, -1.0}) {
      const Bins bins =
          equal_counts(rows_with(all.rows, way, sign), x, kInputBins, kFewestRowsOfBin);
      if (bins.rows.size() < 2) continue;
      LoopSeries series;
      series.split = sign > 0 ? LoopSplit::forward : LoopSplit::backward;
      series.x = means(bins, x);
      series.before = means(bins, before);
      series.measured = means(bins, after);
      series.spread = mean_errors(bins, after, all.rows_of_noise);
      series.rows = counts(bins);
      picture.series.push_back(std::move(series));
    }
    if (!picture.series.empty()) pictures.push_back(std::move(picture));
  }
  std::stable_partition(pictures.begin(), pictures.end(),
                        [](const LoopInputPicture& picture) { return picture.leftover; });
  return pictures;
}

std::vector<LoopMapPicture> leftover_maps(const LoopRows& all) {
  const std::vector<std::string>& names = all.diagnosis.leftover.signals;
  if (names.size() != 2) return {};
  const Eigen::VectorXd x = values_of(all.data, names[0]);
  const Eigen::VectorXd y = values_of(all.data, names[1]);
  const Eigen::VectorXd residual = target_vector(all.data) - all.after;
  LoopMapPicture map{axis_of(all.data, names[0]), axis_of(all.data, names[1]), {}};
  const Bins columns = equal_counts(all.rows, x, kMapBins, kFewestRowsOfBin);
  for (std::size_t b = 0; b < columns.rows.size(); ++b) {
    const Bins cells = equal_counts(columns.rows[b], y, kMapBins, kFewestRowsOfBin);
    const auto edge = [](const std::vector<std::size_t>& rows, const Eigen::VectorXd& of,
                         bool top) {
      double value = of[static_cast<Eigen::Index>(rows[0])];
      for (const std::size_t i : rows) {
        const double one = of[static_cast<Eigen::Index>(i)];
        value = top ? std::max(value, one) : std::min(value, one);
      }
      return value;
    };
    const std::vector<double> mean = means(cells, residual);
    for (std::size_t c = 0; c < cells.rows.size(); ++c) {
      map.cells.push_back({edge(columns.rows[b], x, false), edge(columns.rows[b], x, true),
                           edge(cells.rows[c], y, false), edge(cells.rows[c], y, true), mean[c],
                           cells.rows[c].size()});
    }
  }
  return {map};
}

std::vector<LoopTrace> traces(const LoopRows& all) {
  // Of the movements that were held out, or of all where each was left out in turn: the middle one
  // by the fall of its error, then those with most and least.
  const Eigen::VectorXd y = target_vector(all.data);
  const Eigen::VectorXd fall = (y - all.before).cwiseAbs() - (y - all.after).cwiseAbs();
  struct Fall {
    int movement;
    double sum;
    std::size_t rows;
  };
  std::vector<Fall> falls;
  for (const std::size_t i : all.rows) {
    const int movement = all.data.movement[i];
    const bool shown = all.diagnosis.held_out.empty() ||
                       std::ranges::binary_search(all.diagnosis.held_out, movement);
    if (!shown) continue;
    if (falls.empty() || falls.back().movement != movement) falls.push_back({movement, 0, 0});
    falls.back().sum += fall[static_cast<Eigen::Index>(i)];
    ++falls.back().rows;
  }
  if (falls.empty()) return {};
  std::ranges::stable_sort(falls, {},
                           [](const Fall& one) { return one.sum / static_cast<double>(one.rows); });
  std::vector<LoopTrace> out = {trace_of(all, falls[falls.size() / 2].movement, "middle")};
  if (falls.size() > 1) out.push_back(trace_of(all, falls.back().movement, "most"));
  if (falls.size() > 2) out.push_back(trace_of(all, falls.front().movement, "least"));
  return out;
}

}  // namespace tribench::loop
