// SPDX-License-Identifier: MIT
#include "reports/sensitivity.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <unordered_map>

#include "reports/figures.hpp"
#include "reports/markdown.hpp"
#include "reports/record/record_csv.hpp"
#include "reports/statistics/rank_tests.hpp"

namespace tribench {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array kBudgetShares = {0.001, 0.01, 0.1, 1.0};

// What places a record: infinite where it gave nothing, NaN where the figure does not exist for
// anybody.
using Placing = std::function<double(const Record&)>;
using Chosen = std::function<bool(const Record&)>;

// A record with the places of its problem and method.
struct Placed {
  const Record* record;
  std::size_t problem;
  std::size_t method;
};

class Variations {
 public:
  Variations(const RunFolder& run, const Ranking& ranking) : ranking_(ranking) {
    std::map<std::string, std::size_t> methods;
    for (const std::string& method : ranking.methods) methods.emplace(method, methods.size());
    std::map<std::string, std::size_t> problems;
    std::set<std::uint64_t> seeds;
    for (const Record& record : run.records) {
      const bool belongs = record.operators == ranking.operators || record.operators == "-";
      const auto method = methods.find(record.method);
      if (!belongs || method == methods.end()) continue;
      const std::size_t problem =
          problems.try_emplace(record.problem, problems.size()).first->second;
      records_.push_back({&record, problem, method->second});
      seeds.insert(record.seed);
    }
    problems_ = problems.size();
    seeds_.assign(seeds.begin(), seeds.end());
  }

  void add_metrics() {
    const std::pair<const char*, double Record::*> metrics[] = {
        {"root mean square error", &Record::rmse_test},
        {"largest error", &Record::max_error_test},
        {"error to the truth", &Record::mae_truth}};
    for (const auto& [name, member] : metrics) {
      RankingVariation variation{name, 0, {}, kMissing};
      // Missing for every method where the truth is not known; a failed cell is placed last.
      add(
          variation,
          [member = member](const Record& r) { return is_ok(r) ? r.*member : kInfinity; }, all());
      keep(std::move(variation));
    }
  }

  void add_seed_halves() {
    if (seeds_.size() < 2) return;
    RankingVariation variation{"half of the seeds", 0, {}, kMissing};
    const std::size_t middle = seeds_.size() / 2;
    const auto place_of = [&](const Record& r) {
      return static_cast<std::size_t>(std::ranges::lower_bound(seeds_, r.seed) - seeds_.begin());
    };
    for (const bool first : {true, false}) {
      add(variation, by_mae(), [&](const Record& r) { return (place_of(r) < middle) == first; });
      if (seeds_.size() < 4) continue;  // the same halves again
      add(variation, by_mae(), [&](const Record& r) { return (place_of(r) % 2 == 0) == first; });
    }
    keep(std::move(variation));
  }

  void add_left_out_problems() {
    if (problems_ < 3) return;
    RankingVariation variation{"without one of the problems", 0, {}, kMissing};
    const std::vector<double> places = medians(by_mae(), all());
    const auto methods = static_cast<std::ptrdiff_t>(ranking_.methods.size());
    for (std::size_t left_out = 0; left_out < problems_; ++left_out) {
      std::vector<double> others = places;
      const auto from = others.begin() + static_cast<std::ptrdiff_t>(left_out) * methods;
      others.erase(from, from + methods);
      add(variation, others);
    }
    keep(std::move(variation));
  }

  // best: by cell, at each of kBudgetShares.
  void add_budgets(
      const std::unordered_map<std::string, std::array<double, kBudgetShares.size()>>& best) {
    for (std::size_t i = 0; i < kBudgetShares.size() && !best.empty(); ++i) {
      const std::string share = kBudgetShares[i] == 1
                                    ? std::string("the whole budget")
                                    : fmt::format("{:g} % of the budget", 100 * kBudgetShares[i]);
      RankingVariation variation{"training error after " + share, 0, {}, kMissing};
      add(
          variation,
          [&](const Record& r) {
            const auto found = best.find(r.cell);
            return found == best.end() ? kInfinity : found->second[i];
          },
          all());
      keep(std::move(variation));
    }
  }

  std::vector<RankingVariation> take() { return std::move(variations_); }

 private:
  static Chosen all() {
    return [](const Record&) { return true; };
  }
  static Placing by_mae() { return placing_error; }

  // By problem, then method: the median over the cells, NaN where there is none.
  std::vector<double> medians(const Placing& placing, const Chosen& chosen) const {
    const std::size_t methods = ranking_.methods.size();
    std::vector<std::vector<double>> figures(problems_ * methods);
    for (const Placed& each : records_) {
      if (!chosen(*each.record)) continue;
      figures[each.problem * methods + each.method].push_back(placing(*each.record));
    }
    std::vector<double> middle;
    for (const std::vector<double>& values : figures) middle.push_back(median(values));
    return middle;
  }

  void add(RankingVariation& variation, const Placing& placing, const Chosen& chosen) const {
    add(variation, medians(placing, chosen));
  }

  // Ranks over the problems where every method has a place and somebody a finite one.
  void add(RankingVariation& variation, const std::vector<double>& places) const {
    const std::size_t methods = ranking_.methods.size();
    std::vector<double> values;
    for (std::size_t at = 0; at < places.size(); at += methods) {
      const std::span<const double> row(&places[at], methods);
      if (std::ranges::any_of(row, [](double x) { return std::isnan(x); })) continue;
      if (std::ranges::none_of(row, [](double x) { return std::isfinite(x); })) continue;
      values.insert(values.end(), row.begin(), row.end());
    }
    if (values.empty()) return;
    const std::vector<double> now = friedman(values, methods, kLevel).mean_ranks;
    const double tau = kendall_tau(ranking_.test.mean_ranks, now);
    // Of equal ranks the one that the leaderboard has first.
    const auto first = std::ranges::min_element(now) - now.begin();
    ++variation.leaders[ranking_.methods[static_cast<std::size_t>(first)]];
    ++variation.count;
    if (!(tau >= variation.least_tau)) variation.least_tau = tau;
  }

