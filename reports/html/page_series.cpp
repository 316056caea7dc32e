// SPDX-License-Identifier: MIT
#include "reports/html/page_series.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>
#include <unordered_map>

#include "foundation/elementary.hpp"
#include "reports/record/record_csv.hpp"

namespace tribench {
namespace {

using nlohmann::ordered_json;
using GroupKey = std::tuple<std::string, std::string, std::string>;  // problem, method, operators

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kFrontPoints = 60;  // of a group, fewer where there are many groups
constexpr std::size_t kAllFrontPoints = 12'000;
constexpr std::size_t kProfilePoints = 120;    // of a curve
constexpr std::size_t kGridPoints = 40;        // of a trace
constexpr std::size_t kCurvePoints = 400'000;  // of all pictures
constexpr std::array<double, 6> kTargets = {2, 1.5, 1.2, 1.1, 1.05, 1.01};

using RecordOf = std::unordered_map<std::string, const Record*>;

RecordOf records_by_cell(const RunFolder& run) {
  RecordOf found;
  found.reserve(run.records.size());
  for (const Record& record : run.records) found.emplace(record.cell, &record);
  return found;
}

// At most `most` formulas of a sorted front, or as many as must stay: the simplest, the most
// accurate and every chosen one. The others are taken evenly from the whole length.
void cut_front(std::vector<FrontRecord>& front, std::size_t most) {
  if (front.size() <= most) return;
  std::vector<char> keep(front.size(), 0);
  keep.front() = 1;
  // The last one that improves is the most accurate; behind it stand chosen ones alone.
  keep[static_cast<std::size_t>(std::ranges::min_element(front, {}, &FrontRecord::mae_test) -
                                front.begin())] = 1;
  for (std::size_t i = 0; i < front.size(); ++i) {
    if (front[i].chosen) keep[i] = 1;
  }
  const auto must = static_cast<std::size_t>(std::ranges::count(keep, 1));
  const std::size_t others = most > must ? most - must : 0;
  for (std::size_t k = 0; k < others; ++k) keep[(k + 1) * front.size() / (others + 1)] = 1;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < front.size(); ++i) {
    if (keep[i] == 0) continue;
    if (kept != i) front[kept] = std::move(front[i]);
    ++kept;
  }
  front.resize(kept);
}

// Keeps the formulas that no other beats in complexity and error, and every chosen one.
void thin_front(std::vector<FrontRecord>& front, std::size_t most) {
  std::sort(front.begin(), front.end(), [](const FrontRecord& a, const FrontRecord& b) {
    return std::tie(a.complexity, a.mae_test, a.formula) <
           std::tie(b.complexity, b.mae_test, b.formula);
  });
  double best = kInfinity;
  std::vector<FrontRecord> kept;
  for (FrontRecord& each : front) {
    const bool improves = each.mae_test < best;
    if (!improves && !each.chosen) continue;
    if (improves) best = each.mae_test;
    kept.push_back(std::move(each));
  }
  cut_front(kept, most);
  front = std::move(kept);
}

struct Step {
  std::uint64_t evaluations;
  float cpu_s;
  float error;
};

struct CellTrace {
  const Record* record = nullptr;
  std::vector<Step> steps;  // in the order of the file: improving
};

std::vector<CellTrace> read_traces(const RunFolder& run) {
  std::vector<CellTrace> traces;
  if (!std::filesystem::exists(run.path / "trace.csv")) return traces;
  const RecordOf record_of = records_by_cell(run);
  std::string last;
  read_trace(run.path / "trace.csv", [&](TraceRecord&& point) {
    if (traces.empty() || point.cell != last) {
      const auto found = record_of.find(point.cell);
      traces.push_back({found == record_of.end() ? nullptr : found->second, {}});
      last = point.cell;
    }
    traces.back().steps.push_back({point.evaluations, static_cast<float>(point.cpu_s),
                                   static_cast<float>(point.train_error)});
  });
  std::erase_if(traces, [](const CellTrace& trace) { return trace.record == nullptr; });
  return traces;
}

double spent(const Step& step, bool cpu) {
  return cpu ? static_cast<double>(step.cpu_s) : static_cast<double>(step.evaluations);
}

// Best error of a cell when `x` was spent; infinite before its first formula.
double best_at(const CellTrace& trace, double x, bool cpu) {
  double best = kInfinity;
  for (const Step& step : trace.steps) {
    if (spent(step, cpu) > x) break;
    best = std::min(best, static_cast<double>(step.error));
  }
  return best;
}

std::vector<double> log_grid(const std::vector<const CellTrace*>& group, bool cpu) {
  double low = kInfinity;
  double high = 0;
  for (const CellTrace* trace : group) {
    for (const Step& step : trace->steps) {
      const double x = std::max(spent(step, cpu), cpu ? 1e-4 : 1.0);
      low = std::min(low, x);
      high = std::max(high, x);
    }
    // What was found last stands until the fit ends.
    const double end =
        cpu ? trace->record->fit_cpu_s : static_cast<double>(trace->record->evaluations);
    if (!trace->steps.empty() && end > high) high = end;
  }
  std::vector<double> grid;
  if (!(low <= high)) return grid;
  if (low == high) high = low * 1.01;
  for (std::size_t i = 0; i < kGridPoints; ++i) {
    grid.push_back(low * elementary::pow(high / low, static_cast<double>(i) / (kGridPoints - 1)));
  }
  grid.back() = high;
  return grid;
}

ordered_json trace_series(const GroupKey& key, const std::vector<const CellTrace*>& group,
                          bool cpu) {
  ordered_json x = ordered_json::array();
  ordered_json middle = ordered_json::array();
  ordered_json low = ordered_json::array();
  ordered_json high = ordered_json::array();
  for (const double at : log_grid(group, cpu)) {
    std::vector<double> errors;
    for (const CellTrace* trace : group) errors.push_back(best_at(*trace, at, cpu));
    const Spread spread = spread_of(errors);
    if (std::isinf(spread.high)) continue;  // some seed has no formula yet
    x.push_back(at);
    middle.push_back(finite_or_null(spread.middle));
    low.push_back(finite_or_null(spread.low));
    high.push_back(finite_or_null(spread.high));
  }
  return {{"problem", std::get<0>(key)},
          {"method", std::get<1>(key)},
          {"operators", std::get<2>(key)},
          {"axis", cpu ? "cpu" : "evaluations"},
          {"x", x},
          {"middle", middle},
          {"low", low},
          {"high", high}};
}

// Evaluations at which each target was reached, sorted, for a method under an operator set.
struct Reached {
  std::vector<double> at;
  std::size_t targets = 0;
};

ordered_json steps_json(std::string_view operators, std::string_view method, std::vector<double> at,
                        std::size_t total) {
  std::sort(at.begin(), at.end());
  ordered_json x = ordered_json::array();
  ordered_json share = ordered_json::array();
  const std::size_t stride = std::max<std::size_t>(1, at.size() / kProfilePoints);
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (i % stride != 0 && i + 1 != at.size()) continue;
    x.push_back(at[i]);
    share.push_back(static_cast<double>(i + 1) / static_cast<double>(total));
  }
  return {{"operators", operators}, {"method", method}, {"x", x}, {"share", share}};
}

