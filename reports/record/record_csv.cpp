// SPDX-License-Identifier: MIT
#include "reports/record/record_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <concepts>
#include <fstream>
#include <tuple>
#include <type_traits>
#include <variant>

#include "foundation/error.hpp"
#include "foundation/text.hpp"
#include "reports/record/record_columns.hpp"

namespace tribench {
namespace {

struct WriteField {
  std::string& line;

  void operator()(bool value) const { line += value ? "true" : "false"; }
  void operator()(double value) const { line += csv_number(value); }
  template <typename Value>
  void operator()(const Value& value) const {
    if constexpr (std::is_integral_v<Value>) {
      fmt::format_to(std::back_inserter(line), "{}", value);
    } else {
      append_csv_field(line, field_text(value));
    }
  }
};

template <typename Row>
bool has_formula(const Row& row) {
  if constexpr (requires { row.formula; }) return !row.formula.empty();
  return true;
}

template <typename Row>
std::string to_csv(const std::vector<Row>& rows, std::span<const RecordColumn<Row>> columns) {
  std::string text;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (i > 0) text += ',';
    text += columns[i].name;
  }
  text += '\n';
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (i > 0) text += ',';
      if (columns[i].rules.needs_formula && !has_formula(row)) continue;
      std::visit([&](auto member) { WriteField{text}(row.*member); }, columns[i].member);
    }
    text += '\n';
  }
  return text;
}

bool read_field(std::string_view text, double& value) { return read_csv_number(text, value); }

bool read_field(std::string_view text, bool& value) {
  value = text == "true" || text == "1";
  return value || text.empty() || text == "false" || text == "0";
}

template <typename Value>
bool read_field(std::string_view text, Value& value) {
  return read_field_text(text, value);
}

template <std::integral Integer>
bool read_field(std::string_view text, Integer& value) {
  if (text.empty()) return true;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && stop == text.data() + text.size();
}

// Which column each field of a file is; null for one that is not known.
template <typename Row>
std::vector<const RecordColumn<Row>*> match_columns(const std::vector<std::string_view>& names,
                                                    std::span<const RecordColumn<Row>> columns) {
  std::vector<const RecordColumn<Row>*> matched;
  for (const std::string_view name : names) {
    const auto found = std::ranges::find(columns, name, &RecordColumn<Row>::name);
    matched.push_back(found == columns.end() ? nullptr : &*found);
  }
  return matched;
}

// Fills the row from one line; returns the first field that is no value of its column.
template <typename Row>
std::optional<std::string> read_row(const std::vector<std::string_view>& fields,
                                    const std::vector<const RecordColumn<Row>*>& matched,
                                    Row& row) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (matched[i] == nullptr) continue;
    const bool fine = std::visit([&](auto member) { return read_field(fields[i], row.*member); },
                                 matched[i]->member);
    if (!fine) return fmt::format("{} is not a value of {}", fields[i], matched[i]->name);
  }
  return std::nullopt;
}

template <typename Row>
CsvReading read_rows(const std::filesystem::path& file, std::span<const RecordColumn<Row>> columns,
                     const std::function<void(Row&&)>& take) {
  std::ifstream in = open_file_if_there(file);
  if (!in) throw_bad_input("cannot be opened", file.string(), "check the path and its rights");
  std::vector<const RecordColumn<Row>*> matched;
  std::vector<std::string> bad;
  std::size_t row_number = 0;
  CsvReading reading = read_csv(
      in,
      [&](const std::vector<std::string_view>& names) { matched = match_columns(names, columns); },
      [&](const std::vector<std::string_view>& fields) {
        ++row_number;
        Row row;
        if (const std::optional<std::string> wrong = read_row(fields, matched, row)) {
          bad.push_back(fmt::format("row {}: {}; dropped", row_number, *wrong));
          return;
        }
        take(std::move(row));
      });
  for (std::string& complaint : bad) reading.complain(std::move(complaint));
  reading.rows -= bad.size();
  if (std::ranges::find(matched, &columns.front()) == matched.end()) {
    throw_bad_input("has no column 'cell'", file.string(), "is it a file of a run?");
  }
  return reading;
}

}  // namespace

bool comes_before(const Record& a, const Record& b) {
  return std::tie(a.problem, a.method, a.operators, a.seed, a.cell) <
         std::tie(b.problem, b.method, b.operators, b.seed, b.cell);
}

std::string results_csv(std::vector<Record> records) {
  std::stable_sort(records.begin(), records.end(), comes_before);
  return to_csv(records, result_columns());
}

std::string front_csv(const std::vector<FrontRecord>& records) {
  return to_csv(records, front_columns());
}

std::string trace_csv(const std::vector<TraceRecord>& records) {
  return to_csv(records, trace_columns());
}

std::string curves_csv(const std::vector<CurveRecord>& records) {
  return to_csv(records, curve_columns());
}

std::string planned_csv(const std::vector<PlannedCell>& cells) {
  return to_csv(cells, planned_columns());
}

CsvReading read_results(const std::filesystem::path& file,
                        const std::function<void(Record&&)>& take) {
  return read_rows(file, result_columns(), take);
}

CsvReading read_front(const std::filesystem::path& file,
                      const std::function<void(FrontRecord&&)>& take) {
  return read_rows(file, front_columns(), take);
}

CsvReading read_trace(const std::filesystem::path& file,
                      const std::function<void(TraceRecord&&)>& take) {
  return read_rows(file, trace_columns(), take);
}

CsvReading read_curves(const std::filesystem::path& file,
                       const std::function<void(CurveRecord&&)>& take) {
  return read_rows(file, curve_columns(), take);
}

CsvReading read_planned(const std::filesystem::path& file,
                        const std::function<void(PlannedCell&&)>& take) {
  return read_rows(file, planned_columns(), take);
}

}  // namespace tribench
