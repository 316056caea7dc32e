// SPDX-License-Identifier: MIT
#include "reports/suite_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/order_statistics.hpp"
#include "foundation/text.hpp"
#include "reports/figures.hpp"
#include "reports/markdown.hpp"

namespace tribench {
namespace {

using nlohmann::ordered_json;

constexpr std::array kBands = {0.999, 0.99, 0.9};
constexpr std::array<const char*, 3> kSizes = {"small", "middle", "large"};

using Records = std::vector<const Record*>;

// The share of the variance on unseen rows that is left; a constant has none to be explained, and
// its square takes the variance's place.
double unexplained(const Record& record) {
  if (!std::isnan(record.r2_test)) return 1 - record.r2_test;
  const double relative = record.relative_error_test / 100;
  return relative * relative;
}

bool is_recovered(const Record& record, double below) {
  return is_ok(record) && unexplained(record) <= below;
}

template <typename Hit>
double share_of(const Records& records, Hit hit) {
  double hits = 0;
  for (const Record* one : records) hits += hit(*one) ? 1 : 0;
  return hits / static_cast<double>(records.size());
}

double mean_of(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

// Cells without a formula are below all others; missing where they are half or more.
double median_r2(const Records& records) {
  std::vector<double> values;
  for (const Record* one : records) values.push_back(is_ok(*one) ? one->r2_test : -HUGE_VAL);
  const double middle = median(values);
  return std::isinf(middle) ? kMissing : middle;
}

double median_of(const Records& records, double Record::*member) {
  std::vector<double> values;
  for (const Record* one : records) values.push_back(one->*member);
  return median(values);
}

// The largest law of the first and of the second third of the problems that have one.
std::array<int, 2> size_bounds_of(const SuiteInfo& suite) {
  std::vector<int> sizes;
  for (const SuiteProblemInfo& one : suite.problems) {
    if (one.nodes > 0) sizes.push_back(one.nodes);
  }
  if (sizes.empty()) return {};
  std::ranges::sort(sizes);
  return {sizes[(sizes.size() - 1) / 3], sizes[2 * (sizes.size() - 1) / 3]};
}

std::size_t third_of(int nodes, const std::array<int, 2>& bounds) {
  return nodes <= bounds[0] ? 0 : nodes <= bounds[1] ? 1 : 2;
}

// "~noise=0.2" of a problem that a sweep changed; empty where none did.
std::string_view variant_of(std::string_view problem) {
  return problem.substr(std::min(problem.find('~'), problem.size()));
}

std::string_view without_variant(std::string_view problem) {
  return problem.substr(0, problem.find('~'));
}

// Every problem's records of one method.
using ByProblem = std::map<std::string, Records>;

SuiteMethodRow row_of(const SuiteView& view, const ByProblem& by_problem) {
  SuiteMethodRow row;
  std::vector<double> recovered;
  std::array<std::vector<double>, 3> by_size;
  Records all;
  for (const auto& [problem, records] : by_problem) {
    recovered.push_back(share_of(
        records, [&](const Record& one) { return is_recovered(one, view.suite.recovered_below); }));
    for (std::size_t b = 0; b < kBands.size(); ++b) {
      row.r2_at_least[b] +=
          share_of(records, [&](const Record& one) { return is_recovered(one, 1 - kBands[b]); }) /
          static_cast<double>(by_problem.size());
    }
    const auto info = std::ranges::find(view.suite.problems, without_variant(problem),
                                        &SuiteProblemInfo::problem);
    if (info != view.suite.problems.end() && info->nodes > 0) {
      by_size[third_of(info->nodes, view.size_bounds)].push_back(recovered.back());
    }
    all.insert(all.end(), records.begin(), records.end());
  }
  row.method = all.front()->method;
  row.operators = all.front()->operators + std::string(variant_of(all.front()->problem));
  row.problems = by_problem.size();
  row.cells = all.size();
  for (const Record* one : all) row.failed += is_ok(*one) ? 0 : 1;
  row.recovered = mean_of(recovered);
  row.interval = wilson_of_share(row.recovered, recovered.size(), kConfidence);
  row.r2_median = median_r2(all);
  row.fit_cpu_s = median_of(all, &Record::fit_cpu_s);
  row.fit_wall_s = median_of(all, &Record::fit_wall_s);
  std::vector<double> evaluations;
  for (const Record* one : all) evaluations.push_back(static_cast<double>(one->evaluations));
  row.evaluations = median(evaluations);
  for (std::size_t s = 0; s < by_size.size(); ++s) {
    row.recovered_by_size[s] = by_size[s].empty() ? kMissing : mean_of(by_size[s]);
  }
  return row;
}

std::string percent(double share) {
  return std::isnan(share) ? std::string("-") : fmt::format("{:.1f} %", 100 * share);
}

std::string method_table(const SuiteView& view) {
  const bool laws = view.size_bounds[1] > 0;
  std::vector<MarkdownTable::Heading> headings = {{"method"},
                                                  {"operators"},
                                                  {"recovered", Align::right},
                                                  {"95 %", Align::right},
                                                  {"R2 >= 0.999", Align::right},
                                                  {"0.99", Align::right},
                                                  {"0.9", Align::right},
                                                  {"median R2", Align::right},
                                                  {"CPU s", Align::right},
                                                  {"wall s", Align::right},
                                                  {"evaluations", Align::right},
                                                  {"failed", Align::right}};
  for (std::size_t s = 0; laws && s < kSizes.size(); ++s) {
    headings.push_back({fmt::format("{} laws", kSizes[s]), Align::right});
  }
  MarkdownTable table(headings);
  for (const SuiteMethodRow& row : view.rows) {
    std::vector<std::string> cells = {
        row.method,
        row.operators,
        percent(row.recovered),
        fmt::format("{} .. {}", percent(row.interval.low), percent(row.interval.high)),
        percent(row.r2_at_least[0]),
        percent(row.r2_at_least[1]),
        percent(row.r2_at_least[2]),
        figure(row.r2_median),
        figure(row.fit_cpu_s),
        figure(row.fit_wall_s),
        figure(row.evaluations),
        fmt::format("{}/{}", row.failed, row.cells)};
    for (std::size_t s = 0; laws && s < kSizes.size(); ++s) {
      cells.push_back(percent(row.recovered_by_size[s]));
    }
    table.add(std::move(cells));
  }
  return table.text();
}

// Of each published method the points at which its share has grown by a twentieth or more, and its
// last: a curve of dozens of points says no more.
std::vector<SuiteReferencePoint> thinned(const std::vector<SuiteReferencePoint>& all) {
  constexpr double kStep = 0.05;
  std::vector<SuiteReferencePoint> kept;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool last = i + 1 == all.size() || all[i + 1].method != all[i].method;
    const bool first = kept.empty() || kept.back().method != all[i].method;
    if (first || last || all[i].recovered >= kept.back().recovered + kStep) kept.push_back(all[i]);
  }
  return kept;
}

std::string reference_table(const SuiteInfo& suite) {
  MarkdownTable table({{"published"},
                       {"wall s", Align::right},
                       {"recovered", Align::right},
                       {"95 %", Align::right}});
  for (const SuiteReferencePoint& one : thinned(suite.references)) {
    table.add({one.method, figure(one.seconds), percent(one.recovered),
               fmt::format("{} .. {}", percent(one.low), percent(one.high))});
  }
  return table.text();
}

std::string never_solved_text(const SuiteView& view) {
  if (view.never_solved.empty()) return "Every problem was recovered by some method.\n";
  std::string text = fmt::format("Recovered by no method ({}):\n\n", view.never_solved.size());
  for (const std::string& problem : view.never_solved) {
    const auto info = std::ranges::find(view.suite.problems, problem, &SuiteProblemInfo::problem);
    const std::string law = info == view.suite.problems.end() ? std::string() : info->law;
    text += law.empty() ? fmt::format("- {}\n", problem)
                        : fmt::format("- {}: {}\n", problem, markdown_code(law));
  }
  return text;
}

ordered_json reference_json(const SuiteReferencePoint& one) {
  return {{"method", one.method},
          {"seconds", one.seconds},
          {"recovered", one.recovered},
          {"low", one.low},
          {"high", one.high}};
}

ordered_json row_json(const SuiteMethodRow& row) {
  ordered_json sizes = ordered_json::array();
  for (const double share : row.recovered_by_size) sizes.push_back(json_number(share));
  return {{"method", row.method},
          {"operators", row.operators},
          {"problems", row.problems},
          {"cells", row.cells},
          {"failed", row.failed},
          {"recovered", row.recovered},
          {"low", row.interval.low},
          {"high", row.interval.high},
          {"r2_at_least", row.r2_at_least},
          {"r2_median", json_number(row.r2_median)},
          {"fit_cpu_s", json_number(row.fit_cpu_s)},
          {"fit_wall_s", json_number(row.fit_wall_s)},
          {"evaluations", json_number(row.evaluations)},
          {"recovered_by_size", sizes}};
}

SuiteInfo suite_in(const nlohmann::json& json) {
  SuiteInfo suite{json.at("name"),
                  json.at("summary"),
                  json.at("recovered_below"),
                  json.at("reference_note"),
                  {},
                  {},
                  suite_results_in(json.value("results", nlohmann::json::array())),
                  json.value("results_note", "")};
  for (const nlohmann::json& one : json.at("problems")) {
    suite.problems.push_back({one.at("problem"), one.at("law"), one.at("nodes")});
  }
  for (const nlohmann::json& one : json.at("references")) {
    suite.references.push_back(
        {one.at("method"), one.at("seconds"), one.at("recovered"), one.at("low"), one.at("high")});
  }
  return suite;
}

}  // namespace

std::string suites_json(const std::vector<SuiteInfo>& suites) {
  ordered_json array = ordered_json::array();
  for (const SuiteInfo& suite : suites) {
    ordered_json problems = ordered_json::array();
    for (const SuiteProblemInfo& one : suite.problems) {
      problems.push_back({{"problem", one.problem}, {"law", one.law}, {"nodes", one.nodes}});
    }
    ordered_json references = ordered_json::array();
    for (const SuiteReferencePoint& one : suite.references) {
      references.push_back(reference_json(one));
    }
    array.push_back({{"name", suite.name},
                     {"summary", suite.summary},
                     {"recovered_below", suite.recovered_below},
                     {"reference_note", suite.reference_note},
                     {"problems", problems},
                     {"references", references},
                     {"results", suite_results_json(suite.results)},
                     {"results_note", suite.results_note}});
  }
  return write_json(array, 1) + "\n";
}

std::vector<SuiteInfo> read_suites(const std::filesystem::path& file,
                                   std::vector<std::string>& complaints) {
  std::vector<SuiteInfo> suites;
  const auto text = read_file_if_there(file);
  if (!text) return suites;
  try {
    for (const auto& json : read_json_or_throw<nlohmann::json>(*text, file.string())) {
      suites.push_back(suite_in(json));
    }
  } catch (const nlohmann::json::exception& error) {
    complaints.push_back(fmt::format("{}: {}", file.filename().string(), json_complaint(error)));
  } catch (const Error& error) {
    complaints.push_back(fmt::format("{}: {}", file.filename().string(), error.what()));
  }
  return suites;
}

std::vector<SuiteView> view_suites(const std::vector<SuiteInfo>& suites,
                                   const std::vector<Record>& records) {
  std::vector<SuiteView> views;
  for (const SuiteInfo& suite : suites) {
    SuiteView view{suite, {}, size_bounds_of(suite), {}, {}};
    // A sweep's variants are not problems more: noise is another question.
    std::map<std::tuple<std::string, std::string, std::string>, ByProblem> methods;
    std::set<std::string> solved;
    for (const Record& record : records) {
      if (!record.problem.starts_with(suite.name + "/")) continue;
      const std::string variant(variant_of(record.problem));
      methods[{record.method, record.operators, variant}][record.problem].push_back(&record);
      if (!is_recovered(record, suite.recovered_below)) continue;
      solved.insert(std::string(without_variant(record.problem)));
    }
    if (methods.empty()) continue;
    std::set<std::string> tried;
    for (const auto& [key, by_problem] : methods) {
      view.rows.push_back(row_of(view, by_problem));
      for (const auto& [problem, cells] : by_problem) {
        tried.insert(std::string(without_variant(problem)));
      }
    }
    std::ranges::stable_sort(view.rows, std::ranges::greater(), &SuiteMethodRow::recovered);
    for (const SuiteProblemInfo& one : suite.problems) {
      if (tried.contains(one.problem) && !solved.contains(one.problem)) {
        view.never_solved.push_back(one.problem);
      }
    }
    view.ranks = rank_among_published(suite.results, records);
    views.push_back(std::move(view));
  }
  return views;
}

std::string suites_markdown(const std::vector<SuiteView>& views, std::string_view heading) {
  std::string text;
  for (const SuiteView& view : views) {
    text += fmt::format("\n{} {}: {}\n\n", heading, view.suite.name, view.suite.summary);
    text += fmt::format(
        "Recovered: at most {:.3g} of the variance on unseen rows is left; means over problems of "
        "the share of seeds, times are medians over cells.\n\n",
        view.suite.recovered_below);
    if (view.size_bounds[1] > 0) {
      text += fmt::format("Small laws have up to {} nodes, middle ones up to {}.\n\n",
                          view.size_bounds[0], view.size_bounds[1]);
    }
    text += method_table(view);
    if (!view.suite.references.empty()) {
      text += "\n" + view.suite.reference_note + "\n\n" + reference_table(view.suite);
    }
    if (!view.suite.results_note.empty()) text += "\n" + view.suite.results_note + "\n";
    text += suite_ranks_markdown(view.ranks);
    text += "\n" + never_solved_text(view);
  }
  return text;
}

ordered_json suite_views_json(const std::vector<SuiteView>& views) {
  ordered_json array = ordered_json::array();
  for (const SuiteView& view : views) {
    ordered_json rows = ordered_json::array();
    for (const SuiteMethodRow& row : view.rows) rows.push_back(row_json(row));
    ordered_json references = ordered_json::array();
    for (const SuiteReferencePoint& one : view.suite.references) {
      references.push_back(reference_json(one));
    }
    array.push_back({{"name", view.suite.name},
                     {"summary", view.suite.summary},
                     {"recovered_below", view.suite.recovered_below},
                     {"reference_note", view.suite.reference_note},
                     {"rows", rows},
                     {"references", references},
                     {"results_note", view.suite.results_note},
                     {"ranks", suite_ranks_json(view.ranks)},
                     {"never_solved", view.never_solved}});
  }
  return array;
}

}  // namespace tribench
