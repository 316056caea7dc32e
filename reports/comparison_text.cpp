// SPDX-License-Identifier: MIT
//
// A comparison for people (Markdown) and for programs (JSON).
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "foundation/json_text.hpp"
#include "reports/comparison.hpp"
#include "reports/figures.hpp"
#include "reports/markdown.hpp"

namespace tribench {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kCellsListed = 10;

std::string cell_list(const char* title, const std::vector<std::string>& cells) {
  if (cells.empty()) return {};
  std::string text = fmt::format("\n{} ({}):\n\n", title, cells.size());
  for (std::size_t i = 0; i < std::min(kCellsListed, cells.size()); ++i) {
    text += fmt::format("- {}\n", markdown_code(cells[i]));
  }
  if (cells.size() > kCellsListed)
    text += fmt::format("- and {} more\n", cells.size() - kCellsListed);
  return text;
}

std::string comparison_verdict_text(ComparisonVerdict verdict) {
  const std::string name = comparison_verdict_name(verdict);
  return verdict == ComparisonVerdict::worse ? fmt::format("**{}**", name) : name;
}

std::string table_of(const std::vector<ComparisonRow>& rows) {
  MarkdownTable table({{"method"},
                       {"operators"},
                       {"problem"},
                       {"new / base", Align::right},
                       {"95 % interval", Align::right},
                       {"effect", Align::right},
                       {"p (ranks, Holm)", Align::right},
                       {"pairs (equal)", Align::right},
                       {"verdict"}});
  for (const ComparisonRow& row : rows) {
    table.add({row.method, row.operators, row.problem.empty() ? "all" : row.problem,
               figure(row.ratio, 4),
               fmt::format("{} .. {}", figure(row.interval.low, 4), figure(row.interval.high, 4)),
               figure(row.effect, 2), figure(row.p, 2),
               fmt::format("{} ({})", row.pairs, row.equal), comparison_verdict_text(row.verdict)});
  }
  return table.text();
}

// An interval on one side of 1 beside a large p looks like a contradiction.
constexpr const char* kTwoQuestions =
    "\nThe interval is of a row's own median ratio; p asks whether its pairs lean to one side "
    "(signed ranks), adjusted over all verdicts (Holm). These are two questions and need not "
    "agree; better or worse needs p and the ratio.\n";

// JSON knows no infinity and no NaN.
ordered_json rows_json(const std::vector<ComparisonRow>& rows) {
  ordered_json array = ordered_json::array();
  for (const ComparisonRow& row : rows) {
    array.push_back({{"method", row.method},
                     {"operators", row.operators},
                     {"problem", row.problem},
                     {"pairs", row.pairs},
                     {"equal", row.equal},
                     {"ratio", json_number(row.ratio)},
                     {"low", json_number(row.interval.low)},
                     {"high", json_number(row.interval.high)},
                     {"effect", json_number(row.effect)},
                     {"p", json_number(row.p)},
                     {"detectable", json_number(row.detectable)},
                     {"undecided", row.undecided},
                     {"verdict", comparison_verdict_name(row.verdict)}});
  }
  return array;
}

std::string list_of(const char* title, const std::vector<std::string>& lines) {
  if (lines.empty()) return {};
  std::string text = fmt::format("{}:\n\n", title);
  for (const std::string& line : lines) text += fmt::format("- {}\n", line);
  return text + "\n";
}

std::string outcome_text(const Comparison& comparison) {
  std::string text =
      list_of(comparison.conditions_allowed ? "The runs were asked different things (allowed)"
                                            : "The runs were asked different things",
              comparison.conditions);
  text += fmt::format("**{}**\n", comparison.sentence());
  const std::string doubts = list_of("\nNot decided", comparison.doubts());
  text += doubts;
  const std::string visibility = comparison.visibility();
  if (!visibility.empty()) text += fmt::format("{}{}\n", doubts.empty() ? "\n" : "", visibility);
  if (comparison.only_base + comparison.only_new > 0) {
    text += fmt::format("\nCells only in the base: {}, only in the new run: {}.\n",
                        comparison.only_base, comparison.only_new);
  }
  text += cell_list("Newly failed", comparison.newly_failed);
  text += cell_list("Fail no longer", comparison.newly_fine);
  text += cell_list("Newly singular", comparison.newly_singular);
  text += cell_list("No longer singular", comparison.no_longer_singular);
  text += cell_list("Newly without a proof", comparison.newly_unproved);
  text += cell_list("Newly proved", comparison.newly_proved);
  return text;
}

}  // namespace

std::string comparison_head(const Comparison& comparison) {
  std::string text = outcome_text(comparison);
  std::vector<ComparisonRow> told;
  for (const ComparisonRow& row : comparison.quality) {
    const bool decided =
        row.verdict == ComparisonVerdict::worse || row.verdict == ComparisonVerdict::better;
    if (decided || (row.problem.empty() && row.equal < row.pairs)) told.push_back(row);
  }
  if (!told.empty()) text += fmt::format("\n{}{}", table_of(told), kTwoQuestions);
  return text;
}

std::string comparison_markdown(const Comparison& comparison) {
  std::string text = outcome_text(comparison);
  if (comparison.identical < comparison.common) {
    text += "\n### Quality: error on test movements\n\n" + table_of(comparison.quality);
  }
  text += fmt::format("\n### Cost: {} of fits\n\n", cost_currency_name(comparison.cost_currency));
  if (!comparison.why_no_seconds.empty()) {
    text += fmt::format("Not CPU seconds: {}.{}\n\n", comparison.why_no_seconds,
                        comparison.cost_currency == CostCurrency::evaluations
                            ? " Slower code is not seen; the benches' instructions would show it."
                            : "");
  }
  if (!comparison.cost.empty()) text += table_of(comparison.cost);
  const bool has_rows = !comparison.cost.empty() || comparison.identical < comparison.common;
  return has_rows ? text + kTwoQuestions : text;
}

ordered_json comparison_json(const Comparison& comparison) {
  return {{"outcome", outcome_name(comparison.outcome())},
          {"conditions", comparison.conditions},
          {"doubts", comparison.doubts()},
          {"visibility", comparison.visibility()},
          {"regression", comparison.has_regression()},
          {"sentence", comparison.sentence()},
          {"common", comparison.common},
          {"identical", comparison.identical},
          {"only_base", comparison.only_base},
          {"only_new", comparison.only_new},
          {"newly_failed", comparison.newly_failed},
          {"newly_fine", comparison.newly_fine},
          {"newly_singular", comparison.newly_singular},
          {"newly_unproved", comparison.newly_unproved},
          {"no_longer_singular", comparison.no_longer_singular},
          {"newly_unproved", comparison.newly_unproved},
          {"quality", rows_json(comparison.quality)},
          {"cost", rows_json(comparison.cost)},
          {"cost_currency", cost_currency_name(comparison.cost_currency)},
          {"why_no_seconds", comparison.why_no_seconds}};
}

}  // namespace tribench
