// SPDX-License-Identifier: MIT
#include "reports/published.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "reports/csv.hpp"
#include "reports/figures.hpp"
#include "reports/markdown.hpp"

namespace tribench {
namespace {

using nlohmann::ordered_json;

ordered_json number(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

}  // namespace

std::vector<PublishedFigure> read_published(const std::filesystem::path& file,
                                            std::vector<std::string>& complaints) {
  std::vector<PublishedFigure> figures;
  std::ifstream in(file, std::ios::binary);
  if (!in) return figures;
  std::vector<std::string> names;
  const auto keep_names = [&](const std::vector<std::string_view>& fields) {
    names.assign(fields.begin(), fields.end());
  };
  const CsvReading reading =
      read_csv(in, keep_names, [&](const std::vector<std::string_view>& fields) {
        std::map<std::string, std::string, std::less<>> row;
        for (std::size_t i = 0; i < fields.size(); ++i) row[names[i]] = fields[i];
        PublishedFigure figure{row["table"],   row["problem"], row["published_method"],
                               row["methods"], kMissing,       kMissing,
                               row["note"]};
        if (read_csv_number(row["mae"], figure.mae) &&
            read_csv_number(row["complexity"], figure.complexity)) {
          figures.push_back(std::move(figure));
        } else {
          complaints.push_back(fmt::format("reference.csv: '{}' or '{}' is not a number; left out",
                                           row["mae"], row["complexity"]));
        }
      });
  for (const std::string& complaint : reading.complaints) {
    complaints.push_back("reference.csv: " + complaint);
  }
  return figures;
}

std::vector<PublishedRow> match_published(const std::vector<PublishedFigure>& figures,
                                          const RunSummary& summary) {
  std::vector<PublishedRow> rows;
  for (const PublishedFigure& figure : figures) {
    const std::size_t before = rows.size();
    for (const std::string& method : words_of(figure.methods)) {
      for (const ProblemTable& table : summary.tables) {
        if (table.problem != figure.problem) continue;
        for (const MethodRow& row : table.rows) {
          // A fixed form stands in the table of every operator set; once is enough here.
          const bool repeated = row.operators == "-" && table.operators != summary.operators[0];
          if (row.method == method && !repeated) rows.push_back({figure, row.operators, &row});
        }
      }
    }
    if (rows.size() == before) rows.push_back({figure, "", nullptr});
  }
  return rows;
}

std::string published_markdown(const std::vector<PublishedRow>& rows) {
  MarkdownTable table({{"table"},
                       {"problem"},
                       {"published"},
                       {"MAE", Align::right},
                       {"ours"},
                       {"operators"},
                       {"MAE", Align::right},
                       {"over seeds", Align::right},
                       {"complexity", Align::right},
                       {"note"}});
  for (const PublishedRow& row : rows) {
    const MethodRow* ours = row.ours;
    table.add({row.published.table, row.published.problem, row.published.published_method,
               figure(row.published.mae), ours != nullptr ? ours->method : "not in this run",
               row.operators, ours != nullptr ? figure(ours->mae_test.middle) : "-",
               ours != nullptr ? fmt::format("{} .. {}", figure(ours->mae_test.low),
                                             figure(ours->mae_test.high))
                               : "",
               fmt::format("{} / {}", count_figure(row.published.complexity),
                           ours != nullptr ? count_figure(ours->complexity) : "-"),
               row.published.note});
  }
  return table.empty() ? std::string() : table.text();
}

ordered_json published_json(const std::vector<PublishedRow>& rows) {
  ordered_json all = ordered_json::array();
  for (const PublishedRow& row : rows) {
    const MethodRow* ours = row.ours;
    all.push_back({{"table", row.published.table},
                   {"problem", row.published.problem},
                   {"published_method", row.published.published_method},
                   {"published_mae", number(row.published.mae)},
                   {"published_complexity", number(row.published.complexity)},
                   {"method", ours != nullptr ? ours->method : "not in this run"},
                   {"operators", row.operators},
                   {"mae", number(ours != nullptr ? ours->mae_test.middle : kMissing)},
                   {"low", number(ours != nullptr ? ours->mae_test.low : kMissing)},
                   {"high", number(ours != nullptr ? ours->mae_test.high : kMissing)},
                   {"complexity", number(ours != nullptr ? ours->complexity : kMissing)},
                   {"note", row.published.note}});
  }
  return all;
}

}  // namespace tribench
