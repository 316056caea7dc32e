// SPDX-License-Identifier: MIT
#include "problems/suite/published_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "foundation/error.hpp"
#include "foundation/number_text.hpp"
#include "foundation/suggestion.hpp"
#include "foundation/text.hpp"
#include "problems/reading/csv_cells.hpp"

namespace tribench::suite {
namespace {

// One such file, and the places of its columns.
class Lines {
 public:
  Lines(const PublishedTable& table, const std::filesystem::path& data)
      : file_((data / table.file).string()), cells_(split_csv(read_file(file_), file_)) {}

  const std::vector<CsvLine>& all() const { return cells_.lines; }
  std::string place(const CsvLine& line) const { return fmt::format("{}:{}", file_, line.number); }

  std::size_t column(const std::string& name) const {
    const auto found = std::ranges::find(cells_.header, name);
    if (found == cells_.header.end()) {
      throw_bad_input(fmt::format("there is no column '{}'", name), file_,
                      did_you_mean(name, cells_.header));
    }
    return static_cast<std::size_t>(found - cells_.header.begin());
  }

  double number(const CsvLine& line, std::size_t at) const {
    const auto value = read_number<double>(line.cells[at]);
    if (!value) {
      throw_bad_input(fmt::format("'{}' is no number", line.cells[at]), place(line),
                      fmt::format("column '{}'", cells_.header[at]));
    }
    return *value;
  }

 private:
  std::string file_;
  CsvCells cells_;
};

}  // namespace

std::vector<PublishedResult> read_published_results(const PublishedTable& table,
                                                    const std::filesystem::path& data) {
  const Lines lines(table, data);
  const std::size_t dataset = lines.column("dataset");
  const std::size_t method = lines.column("method");
  const std::size_t r2 = lines.column(table.r2);
  const std::size_t equals = table.where.find('=');
  std::vector<PublishedResult> results;
  std::set<std::pair<std::string, std::string>> seen;
  for (const CsvLine& line : lines.all()) {
    const bool wanted =
        table.where.empty() ||
        line.cells[lines.column(table.where.substr(0, equals))] == table.where.substr(equals + 1);
    if (!wanted || line.cells[r2].empty()) continue;
    PublishedResult one{line.cells[dataset], line.cells[method]};
    if (!seen.insert({one.dataset, one.method}).second) {
      throw_bad_input(fmt::format("'{}' stands twice for '{}'", one.method, one.dataset),
                      lines.place(line), "choose lines with where = \"COLUMN=VALUE\"");
    }
    one.r2 = lines.number(line, r2);
    if (!table.symbolic.empty())
      one.symbolic = lines.number(line, lines.column(table.symbolic)) != 0;
    if (!table.seconds.empty()) one.seconds = lines.number(line, lines.column(table.seconds));
    results.push_back(std::move(one));
  }
  return results;
}

}  // namespace tribench::suite
