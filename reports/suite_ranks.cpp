// SPDX-License-Identifier: MIT
#include "reports/suite_ranks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <utility>

#include "foundation/json_text.hpp"
#include "foundation/order_statistics.hpp"
#include "reports/figures.hpp"
#include "reports/markdown.hpp"

namespace tribench {
namespace {

using nlohmann::ordered_json;
using Results = std::vector<const SuiteResult*>;
using Cells = std::vector<const Record*>;  // of one method with one operator set, a seed each

// The middle of all cells' R2, failed ones below all others.
std::optional<double> middle_r2(const Cells& records) {
  std::vector<double> values;
  for (const Record* one : records) {
    if (is_ok(*one)) values.push_back(one->r2_test);
  }
  std::ranges::sort(values);
  const std::size_t failed = records.size() - values.size();
  const std::size_t low = (records.size() - 1) / 2;
  if (low < failed) return std::nullopt;
  return 0.5 * (values[low - failed] + values[records.size() / 2 - failed]);
}

std::size_t rank_in(const Results& published, std::optional<double> r2) {
  const auto is_better = [&](const SuiteResult* one) { return !r2 || one->r2 > *r2; };
  return 1 + static_cast<std::size_t>(std::ranges::count_if(published, is_better));
}

Results symbolic_of(const Results& all) {
  Results some;
  std::ranges::copy_if(all, std::back_inserter(some), &SuiteResult::symbolic);
  return some;
}

// Ours on one table, a method at a time.
std::vector<Cells> cells_on(const std::string& table, const std::vector<Record>& records) {
  std::vector<Cells> methods;
  for (const Record& record : records) {
    if (record.problem != table) continue;
    const auto same = std::ranges::find_if(methods, [&](const Cells& one) {
      return one.front()->method == record.method && one.front()->operators == record.operators;
    });
    if (same == methods.end()) {
      methods.push_back({&record});
    } else {
      same->push_back(&record);
    }
  }
  return methods;
}

TableRank table_rank(const Cells& records, const Results& published) {
  TableRank out;
  out.problem = records.front()->problem;
  out.method = records.front()->method;
  out.operators = records.front()->operators;
  out.r2 = middle_r2(records);
  out.rank = rank_in(published, out.r2);
  out.symbolic_rank = rank_in(symbolic_of(published), out.r2);
  std::vector<double> seconds;
  for (const Record* one : records) seconds.push_back(one->fit_cpu_s);
  out.seconds = median(seconds);
  return out;
}

// One method's ranks over the tables.
struct Ranks {
  std::vector<double> all;
  std::vector<double> symbolic;
  std::vector<double> seconds;

