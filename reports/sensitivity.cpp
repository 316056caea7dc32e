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
#include <unordered_map>

#include "reports/figures.hpp"
#include "reports/markdown.hpp"
#include "reports/record_csv.hpp"
#include "reports/statistics/rank_tests.hpp"

namespace tribench {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array kBudgetShares = {0.001, 0.01, 0.1, 1.0};

using MeanRanks = std::map<std::string, double>;  // by method
// What places a record: infinite where it gave nothing, NaN where the figure does not exist for
// anybody.
using Placing = std::function<double(const Record&)>;
using Chosen = std::function<bool(const Record&)>;

// Mean ranks of `methods` over the problems where each of them has a place.
MeanRanks mean_ranks(const std::vector<const Record*>& records,
                     const std::vector<std::string>& methods, const Placing& placing,
                     const Chosen& chosen) {
  std::map<std::string, std::map<std::string, std::vector<double>>> figures;
  for (const Record* record : records) {
    if (!chosen(*record)) continue;
    const double figure = placing(*record);
    if (!std::isnan(figure)) figures[record->problem][record->method].push_back(figure);
  }
  std::vector<double> values;
  for (const auto& [problem, by_method] : figures) {
    const bool complete =
        std::ranges::all_of(methods, [&](const auto& m) { return by_method.contains(m); });
    if (!complete) continue;
    std::vector<double> row;
    for (const std::string& method : methods) row.push_back(median(by_method.at(method)));
    // A problem where nobody has a figure says nothing.
    if (std::ranges::any_of(row, [](double x) { return std::isfinite(x); })) {
      values.insert(values.end(), row.begin(), row.end());
    }
  }
  MeanRanks ranks;
  if (values.empty()) return ranks;
  const FriedmanTest test = friedman(values, methods.size(), kLevel);
  for (std::size_t i = 0; i < methods.size(); ++i) ranks[methods[i]] = test.mean_ranks[i];
  return ranks;
}

class Variations {
 public:
  Variations(const RunFolder& run, const Ranking& ranking) : ranking_(ranking) {
    const std::set<std::string> ranked(ranking.methods.begin(), ranking.methods.end());
    for (const Record& record : run.records) {
      const bool belongs = record.operators == ranking.operators || record.operators == "-";
      if (!belongs || !ranked.contains(record.method)) continue;
      records_.push_back(&record);
      seeds_.insert(record.seed);
      problems_.insert(record.problem);
    }
  }

  void add_metrics() {
    const std::pair<const char*, double Record::*> metrics[] = {
        {"root mean square error", &Record::rmse_test},
        {"largest error", &Record::max_error_test},
        {"error to the truth", &Record::mae_truth}};
    for (const auto& [name, member] : metrics) {
      RankingVariation variation{name, 0, {}, kMissing};
      // Missing for everybody where the truth is not known; a failed cell is placed last.
      add(
          variation,
          [member = member](const Record& r) { return is_ok(r) ? r.*member : kInfinity; }, all());
      keep(std::move(variation));
    }
  }

  void add_seed_halves() {
    const std::vector<std::uint64_t> seeds(seeds_.begin(), seeds_.end());
    if (seeds.size() < 2) return;
    RankingVariation variation{"half of the seeds", 0, {}, kMissing};
    const std::size_t middle = seeds.size() / 2;
    const auto place_of = [&](const Record& r) {
      return static_cast<std::size_t>(std::ranges::lower_bound(seeds, r.seed) - seeds.begin());
    };
    for (const bool first : {true, false}) {
      add(variation, by_mae(), [&](const Record& r) { return (place_of(r) < middle) == first; });
      if (seeds.size() < 4) continue;  // the same halves again
      add(variation, by_mae(), [&](const Record& r) { return (place_of(r) % 2 == 0) == first; });
    }
    keep(std::move(variation));
  }

  void add_left_out_problems() {
    if (problems_.size() < 3) return;
    RankingVariation variation{"without one of the problems", 0, {}, kMissing};
    for (const std::string& problem : problems_) {
      add(variation, by_mae(), [&](const Record& r) { return r.problem != problem; });
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
  static Placing by_mae() {
    return [](const Record& r) {
      return is_ok(r) && !std::isnan(r.mae_test) ? r.mae_test : kInfinity;
    };
  }

  void add(RankingVariation& variation, const Placing& placing, const Chosen& chosen) const {
    const MeanRanks ranks = mean_ranks(records_, ranking_.methods, placing, chosen);
    if (ranks.empty()) return;
    std::vector<double> now;
    for (const std::string& method : ranking_.methods) now.push_back(ranks.at(method));
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
  std::vector<const Record*> records_;
  std::set<std::uint64_t> seeds_;
  std::set<std::string> problems_;
  std::vector<RankingVariation> variations_;
};

using BestByCell = std::unordered_map<std::string, std::array<double, kBudgetShares.size()>>;

BestByCell best_at_budgets(const RunFolder& run) {
  BestByCell best;
  if (!std::filesystem::exists(run.path / "trace.csv")) return best;
  std::uint64_t most = 0;
  for (const Record& record : run.records) most = std::max(most, record.evaluations);
  read_trace(run.path / "trace.csv", [&](TraceRecord&& point) {
    const auto [place, is_new] = best.try_emplace(point.cell);
    auto& at = place->second;
    if (is_new) at.fill(kInfinity);
    for (std::size_t i = 0; i < kBudgetShares.size(); ++i) {
      const bool within =
          static_cast<double>(point.evaluations) <= kBudgetShares[i] * static_cast<double>(most);
      if (within) at[i] = std::min(at[i], point.train_error);
    }
  });
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