ordered_json ecdf_of(const std::vector<CellTrace>& traces) {
  std::map<std::pair<std::string, std::uint64_t>, double> best;  // of a problem and seed
  for (const CellTrace& trace : traces) {
    double& known =
        best.try_emplace({trace.record->problem, trace.record->seed}, kInfinity).first->second;
    known = std::min(known, best_at(trace, kInfinity, false));
  }
  std::map<std::pair<std::string, std::string>, Reached> reached;  // operators, method
  for (const CellTrace& trace : traces) {
    const double goal = best.at({trace.record->problem, trace.record->seed});
    Reached& group = reached[{trace.record->operators, trace.record->method}];
    for (const double target : kTargets) {
      ++group.targets;
      for (const Step& step : trace.steps) {
        if (!(static_cast<double>(step.error) <= target * goal)) continue;
        group.at.push_back(std::max(1.0, static_cast<double>(step.evaluations)));
        break;
      }
    }
  }
  ordered_json all = ordered_json::array();
  for (auto& [key, group] : reached) {
    all.push_back(steps_json(key.first, key.second, std::move(group.at), group.targets));
  }
  return all;
}

// A fixed form's series stand under every operator set, as its rows do.
void repeat_fixed_forms(ordered_json& series, const RunSummary& summary) {
  ordered_json repeated = ordered_json::array();
  for (const ordered_json& each : series) {
    if (each["operators"] != "-" || summary.operators == std::vector<std::string>{"-"}) {
      repeated.push_back(each);
      continue;
    }
    for (const std::string& set : summary.operators) {
      ordered_json copy = each;
      copy["operators"] = set;
      repeated.push_back(std::move(copy));
    }
  }
  series = std::move(repeated);
}

}  // namespace

