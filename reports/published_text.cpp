// SPDX-License-Identifier: MIT
//
// Published figures beside ours, for people (Markdown) and for the page (JSON).
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "foundation/json_text.hpp"
#include "reports/figures.hpp"
#include "reports/markdown.hpp"
#include "reports/published.hpp"

namespace tribench {
namespace {

using nlohmann::ordered_json;

std::string spread_text(const Spread& spread) {
  return spread.count < 2 ? std::string()
                          : fmt::format("{} .. {}", figure(spread.low), figure(spread.high));
}

std::string table_of(const PublishedProblem& problem) {
  MarkdownTable table({{"published"},
                       {"its MAE", Align::right},
                       {"its complexity", Align::right},
                       {"ours"},
                       {"operators"},
                       {"our MAE", Align::right},
                       {"over seeds", Align::right},
                       {"noise ceiling", Align::right},
                       {"law refitted", Align::right},
                       {"against the ceiling", Align::right},
                       {"against the law refitted", Align::right},
                       {"our complexity", Align::right},
                       {"singular", Align::right},
                       {"failed", Align::right}});
  for (const PublishedRow& row : problem.rows) {
    const PublishedFigure& its = row.published;
    std::vector<std::string> cells = {its.published_method.empty() ? "-" : its.published_method,
                                      count_figure(its.mae), count_figure(its.complexity)};
    if (row.ours == nullptr) {
      cells.insert(cells.end(), {"not in this run", "", "-", "", figure(problem.mae_ceiling),
                                 figure(problem.mae_refitted), "-", "-", "-", "-", "-"});
    } else {
      const MethodRow& ours = *row.ours;
      cells.insert(cells.end(), {ours.method, row.operators, figure(ours.mae_test.middle),
                                 spread_text(ours.mae_test), figure(problem.mae_ceiling),
                                 figure(problem.mae_refitted), yardstick_ratio_text(ours.ceiling),
                                 yardstick_ratio_text(ours.refitted),
                                 count_figure(published_complexity_of(ours)),
                                 fmt::format("{}", ours.refuted), fmt::format("{}", ours.failed)});
    }
    table.add(std::move(cells));
  }
  return table.text();
}

}  // namespace

std::string published_markdown(const std::vector<PublishedProblem>& problems,
                               std::string_view heading) {
  std::string text;
  for (const PublishedProblem& problem : problems) {
    text += fmt::format("\n{} {}: {}\n\n{}", heading, problem.table, problem.problem,
                        table_of(problem));
    for (std::size_t i = 0; i < problem.remarks.size(); ++i) {
      text += fmt::format("{}- {}\n", i == 0 ? "\n" : "", problem.remarks[i]);
    }
  }
  return text;
}

ordered_json published_json(const std::vector<PublishedProblem>& problems) {
  ordered_json all = ordered_json::array();
  for (const PublishedProblem& problem : problems) {
    ordered_json rows = ordered_json::array();
    for (const PublishedRow& row : problem.rows) {
      const MethodRow* ours = row.ours;
      const auto of_ours = [&](auto figure_of) {
        return json_number(ours != nullptr ? figure_of(*ours) : kMissing);
      };
      rows.push_back(
          {{"table", problem.table},
           {"problem", problem.problem},
           {"published_method", row.published.published_method},
           {"published_mae", json_number(row.published.mae)},
           {"published_complexity", json_number(row.published.complexity)},
           {"method", ours != nullptr ? ours->method : "not in this run"},
           {"operators", row.operators},
           {"mae", of_ours([](const MethodRow& r) { return r.mae_test.middle; })},
           {"low", of_ours([](const MethodRow& r) { return r.mae_test.low; })},
           {"high", of_ours([](const MethodRow& r) { return r.mae_test.high; })},
           {"ceiling", json_number(problem.mae_ceiling)},
           {"refitted", json_number(problem.mae_refitted)},
           {"against_ceiling", ours != nullptr ? yardstick_ratio_text(ours->ceiling) : "-"},
           {"against_refitted", ours != nullptr ? yardstick_ratio_text(ours->refitted) : "-"},
           {"complexity", of_ours([](const MethodRow& r) { return published_complexity_of(r); })},
           {"singular", ours != nullptr ? ours->refuted : 0}});
    }
    all.push_back({{"table", problem.table},
                   {"problem", problem.problem},
                   {"remarks", problem.remarks},
                   {"rows", std::move(rows)}});
  }
  return all;
}

}  // namespace tribench
