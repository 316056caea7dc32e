// SPDX-License-Identifier: MIT
#include "reports/published.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "foundation/error.hpp"
#include "foundation/text.hpp"
#include "reports/csv.hpp"
#include "reports/figures.hpp"

namespace tribench {
namespace {

constexpr double kNearCeiling = 1.03;  // "reaches the noise ceiling"
constexpr double kAsGood = 1.05;       // of symbolic regression's error

constexpr const char* kColumns[] = {"table",   "problem", "published_method", "kind",
                                    "methods", "mae",     "complexity",       "note"};

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

std::vector<PublishedFigure> parse_published(std::istream& in,
                                             std::vector<std::string>& complaints) {
  std::vector<PublishedFigure> figures;
  std::vector<std::string> names;
  const auto keep_names = [&](const std::vector<std::string_view>& fields) {
    names.assign(fields.begin(), fields.end());
    for (const char* column : kColumns) {
      if (std::ranges::find(names, column) == names.end()) {
        complaints.push_back(fmt::format("column '{}' is missing", column));
      }
    }
  };
  const CsvReading reading =
      read_csv(in, keep_names, [&](const std::vector<std::string_view>& fields, std::size_t line) {
        std::map<std::string, std::string, std::less<>> row;
        for (std::size_t i = 0; i < fields.size(); ++i) row[names[i]] = fields[i];
        PublishedFigure figure{row["table"], row["problem"], row["published_method"],
                               row["kind"],  row["methods"], kMissing,
                               kMissing,     row["note"]};
        const auto take = [&](const char* column, double& value) {
          if (read_csv_number(row[column], value)) return true;
          complaints.push_back(
              fmt::format("line {}: '{}' in column {} is no number", line, row[column], column));
          return false;
        };
        if (take("mae", figure.mae) && take("complexity", figure.complexity)) {
          figures.push_back(std::move(figure));
        }
      });
  complaints.insert(complaints.end(), reading.complaints.begin(), reading.complaints.end());
  return figures;
}

// One method of ours in every operator set; a fixed form stands in the table of each, once is
// enough here.
std::vector<PublishedRow> rows_of(const PublishedFigure& figure, const std::string& method,
                                  const RunSummary& summary) {
  std::vector<PublishedRow> rows;
  for (const ProblemTable& table : summary.tables) {
    if (table.problem != figure.problem) continue;
    for (const MethodRow& row : table.rows) {
      const bool repeated = row.operators == "-" && table.operators != summary.operators[0];
      if (row.method == method && !repeated) rows.push_back({figure, row.operators, &row});
    }
  }
  return rows;
}

double error_of(const PublishedRow& row) {
  return row.ours == nullptr || row.ours->mae_test.count == 0 ? kMissing : row.ours->placed_by;
}

// The least error among the rows that `wanted` takes; null where none gave a formula.
template <typename Wanted>
const PublishedRow* best_of(const PublishedProblem& problem, Wanted wanted) {
  const PublishedRow* best = nullptr;
  for (const PublishedRow& row : problem.rows) {
    if (!std::isfinite(error_of(row)) || !wanted(row)) continue;
    if (best == nullptr || error_of(row) < error_of(*best)) best = &row;
  }
  return best;
}

bool is_kind(const PublishedRow& row, std::string_view kind) { return row.published.kind == kind; }

// What stands for the published baseline: the first of its methods that the run has.
bool is_published_form(const PublishedProblem& problem, const PublishedRow& row) {
  for (const std::string& method : words_of(row.published.methods)) {
    const bool present = std::ranges::any_of(problem.rows, [&](const PublishedRow& other) {
      return other.ours != nullptr && other.ours->method == method;
    });
    if (present) return row.ours != nullptr && row.ours->method == method;
  }
  return false;
}

// How near an error comes to the ceiling, and how sure that is.
std::string nearness(const YardstickRatio& ceiling) {
  if (ceiling.middle <= kNearCeiling) return "within 3 %";
  if (ceiling.interval.contains(kNearCeiling)) return "cannot be told from 3 %";
  return "not within 3 %";
}

void remark_on_ceiling(PublishedProblem& problem, const PublishedRow& symbolic) {
  const MethodRow& ours = *symbolic.ours;
  std::string text = fmt::format("Best symbolic regression: {} ({}), {}", ours.method,
                                 symbolic.operators, figure(error_of(symbolic)));
  if (std::isfinite(ours.ceiling.middle)) {
    text += fmt::format("; seed by seed {} against the noise ceiling, {}",
                        yardstick_ratio_text(ours.ceiling), nearness(ours.ceiling));
  }
  if (std::isfinite(ours.refitted.middle)) {
    text += fmt::format(", and {} against the true law refitted to the same rows",
                        yardstick_ratio_text(ours.refitted));
  }
  problem.remarks.push_back(text + ".");
}

// Whether each symbolic method, in its best operator set, beats every published baseline.
void remark_on_baselines(PublishedProblem& problem) {
  const PublishedRow* baseline = best_of(problem, [&](const PublishedRow& row) {
    return is_kind(row, "baseline") && is_published_form(problem, row);
  });
  if (baseline == nullptr) return;
  std::vector<std::string> seen;
  bool all_better = true;
  for (const PublishedRow& row : problem.rows) {
    if (!is_kind(row, "symbolic") || row.ours == nullptr) continue;
    const std::string& method = row.ours->method;
    if (std::ranges::find(seen, method) != seen.end()) continue;
    seen.push_back(method);
    const PublishedRow* best =
        best_of(problem, [&](const PublishedRow& other) { return other.ours->method == method; });
    if (best != nullptr && error_of(*best) < error_of(*baseline)) continue;
    all_better = false;
    problem.remarks.push_back(fmt::format("{} ({}) is not better than the baseline {} ({}).",
                                          method,
                                          best == nullptr ? "no formula" : figure(error_of(*best)),
                                          baseline->ours->method, figure(error_of(*baseline))));
  }
  if (all_better && !seen.empty()) {
    problem.remarks.push_back(
        fmt::format("Each of {} is better than every baseline; the best of these is {} ({}).",
                    fmt::join(seen, ", "), baseline->ours->method, figure(error_of(*baseline))));
  }
}

void remark_on_simple(PublishedProblem& problem, const PublishedRow& symbolic) {
  std::vector<std::string> as_good;
  for (const PublishedRow& row : problem.rows) {
    if (is_kind(row, "symbolic") || !std::isfinite(error_of(row))) continue;
    if (is_kind(row, "baseline") && is_published_form(problem, row)) continue;
    if (error_of(row) > kAsGood * error_of(symbolic)) continue;
    const std::string with = row.operators == "-" ? std::string() : row.operators + ", ";
    as_good.push_back(fmt::format("{} ({}{})", row.ours->method, with, figure(error_of(row))));
  }
  if (!as_good.empty()) {
    problem.remarks.push_back(fmt::format("As good as symbolic regression here (within 5 %): {}.",
                                          fmt::join(as_good, ", ")));
  }
}

void add_notes(PublishedProblem& problem) {
  std::vector<std::pair<std::string, std::vector<std::string>>> notes;  // note, whose it is
  for (const PublishedRow& row : problem.rows) {
    if (row.published.note.empty()) continue;
    auto found =
        std::ranges::find(notes, row.published.note, [](const auto& entry) { return entry.first; });
    if (found == notes.end()) found = notes.insert(notes.end(), {row.published.note, {}});
    std::vector<std::string>& whose = found->second;
    if (std::ranges::find(whose, row.published.published_method) == whose.end()) {
      whose.push_back(row.published.published_method);
    }
  }
  for (const auto& [note, whose] : notes) {
    problem.remarks.push_back(fmt::format("{}: {}", fmt::join(whose, ", "), note));
  }
}

void set_yardsticks(PublishedProblem& problem, const RunSummary& summary) {
  for (const ProblemTable& table : summary.tables) {
    if (table.problem != problem.problem) continue;
    problem.mae_ceiling = table.mae_ceiling;
    problem.mae_refitted = table.mae_refitted;
    return;
  }
}

}  // namespace

std::vector<PublishedFigure> read_published(const std::filesystem::path& file,
                                            std::vector<std::string>& complaints) {
  std::ifstream in = open_file_if_there(file);
  if (!in) return {};
  std::vector<std::string> found;
  std::vector<PublishedFigure> figures = parse_published(in, found);
  for (const std::string& complaint : found) {
    complaints.push_back(fmt::format("{}: {}", file.filename().string(), complaint));
  }
  return figures;
}

void check_published(const std::string& text, const std::string& file) {
  std::istringstream in(text);
  std::vector<std::string> complaints;
  parse_published(in, complaints);
  if (!complaints.empty()) {
    throw_bad_input(complaints.front(), file, fmt::format("columns: {}", fmt::join(kColumns, ",")));
  }
}

std::vector<PublishedProblem> match_published(const std::vector<PublishedFigure>& figures,
                                              const RunSummary& summary) {
  std::vector<PublishedProblem> problems;
  for (const PublishedFigure& figure : figures) {
    if (!std::ranges::binary_search(summary.problems, figure.problem)) continue;
    auto found = std::ranges::find_if(problems, [&](const PublishedProblem& each) {
      return each.problem == figure.problem && each.table == figure.table;
    });
    if (found == problems.end()) {
      found = problems.insert(problems.end(), PublishedProblem{});
      found->table = figure.table;
      found->problem = figure.problem;
      set_yardsticks(*found, summary);
    }
    const std::size_t before = found->rows.size();
    for (const std::string& method : words_of(figure.methods)) {
      for (PublishedRow& row : rows_of(figure, method, summary)) found->rows.push_back(row);
    }
    const bool published = std::isfinite(figure.mae);
    if (found->rows.size() == before && published) found->rows.push_back({figure, "", nullptr});
  }
  for (PublishedProblem& problem : problems) {
    const PublishedRow* symbolic =
        best_of(problem, [](const PublishedRow& row) { return is_kind(row, "symbolic"); });
    if (symbolic != nullptr) {
      remark_on_ceiling(problem, *symbolic);
      remark_on_baselines(problem);
      remark_on_simple(problem, *symbolic);
    }
    add_notes(problem);
  }
  return problems;
}

double published_complexity_of(const MethodRow& ours) {
  return ours.complexity_adaptation > 0 ? ours.complexity_adaptation : ours.complexity;
}

}  // namespace tribench
