// SPDX-License-Identifier: MIT
#include "reports/summary.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "foundation/elementary.hpp"
#include "reports/statistics/log_ratios.hpp"
#include "reports/statistics/power.hpp"

namespace tribench {
namespace {

constexpr const char* kFixedForm = "-";
using Cells = std::vector<const Record*>;
using Key = std::tuple<std::string, std::string, std::string>;  // problem, operators, method

double median_over(const Cells& cells, double Record::*figure) {
  std::vector<double> values;
  for (const Record* record : cells) {
    if (is_ok(*record)) values.push_back(record->*figure);
  }
  return median(values);
}

template <typename Count>
double median_count(const Cells& cells, Count Record::*count) {
  std::vector<double> values;
  for (const Record* record : cells) {
    if (is_ok(*record)) values.push_back(static_cast<double>(record->*count));
  }
  return median(values);
}

void count_singularities(MethodRow& row, const Record& record) {
  if (record.singularity == Singularity::proved_free) ++row.proved_free;
  if (record.singularity == Singularity::undecided) ++row.undecided;
  if (record.singularity != Singularity::refuted) return;
  ++row.refuted;
  if (row.singular == nullptr) row.singular = &record;
}

// The cell that stands for the method in pictures: the largest error not above the median.
const Record* representative_of(const Cells& cells, double middle) {
  const Record* chosen = nullptr;
  for (const Record* record : cells) {
    if (!is_ok(*record) || !(record->mae_test <= middle)) continue;
    if (chosen == nullptr || record->mae_test > chosen->mae_test) chosen = record;
  }
  return chosen;
}

YardstickRatio ratio_to(const Cells& cells, double Record::*yardstick) {
  std::vector<double> ratios;
  for (const Record* record : cells) {
    if (record->*yardstick > 0) ratios.push_back(placing_error(*record) / (record->*yardstick));
  }
  return {median(ratios), median_interval(ratios, 1 - kLevel)};
}

MethodRow row_of(const Cells& cells) {
  MethodRow row;
  row.method = cells.front()->method;
  row.operators = cells.front()->operators;
  row.cells = cells.size();
  std::vector<double> errors;  // of cells that have one
  std::vector<double> all;     // infinite where a cell has none
  std::vector<double> placing;
  for (const Record* record : cells) {
    placing.push_back(placing_error(*record));
    all.push_back(is_ok(*record) ? record->mae_test : HUGE_VAL);
    count_singularities(row, *record);
    if (is_ok(*record)) {
      errors.push_back(record->mae_test);
    } else {
      ++row.failed;
      ++row.reasons[reason_text(record->reason)];
    }
  }
  row.mae_test = spread_of(errors);
  const double middle = median(all);
  row.mae_test.middle = std::isinf(middle) ? kMissing : middle;
  row.placed_by = median(placing);
  row.mae_truth = median_over(cells, &Record::mae_truth);
  row.relative_error_test = median_over(cells, &Record::relative_error_test);
  row.fit_cpu_s = median_over(cells, &Record::fit_cpu_s);
  row.complexity = median_count(cells, &Record::complexity);
  row.complexity_adaptation = median_count(cells, &Record::complexity_adaptation);
  row.evaluations = median_count(cells, &Record::evaluations);
  row.ceiling = ratio_to(cells, &Record::mae_ceiling);
  row.refitted = ratio_to(cells, &Record::mae_refitted);
  row.representative = representative_of(cells, middle);
  return row;
}

// Over the seeds that both have.
LogRatios errors_over(const Cells& best, const Cells& cells) {
  LogRatios ratios;
  auto other = best.begin();
  for (const Record* record : cells) {  // both in the order of seeds
    while (other != best.end() && (*other)->seed < record->seed) ++other;
    if (other == best.end()) break;
    if ((*other)->seed == record->seed) ratios.add(placing_error(**other), placing_error(*record));
  }
  return ratios;
}

// Whether a seed more or less could not make it a difference of use: by the interval of the median,
// or all seeds where they are too few for one; and no seed failed in one of the two alone. Without
// a common seed (of an unfinished run) nothing is known.
bool is_equivalent(const std::vector<double>& ratios) {
  if (ratios.empty()) return false;
  if (std::ranges::any_of(ratios, [](double r) { return std::isinf(r); })) return false;
  const double most = elementary::log1p(kEquivalence);
  ConfidenceInterval interval = median_interval(ratios, 1 - kLevel);
  if (std::isnan(interval.low)) {
    const auto [low, high] = std::ranges::minmax(ratios);
    interval = {low, high};
  }
  return -most <= interval.low && interval.high <= most;
}

Standing stand(const MethodRow& row, const std::vector<double>& ratios, double smallest_p) {
  if (std::isinf(row.placed_by)) return Standing::failed;
  if (is_equivalent(ratios)) return Standing::equivalent;
  if (row.p <= kLevel) return Standing::behind;
  const bool every_seed =
      !ratios.empty() && std::all_of(ratios.begin(), ratios.end(), [](double r) { return r > 0; });
  if (smallest_p > kLevel && every_seed) return Standing::behind_untested;
  return Standing::not_distinguishable;
}

void hold_against_best(std::vector<MethodRow>& rows, const std::vector<const Cells*>& cells) {
  if (rows.empty() || std::isinf(rows.front().placed_by)) {
    for (MethodRow& row : rows) row.standing = Standing::failed;
    return;
  }
  rows.front().standing = Standing::best;
  rows.front().ratio = 1;
  std::vector<std::vector<double>> ratios(rows.size());
  std::vector<double> p(rows.size(), kMissing);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const LogRatios to_best = errors_over(*cells[0], *cells[i]);
    ratios[i] = to_best.distinct();
    rows[i].pairs = ratios[i].size();
    rows[i].ratio = elementary::exp(median(to_best.all()));
    if (!std::isinf(rows[i].placed_by)) p[i] = wilcoxon_signed_rank(ratios[i]).p;
  }
  const std::vector<double> adjusted = holm(p);
  const auto tests = static_cast<double>(
      std::count_if(p.begin(), p.end(), [](double value) { return !std::isnan(value); }));
  for (std::size_t i = 1; i < rows.size(); ++i) {
    rows[i].p = adjusted[i];
    rows[i].standing = stand(rows[i], ratios[i], tests * smallest_signed_rank_p(rows[i].pairs));
    if (rows[i].standing == Standing::not_distinguishable) {
      // As the first of Holm's steps has it.
      rows[i].seen_ratio = elementary::exp(smallest_seen_shift(ratios[i], kLevel / tests));
    }
  }
}

// Median over the seeds of a figure that belongs to a problem and seed, whatever the method.
double median_over_seeds(const std::vector<const Cells*>& methods, double Record::*figure) {
  std::map<std::uint64_t, double> of_seed;
  for (const Cells* cells : methods) {
    for (const Record* record : *cells) {
      if (!std::isnan(record->*figure)) of_seed.emplace(record->seed, record->*figure);
    }
  }
  std::vector<double> values;
  for (const auto& [seed, value] : of_seed) values.push_back(value);
  return median(values);
}

ProblemTable table_of(const std::string& problem, const std::string& operators,
                      const std::vector<const Cells*>& methods) {
  std::vector<std::pair<MethodRow, const Cells*>> both;
  for (const Cells* cells : methods) both.emplace_back(row_of(*cells), cells);
  std::sort(both.begin(), both.end(), [](const auto& a, const auto& b) {
    return std::tie(a.first.placed_by, a.first.failed, a.first.method) <
           std::tie(b.first.placed_by, b.first.failed, b.first.method);
  });
  ProblemTable table{problem,
                     operators,
                     {},
                     0,
                     median_over_seeds(methods, &Record::mae_ceiling),
                     median_over_seeds(methods, &Record::mae_law),
                     median_over_seeds(methods, &Record::mae_refitted)};
  std::vector<const Cells*> cells;
  for (auto& [row, of] : both) {
    table.seeds = std::max(table.seeds, row.cells);
    table.rows.push_back(std::move(row));
    cells.push_back(of);
  }
  hold_against_best(table.rows, cells);
  return table;
}

Ranking rank_methods(const std::string& operators, const std::vector<ProblemTable>& tables) {
  std::map<std::string, std::vector<double>> by_method;
  std::size_t blocks = 0;
  for (const ProblemTable& table : tables) {
    if (table.operators != operators) continue;
    ++blocks;
    for (const MethodRow& row : table.rows) by_method[row.method].push_back(row.placed_by);
  }
  Ranking ranking;
  ranking.operators = operators;
  std::vector<std::string> methods;
  for (const auto& [method, values] : by_method) {
    (values.size() == blocks ? methods : ranking.left_out).push_back(method);
  }
  std::vector<double> values;
  for (std::size_t b = 0; b < blocks; ++b) {
    for (const std::string& method : methods) values.push_back(by_method[method][b]);
  }
  ranking.test = friedman(values, methods.size(), kLevel);
  std::vector<std::size_t> order(methods.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const std::vector<double> ranks = ranking.test.mean_ranks;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return ranks[a] < ranks[b]; });
  for (std::size_t i = 0; i < order.size(); ++i) {
    ranking.methods.push_back(methods[order[i]]);
    ranking.test.mean_ranks[i] = ranks[order[i]];
  }
  return ranking;
}