  RankedMethod row(std::string method, std::string operators, bool is_symbolic) const {
    RankedMethod out{std::move(method), std::move(operators), is_symbolic, all.size(), median(all)};
    for (const double rank : all) out.rank_mean += rank / static_cast<double>(all.size());
    if (is_symbolic) out.symbolic_rank_median = median(symbolic);
    out.seconds = median(seconds);
    return out;
  }
};

std::set<std::string> methods_of(const Results& results) {
  std::set<std::string> names;
  for (const SuiteResult* one : results) names.insert(one->method);
  return names;
}

std::vector<RankedMethod> ranked(const std::vector<TableRank>& ours,
                                 const std::map<std::string, Results>& published) {
  std::map<std::pair<std::string, std::string>, Ranks> methods;  // of ours
  for (const TableRank& one : ours) {
    Ranks& ranks = methods[{one.method, one.operators}];
    ranks.all.push_back(static_cast<double>(one.rank));
    ranks.symbolic.push_back(static_cast<double>(one.symbolic_rank));
    ranks.seconds.push_back(one.seconds);
  }
  std::vector<RankedMethod> out;
  for (const auto& [key, ranks] : methods) out.push_back(ranks.row(key.first, key.second, true));
  std::map<std::string, std::pair<bool, Ranks>> theirs;
  for (const auto& [table, results] : published) {
    for (const SuiteResult* one : results) {
      auto& [symbolic, ranks] = theirs[one->method];
      symbolic = one->symbolic;
      ranks.all.push_back(static_cast<double>(rank_in(results, one->r2)));
      ranks.symbolic.push_back(static_cast<double>(rank_in(symbolic_of(results), one->r2)));
      ranks.seconds.push_back(one->seconds);
    }
  }
  for (const auto& [method, one] : theirs) out.push_back(one.second.row(method, "", one.first));
  std::ranges::stable_sort(out, {}, &RankedMethod::rank_median);
  return out;
}

std::string r2_text(const std::optional<double>& r2) { return r2 ? figure(*r2) : "failed"; }

std::string result_text(const std::vector<SuiteResult>& all, const std::string& problem) {
  const auto found = std::ranges::find(all, problem, &SuiteResult::problem);
  return found == all.end() ? "-" : fmt::format("{} ({})", figure(found->r2), found->method);
}

std::string methods_table(const SuiteRanks& ranks) {
  MarkdownTable table({{"method"},
                       {"operators"},
                       {"median rank", Align::right},
                       {"mean", Align::right},
                       {"median among formulas", Align::right},
                       {"seconds a fit", Align::right}});
  for (const RankedMethod& one : ranks.methods) {
    const bool ours = !one.operators.empty();
    table.add({ours ? fmt::format("**{}**", one.method) : one.method,
               ours ? one.operators : "published", count_figure(one.rank_median),
               figure(one.rank_mean), one.symbolic ? count_figure(one.symbolic_rank_median) : "-",
               figure(one.seconds)});
  }
  return table.text();
}

// A line a table, a column a method of ours.
std::string tables_table(const SuiteRanks& ranks) {
  std::vector<std::pair<std::string, std::string>> columns;
  std::vector<std::string> problems;
  for (const TableRank& one : ranks.tables) {
    const std::pair column(one.method, one.operators);
    if (std::ranges::count(columns, column) == 0) columns.push_back(column);
    if (std::ranges::count(problems, one.problem) == 0) problems.push_back(one.problem);
  }
  std::vector<MarkdownTable::Heading> headings = {{"table"}};
  for (const auto& [method, operators] : columns) {
    headings.push_back({fmt::format("{}, {}", method, operators), Align::right});
  }
  headings.push_back({"best published formula"});
  headings.push_back({"best published"});
  MarkdownTable table(headings);
  for (const std::string& problem : problems) {
    std::vector<std::string> cells = {problem};
    for (const auto& column : columns) {
      const auto found = std::ranges::find_if(ranks.tables, [&](const TableRank& one) {
        return one.problem == problem && std::pair(one.method, one.operators) == column;
      });
      cells.push_back(found == ranks.tables.end() ? "-"
                                                  : fmt::format("{} ({}, {})", r2_text(found->r2),
                                                                found->symbolic_rank, found->rank));
    }
    cells.push_back(result_text(ranks.best_symbolic, problem));
    cells.push_back(result_text(ranks.best, problem));
    table.add(std::move(cells));
  }
  return table.text();
}

}  // namespace

SuiteRanks rank_among_published(const std::vector<SuiteResult>& published,
                                const std::vector<Record>& records) {
  std::map<std::string, Results> by_table;
  for (const SuiteResult& one : published) by_table[one.problem].push_back(&one);
  SuiteRanks out;
  std::set<std::set<std::string>> methods;  // of each table
  for (auto table = by_table.begin(); table != by_table.end();) {
    const std::vector<Cells> ours = cells_on(table->first, records);
    if (ours.empty()) {
      table = by_table.erase(table);
      continue;
    }
    const Results& results = table->second;
    for (const Cells& own : ours) out.tables.push_back(table_rank(own, results));
    out.best.push_back(**std::ranges::max_element(results, {}, &SuiteResult::r2));
    const Results formulas = symbolic_of(results);
    if (!formulas.empty()) {
      out.best_symbolic.push_back(**std::ranges::max_element(formulas, {}, &SuiteResult::r2));
    }
    methods.insert(methods_of(results));
    ++table;
  }
  if (methods.size() == 1 && by_table.size() > 1) out.methods = ranked(out.tables, by_table);
  return out;
}

std::string suite_ranks_markdown(const SuiteRanks& ranks) {
  if (ranks.tables.empty()) return {};
  std::string text;
  if (!ranks.methods.empty()) {
    text += fmt::format(
        "\nRanks by R2 on unseen rows over {} tables: each of ours among the published methods and "
        "itself, those among themselves; ours in CPU seconds, theirs as published.\n\n",
        ranks.best.size());
    text += methods_table(ranks);
  }
  text +=
      "\nR2 on unseen rows, the median over seeds; in brackets the rank among published formulas "
      "and "
      "among all that is published.\n\n";
  return text + tables_table(ranks);
}

ordered_json suite_ranks_json(const SuiteRanks& ranks) {
  ordered_json tables = ordered_json::array();
  for (const TableRank& one : ranks.tables) {
    tables.push_back({{"problem", one.problem},
                      {"method", one.method},
                      {"operators", one.operators},
                      {"r2", one.r2 ? ordered_json(*one.r2) : ordered_json(nullptr)},
                      {"rank", one.rank},
                      {"symbolic_rank", one.symbolic_rank},
                      {"best_formula", result_text(ranks.best_symbolic, one.problem)},
                      {"best", result_text(ranks.best, one.problem)}});
  }
  ordered_json methods = ordered_json::array();
  for (const RankedMethod& one : ranks.methods) {
    methods.push_back({{"method", one.method},
                       {"operators", one.operators},
                       {"symbolic", one.symbolic},
                       {"tables", one.tables},
                       {"rank_median", one.rank_median},
                       {"rank_mean", one.rank_mean},
                       {"symbolic_rank_median", json_number(one.symbolic_rank_median)},
                       {"seconds", json_number(one.seconds)}});
  }
  return {{"tables", tables}, {"methods", methods}};
}

ordered_json suite_results_json(const std::vector<SuiteResult>& results) {
  ordered_json array = ordered_json::array();
  for (const SuiteResult& one : results) {
    array.push_back({{"problem", one.problem},
                     {"method", one.method},
                     {"symbolic", one.symbolic},
                     {"r2", one.r2},
                     {"seconds", json_number(one.seconds)}});
  }
  return array;
}

std::vector<SuiteResult> suite_results_in(const nlohmann::json& json) {
  std::vector<SuiteResult> results;
  for (const nlohmann::json& one : json) {
    const nlohmann::json& seconds = one.at("seconds");
    results.push_back({one.at("problem"), one.at("method"), one.at("symbolic"), one.at("r2"),
                       seconds.is_null() ? kMissing : seconds.get<double>()});
  }
  return results;
}

}  // namespace tribench