ordered_json finite_or_null(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json fronts_json(const RunFolder& run) {
  ordered_json all = ordered_json::array();
  if (!std::filesystem::exists(run.path / "front.csv")) return all;
  const RecordOf record_of = records_by_cell(run);
  std::map<GroupKey, std::vector<FrontRecord>> groups;
  read_front(run.path / "front.csv", [&](FrontRecord&& front) {
    const auto found = record_of.find(front.cell);
    if (found == record_of.end() || !std::isfinite(front.mae_test)) return;
    const Record& record = *found->second;
    auto& group = groups[{record.problem, record.method, record.operators}];
    group.push_back(std::move(front));
    if (group.size() > 20 * kFrontPoints) thin_front(group, 10 * kFrontPoints);
  });
  const std::size_t most =
      std::clamp<std::size_t>(kAllFrontPoints / (groups.size() + 1), 8, kFrontPoints);
  for (auto& [key, group] : groups) {
    thin_front(group, most);
    for (const FrontRecord& front : group) {
      all.push_back({{"problem", std::get<0>(key)},
                     {"method", std::get<1>(key)},
                     {"operators", std::get<2>(key)},
                     {"cell", front.cell},
                     {"complexity", front.complexity},
                     {"mae", front.mae_test},
                     {"singularity", record_word(front.singularity)},
                     {"chosen", front.chosen},
                     {"formula", front.formula}});
    }
  }
  return all;
}

ordered_json traces_json(const RunFolder& run, const RunSummary& summary, ordered_json& ecdf) {
  const std::vector<CellTrace> traces = read_traces(run);
  std::map<GroupKey, std::vector<const CellTrace*>> groups;
  for (const CellTrace& trace : traces) {
    groups[{trace.record->problem, trace.record->method, trace.record->operators}].push_back(
        &trace);
  }
  ordered_json all = ordered_json::array();
  for (const auto& [key, group] : groups) {
    all.push_back(trace_series(key, group, false));
    all.push_back(trace_series(key, group, true));
  }
  ecdf = ecdf_of(traces);
  repeat_fixed_forms(ecdf, summary);
  return all;
}

ordered_json profiles_json(const RunFolder& run, const RunSummary& summary) {
  // The best of a problem and seed counts over the operator set and the fixed forms.
  using Cell = std::pair<std::string, std::uint64_t>;
  ordered_json all = ordered_json::array();
  for (const std::string& set : summary.operators) {
    std::map<Cell, double> best;
    const auto belongs = [&](const Record& r) { return r.operators == set || r.operators == "-"; };
    for (const Record& record : run.records) {
      if (!belongs(record) || !is_ok(record) || std::isnan(record.mae_test)) continue;
      double& known = best.try_emplace({record.problem, record.seed}, kInfinity).first->second;
      known = std::min(known, record.mae_test);
    }
    std::map<std::string, Reached> methods;
    for (const Record& record : run.records) {
      if (!belongs(record)) continue;
      Reached& group = methods[record.method];
      ++group.targets;
      const auto found = best.find({record.problem, record.seed});
      if (found == best.end() || !is_ok(record)) continue;
      const double factor = record.mae_test == found->second ? 1 : record.mae_test / found->second;
      if (std::isfinite(factor)) group.at.push_back(factor);
    }
    for (auto& [method, group] : methods) {
      all.push_back(steps_json(set, method, std::move(group.at), group.targets));
    }
  }
  return all;
}

ordered_json curves_json(const RunFolder& run) {
  ordered_json all = ordered_json::array();
  if (!std::filesystem::exists(run.path / "curves.csv")) return all;
  using CurveKey = std::array<std::string, 7>;
  std::map<CurveKey, std::pair<ordered_json, ordered_json>> curves;
  std::size_t points = 0;
  read_curves(run.path / "curves.csv", [&](CurveRecord&& p) {
    if (++points > kCurvePoints) return;
    auto& [x, y] =
        curves[{p.problem, p.picture, p.method, p.operators, p.curve, p.x_name, p.y_name}];
    x.push_back(finite_or_null(p.x));
    y.push_back(finite_or_null(p.y));
  });
  for (auto& [key, values] : curves) {
    all.push_back({{"problem", key[0]},
                   {"picture", key[1]},
                   {"method", key[2]},
                   {"operators", key[3]},
                   {"curve", key[4]},
                   {"x_name", key[5]},
                   {"y_name", key[6]},
                   {"x", std::move(values.first)},
                   {"y", std::move(values.second)}});
  }
  return all;
}

}  // namespace tribench