std::vector<Failure> failures_of(const std::vector<Record>& records) {
  std::map<std::pair<std::string, std::string>, Cells> by_reason;
  for (const Record& record : records) {
    if (!is_ok(record)) by_reason[{record.method, reason_text(record.reason)}].push_back(&record);
  }
  std::vector<Failure> failures;
  for (auto& [key, cells] : by_reason) {
    failures.push_back({key.first, key.second, std::move(cells)});
  }
  std::stable_sort(failures.begin(), failures.end(), [](const Failure& a, const Failure& b) {
    return a.cells.size() > b.cells.size();
  });
  return failures;
}

std::map<Key, std::size_t> missing_by_key(const RunFolder& run) {
  std::map<Key, std::size_t> missing;
  for (const PlannedCell& cell : run.missing) {
    ++missing[{cell.problem, cell.operators, cell.method}];
  }
  return missing;
}

}  // namespace

RunSummary summarise(const RunFolder& run) {
  RunSummary summary;
  summary.cells = run.records.size();
  summary.failed = run.failed();
  std::map<Key, Cells> groups;
  std::set<std::string> problems;
  std::set<std::string> operators;
  for (const Record& record : run.records) {
    groups[{record.problem, record.operators, record.method}].push_back(&record);
    problems.insert(record.problem);
    operators.insert(record.operators);
    if (!std::isnan(record.fit_cpu_s)) summary.fit_cpu_s += record.fit_cpu_s;
  }
  if (operators.size() > 1) operators.erase(kFixedForm);
  summary.problems.assign(problems.begin(), problems.end());
  summary.operators.assign(operators.begin(), operators.end());
  const std::map<Key, std::size_t> missing = missing_by_key(run);
  std::map<std::pair<std::string, std::string>, std::vector<const Cells*>> by_table;
  for (const auto& [key, cells] : groups) {
    const auto& [problem, set, method] = key;
    if (set != kFixedForm) {
      by_table[{problem, set}].push_back(&cells);
    } else {
      for (const std::string& each : summary.operators) by_table[{problem, each}].push_back(&cells);
    }
  }
  for (const auto& [key, methods] : by_table) {
    summary.tables.push_back(table_of(key.first, key.second, methods));
    for (MethodRow& row : summary.tables.back().rows) {
      const auto found = missing.find({key.first, row.operators, row.method});
      if (found != missing.end()) row.missing = found->second;
    }
  }
  for (const std::string& set : summary.operators) {
    summary.rankings.push_back(rank_methods(set, summary.tables));
  }
  summary.failures = failures_of(run.records);
  return summary;
}

}  // namespace tribench