  void keep(RankingVariation&& variation) {
    if (variation.count > 0) variations_.push_back(std::move(variation));
  }

  const Ranking& ranking_;
  std::vector<Placed> records_;
  std::vector<std::uint64_t> seeds_;  // sorted
  std::size_t problems_ = 0;
  std::vector<RankingVariation> variations_;
};

using BestByCell = std::unordered_map<std::string, std::array<double, kBudgetShares.size()>>;

// What an external program says of its way is a claim: no more evaluations than the budget, and no
// error below that of the formula which it gave in the end. What has said nothing has its formula
// after all of its evaluations.
BestByCell best_at_budgets(const RunFolder& run) {
  BestByCell best;
  if (!std::filesystem::exists(run.path / "trace.csv")) return best;
  std::unordered_map<std::string_view, const Record*> by_cell;
  std::uint64_t most = 0;
  for (const Record& record : run.records) {
    by_cell.emplace(record.cell, &record);
    most = std::max(most, record.evaluations);
  }
  if (run.budget > 0) most = std::min(most, run.budget);
  const auto add = [&](const std::string& cell, std::uint64_t evaluations, double error) {
    const auto [place, is_new] = best.try_emplace(cell);
    auto& at = place->second;
    if (is_new) at.fill(kInfinity);
    const auto spent = static_cast<double>(std::min(evaluations, most));
    for (std::size_t i = 0; i < kBudgetShares.size(); ++i) {
      if (spent <= kBudgetShares[i] * static_cast<double>(most)) at[i] = std::min(at[i], error);
    }
  };
  read_trace(run.path / "trace.csv", [&](TraceRecord&& point) {
    const auto found = by_cell.find(point.cell);
    const bool is_judged = found != by_cell.end() && is_ok(*found->second);
    const double judged = is_judged ? found->second->mae_train : kMissing;
    add(point.cell, point.evaluations,
        std::isnan(judged) ? point.train_error : std::max(point.train_error, judged));
  });
  for (const Record& record : run.records) {
    if (!is_ok(record) || std::isnan(record.mae_train)) continue;
    add(record.cell, record.evaluations == 0 ? most : record.evaluations, record.mae_train);
  }
  return best;
}

std::string leaders_text(const RankingVariation& variation) {
  std::vector<std::string> parts;
  for (const auto& [method, count] : variation.leaders) {
    parts.push_back(variation.count == 1 ? method : fmt::format("{} {}", method, count));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

std::vector<Sensitivity> ranking_sensitivity(const RunFolder& run, const RunSummary& summary) {
  std::vector<Sensitivity> all;
  const BestByCell best = best_at_budgets(run);
  for (const Ranking& ranking : summary.rankings) {
    if (ranking.methods.size() < 2 || ranking.test.blocks < 2) continue;
    Variations variations(run, ranking);
    variations.add_metrics();
    variations.add_seed_halves();
    variations.add_left_out_problems();
    variations.add_budgets(best);
    all.push_back({ranking.operators, ranking.methods.front(), variations.take()});
  }
  return all;
}

std::string reading_of(const Sensitivity& sensitivity) {
  std::size_t rankings = 0;
  std::size_t led = 0;
  std::vector<std::string> others;
  for (const RankingVariation& variation : sensitivity.variations) {
    rankings += variation.count;
    const auto found = variation.leaders.find(sensitivity.leader);
    const std::size_t same = found == variation.leaders.end() ? 0 : found->second;
    led += same;
    if (same < variation.count) others.push_back(variation.what);
  }
  std::string text = fmt::format("{} leads in {} of {} rankings made otherwise", sensitivity.leader,
                                 led, rankings);
  return others.empty() ? text + "."
                        : fmt::format("{}; somebody else with: {}.", text, fmt::join(others, "; "));
}

std::string sensitivity_section(const std::vector<Sensitivity>& all) {
  if (all.empty()) return {};
  std::string text =
      "\n## Would the ranking be another one?\n\n"
      "Mean ranks again, made otherwise. *Agreement* is Kendall's tau with the ranking above (1: "
      "the "
      "same order,\n"
      "0: unrelated), the least of several. Training errors are what the trace knows: compare a "
      "share of the budget\n"
      "with the whole.\n";
  for (const Sensitivity& each : all) {
    MarkdownTable table(
        {{"made with"}, {"rankings", Align::right}, {"leader"}, {"agreement", Align::right}});
    for (const RankingVariation& variation : each.variations) {
      table.add({variation.what, fmt::format("{}", variation.count), leaders_text(variation),
                 fmt::format("{:.2f}", variation.least_tau)});
    }
    text +=
        fmt::format("\nOperators `{}`: {}\n\n{}", each.operators, reading_of(each), table.text());
  }
  return text;
}

nlohmann::ordered_json sensitivity_json(const std::vector<Sensitivity>& all) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (const Sensitivity& each : all) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const RankingVariation& variation : each.variations) {
      rows.push_back({{"what", variation.what},
                      {"count", variation.count},
                      {"leader", leaders_text(variation)},
                      {"tau", variation.least_tau}});
    }
    array.push_back(
        {{"operators", each.operators}, {"reading", reading_of(each)}, {"rows", std::move(rows)}});
  }
  return array;
}

}  // namespace tribench
