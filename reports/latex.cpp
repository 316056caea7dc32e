// SPDX-License-Identifier: MIT
#include "reports/latex.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "reports/figures.hpp"

namespace tribench {
namespace {

constexpr std::size_t kProblemsAcross = 4;

// Letters, digits and hyphens, for \label.
std::string label_of(std::string_view text) {
  std::string label;
  for (const char c : text) {
    label += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '-';
  }
  return label;
}

std::string figure_cell(double value) {
  return std::isfinite(value) ? fmt::format("${}$", figure(value)) : std::string("--");
}

std::string range(const Spread& spread) {
  if (spread.count < 2) return {};
  return fmt::format(" {{\\scriptsize ({}--{})}}", figure(spread.low), figure(spread.high));
}

std::string count(double value) {
  return std::isnan(value) ? std::string("--") : fmt::format("{}", value);
}

// Error with range, and complexity: two cells.
std::string cells_of(const MethodRow* row) {
  if (row == nullptr || row->mae_test.count == 0) return " & -- & --";
  std::string error = figure(row->mae_test.middle);
  if (row->standing == Standing::best) error = fmt::format("\\mathbf{{{}}}", error);
  const bool as_good =
      row->standing == Standing::equivalent || row->standing == Standing::not_distinguishable;
  return fmt::format(" & ${}{}${} & {}", error, as_good ? "^\\dagger" : "", range(row->mae_test),
                     count(row->complexity));
}

struct Part {
  std::vector<const ProblemTable*> tables;  // columns
  std::vector<std::string> methods;         // rows, best mean place first
};

// Methods by their mean place over the part's problems.
std::vector<std::string> ordered_methods(const std::vector<const ProblemTable*>& tables) {
  std::map<std::string, std::pair<double, std::size_t>> places;
  for (const ProblemTable* table : tables) {
    for (std::size_t i = 0; i < table->rows.size(); ++i) {
      auto& [sum, seen] = places[table->rows[i].method];
      sum += static_cast<double>(i);
      ++seen;
    }
  }
  std::vector<std::string> methods;
  for (const auto& [method, place] : places) methods.push_back(method);
  const auto mean = [&](const std::string& method) {
    return places[method].first / static_cast<double>(places[method].second);
  };
  std::ranges::stable_sort(methods,
                           [&](const auto& a, const auto& b) { return mean(a) < mean(b); });
  return methods;
}

std::string table_head(std::string_view columns, std::string_view caption, std::string_view label) {
  return fmt::format(
      "\\begin{{table}}\n\\centering\n\\caption{{{}}}\n\\label{{tab:{}}}\n"
      "\\resizebox{{\\linewidth}}{{!}}{{%\n\\begin{{tabular}}{{{}}}\n\\toprule\n",
      caption, label, columns);
}

constexpr std::string_view kTableEnd = "\\bottomrule\n\\end{tabular}}\n\\end{table}\n";

std::string results_table(std::string_view name, std::string_view operators, const Part& part,
                          std::size_t number_of_part) {
  std::string columns = "l";
  std::string heads;
  std::string rules;
  std::string second;
  for (std::size_t i = 0; i < part.tables.size(); ++i) {
    columns += "lr";
    heads += fmt::format(" & \\multicolumn{{2}}{{c}}{{{}}}", latex_text(part.tables[i]->problem));
    rules += fmt::format("\\cmidrule(lr){{{}-{}}}", 2 * i + 2, 2 * i + 3);
    second += " & MAE & $C$";
  }
  std::string text = table_head(
      columns,
      fmt::format(
          "{}, operators \\texttt{{{}}}: mean absolute error on test movements (median "
          "over seeds, range) and complexity $C$. Bold: smallest; $\\dagger$: within 1\\,\\% "
          "of it or not distinguishable from it.",
          latex_text(name), latex_text(operators)),
      fmt::format("{}-{}-{}", label_of(name), label_of(operators), number_of_part));
  text += heads + " \\\\\n" + rules + "\nmethod" + second + " \\\\\n\\midrule\n";
  for (const std::string& method : part.methods) {
    text += latex_text(method);
    for (const ProblemTable* table : part.tables) {
      const auto row = std::ranges::find(table->rows, method, &MethodRow::method);
      text += cells_of(row == table->rows.end() ? nullptr : &*row);
    }
    text += " \\\\\n";
  }
  text += "\\midrule\nnoise ceiling";
  for (const ProblemTable* table : part.tables) {
    text += fmt::format(" & {} & ", figure_cell(table->mae_ceiling));
  }
  return text + " \\\\\n" + std::string(kTableEnd);
}

std::string published_table(std::string_view name, const std::string& table,
                            const std::vector<const PublishedProblem*>& problems) {
  std::string text = table_head(
      "llrrllrrrr",
      fmt::format("{}, published figures ({}) beside ours.", latex_text(name), latex_text(table)),
      fmt::format("{}-{}", label_of(name), label_of(table)));
  text +=
      "problem & published & MAE & $C$ & ours & operators & MAE & $C$ & ceiling & law refitted "
      "\\\\\n";
  for (const PublishedProblem* problem : problems) {
    text += "\\midrule\n";
    for (const PublishedRow& row : problem->rows) {
      const bool ours = row.ours != nullptr && row.ours->mae_test.count > 0;
      text += fmt::format(
          "{} & {} & {} & {} & {} & {} & {}{} & {} & {} & {} \\\\\n", latex_text(problem->problem),
          latex_text(row.published.published_method),
          std::isnan(row.published.mae) ? "--" : fmt::format("${}$", row.published.mae),
          count(row.published.complexity),
          row.ours == nullptr ? "--" : latex_text(row.ours->method), latex_text(row.operators),
          ours ? figure_cell(row.ours->mae_test.middle) : "--",
          ours ? range(row.ours->mae_test) : "",
          ours ? count(published_complexity_of(*row.ours)) : "--",
          figure_cell(problem->mae_ceiling), figure_cell(problem->mae_refitted));
    }
  }
  return text + std::string(kTableEnd);
}

}  // namespace

std::string latex_text(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '\\':
        safe += "\\textbackslash{}";
        break;
      case '~':
        safe += "\\textasciitilde{}";
        break;
      case '^':
        safe += "\\textasciicircum{}";
        break;
      case '#':
      case '$':
      case '%':
      case '&':
      case '_':
      case '{':
      case '}':
        safe += '\\';
        [[fallthrough]];
      default:
        safe += c;
    }
  }
  return safe;
}

std::string latex_tables(std::string_view name, const RunSummary& summary,
                         const std::vector<PublishedProblem>& published) {
  std::string text = "% Written by tribench; needs \\usepackage{booktabs,graphicx}.\n";
  for (const std::string& operators : summary.operators) {
    Part part;
    std::size_t parts = 0;
    const auto write = [&] {
      if (part.tables.empty()) return;
      part.methods = ordered_methods(part.tables);
      text += '\n' + results_table(name, operators, part, ++parts);
      part.tables.clear();
    };
    for (const ProblemTable& table : summary.tables) {
      if (table.operators != operators) continue;
      part.tables.push_back(&table);
      if (part.tables.size() == kProblemsAcross) write();
    }
    write();
  }
  std::map<std::string, std::vector<const PublishedProblem*>> by_table;
  for (const PublishedProblem& problem : published) by_table[problem.table].push_back(&problem);
  for (const auto& [table, problems] : by_table) {
    text += '\n' + published_table(name, table, problems);
  }
  return text;
}

}  // namespace tribench
