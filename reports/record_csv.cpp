// SPDX-License-Identifier: MIT
#include "reports/record_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <tuple>
#include <variant>

#include "foundation/error.hpp"

namespace tribench {
namespace {

template <typename Row>
using Member =
    std::variant<std::string Row::*, int Row::*, bool Row::*, std::uint64_t Row::*, double Row::*>;

// A column of a file: its name and where its value lives in a row.
template <typename Row>
struct Column {
  const char* name;
  Member<Row> member;
};

using R = Record;
constexpr Column<Record> kResultColumns[] = {
    {"cell", &R::cell},
    {"problem", &R::problem},
    {"dataset", &R::dataset},
    {"joint", &R::joint},
    {"load", &R::load},
    {"method", &R::method},
    {"operators", &R::operators},
    {"seed", &R::seed},
    {"status", &R::status},
    {"reason", &R::reason},
    {"mae_train", &R::mae_train},
    {"mae_test", &R::mae_test},
    {"rmse_test", &R::rmse_test},
    {"max_error_test", &R::max_error_test},
    {"r2_test", &R::r2_test},
    {"mae_truth", &R::mae_truth},
    {"complexity", &R::complexity},
    {"nodes", &R::nodes},
    {"evaluations", &R::evaluations},
    {"fit_cpu_s", &R::fit_cpu_s},
    {"fit_wall_s", &R::fit_wall_s},
    {"peak_memory_mib", &R::peak_memory_mib},
    {"eval_ns_per_row", &R::eval_ns_per_row},
    {"singularity", &R::singularity},
    {"witness", &R::witness},
    {"formula", &R::formula},
    {"relative_error_train", &R::relative_error_train},
    {"relative_error_test", &R::relative_error_test},
    {"complexity_adaptation", &R::complexity_adaptation},
    {"mae_ceiling", &R::mae_ceiling},
    {"mae_law", &R::mae_law},
    {"mae_refitted", &R::mae_refitted},
    {"mae_truth_refitted", &R::mae_truth_refitted},
    {"grid_check", &R::grid_check},
    {"dissipative", &R::dissipative},
    {"monotone", &R::monotone},
    {"odd", &R::odd},
    {"fit_instructions", &R::fit_instructions},
    {"motion_error", &R::motion_error},
    {"note", &R::note},
};

using F = FrontRecord;
constexpr Column<FrontRecord> kFrontColumns[] = {
    {"cell", &F::cell},           {"complexity", &F::complexity}, {"nodes", &F::nodes},
    {"mae_train", &F::mae_train}, {"mae_test", &F::mae_test},     {"singularity", &F::singularity},
    {"chosen", &F::chosen},       {"formula", &F::formula},
};

using T = TraceRecord;
constexpr Column<TraceRecord> kTraceColumns[] = {
    {"cell", &T::cell},
    {"evaluations", &T::evaluations},
    {"cpu_s", &T::cpu_s},
    {"train_error", &T::train_error},
};

using C = CurveRecord;
constexpr Column<CurveRecord> kCurveColumns[] = {
    {"cell", &C::cell},
    {"problem", &C::problem},
    {"method", &C::method},
    {"operators", &C::operators},
    {"picture", &C::picture},
    {"curve", &C::curve},
    {"x_name", &C::x_name},
    {"y_name", &C::y_name},
    {"x", &C::x},
    {"y", &C::y},
};

using P = PlannedCell;
constexpr Column<PlannedCell> kPlannedColumns[] = {
    {"cell", &P::cell},           {"problem", &P::problem}, {"method", &P::method},
    {"operators", &P::operators}, {"seed", &P::seed},
};

struct WriteField {
  std::string& line;

  void operator()(const std::string& value) const { append_csv_field(line, value); }
  void operator()(bool value) const { line += value ? "true" : "false"; }
  void operator()(double value) const { line += csv_number(value); }
  template <typename Integer>
  void operator()(Integer value) const {
    fmt::format_to(std::back_inserter(line), "{}", value);
  }
};

// A cell without a formula has no size: the counts are empty, not 0.
template <typename Row>
bool is_missing(const Row& /*row*/, const Column<Row>& /*column*/) {
  return false;
}

bool is_missing(const Record& row, const Column<Record>& column) {
  if (!row.formula.empty()) return false;
  const auto* count = std::get_if<int Record::*>(&column.member);
  return count != nullptr && *count != &Record::joint;
}

template <typename Row, std::size_t N>
void append_header(std::string& text, const Column<Row> (&columns)[N]) {
  for (std::size_t i = 0; i < N; ++i) {
    if (i > 0) text += ',';
    text += columns[i].name;
  }
  text += '\n';
}

template <typename Row, std::size_t N>
std::string to_csv(const std::vector<Row>& rows, const Column<Row> (&columns)[N]) {
  std::string text;
  append_header(text, columns);
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < N; ++i) {
      if (i > 0) text += ',';
      if (is_missing(row, columns[i])) continue;
      std::visit([&](auto member) { WriteField{text}(row.*member); }, columns[i].member);
    }
    text += '\n';
  }
  return text;
}

bool read_field(std::string_view text, std::string& value) {
  value.assign(text);
  return true;
}

bool read_field(std::string_view text, double& value) { return read_csv_number(text, value); }

bool read_field(std::string_view text, bool& value) {
  value = text == "true" || text == "1";
  return value || text.empty() || text == "false" || text == "0";
}

template <typename Integer>
bool read_field(std::string_view text, Integer& value) {
  if (text.empty()) return true;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && stop == text.data() + text.size();
}

// Which member each field of a file belongs to; null for a column that is not known.
template <typename Row, std::size_t N>
std::vector<const Column<Row>*> match_columns(const std::vector<std::string_view>& names,
                                              const Column<Row> (&columns)[N]) {
  std::vector<const Column<Row>*> matched;
  for (const std::string_view name : names) {
    const auto* found =
        std::find_if(columns, columns + N, [&](const auto& c) { return name == c.name; });
    matched.push_back(found == columns + N ? nullptr : found);
  }
  return matched;
}

template <typename Row, std::size_t N>
CsvReading read_rows(const std::filesystem::path& file, const Column<Row> (&columns)[N],
                     const std::function<void(Row&&)>& take) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw_bad_input("cannot be opened", file.string(), "check the path and its rights");
  std::vector<const Column<Row>*> matched;
  std::vector<std::string> bad;
  std::size_t row_number = 0;
  CsvReading reading = read_csv(
      in,
      [&](const std::vector<std::string_view>& names) { matched = match_columns(names, columns); },
      [&](const std::vector<std::string_view>& fields) {
        ++row_number;
        Row row;
        for (std::size_t i = 0; i < fields.size(); ++i) {
          if (matched[i] == nullptr) continue;
          const bool fine = std::visit(
              [&](auto member) { return read_field(fields[i], row.*member); }, matched[i]->member);
          if (!fine) {
            bad.push_back(fmt::format("row {}: {} is not a value of {}; dropped", row_number,
                                      fields[i], matched[i]->name));
            return;
          }
        }
        take(std::move(row));
      });
  for (std::string& complaint : bad) reading.complain(std::move(complaint));
  reading.rows -= bad.size();
  if (std::find(matched.begin(), matched.end(), &columns[0]) == matched.end()) {
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
  std::sort(records.begin(), records.end(), comes_before);
  return to_csv(records, kResultColumns);
}

std::string front_csv(const std::vector<FrontRecord>& records) {
  return to_csv(records, kFrontColumns);
}

std::string trace_csv(const std::vector<TraceRecord>& records) {
  return to_csv(records, kTraceColumns);
}

std::string curves_csv(const std::vector<CurveRecord>& records) {
  return to_csv(records, kCurveColumns);
}

std::string planned_csv(const std::vector<PlannedCell>& cells) {
  return to_csv(cells, kPlannedColumns);
}

CsvReading read_results(const std::filesystem::path& file,
                        const std::function<void(Record&&)>& take) {
  return read_rows(file, kResultColumns, take);
}

CsvReading read_front(const std::filesystem::path& file,
                      const std::function<void(FrontRecord&&)>& take) {
  return read_rows(file, kFrontColumns, take);
}

CsvReading read_trace(const std::filesystem::path& file,
                      const std::function<void(TraceRecord&&)>& take) {
  return read_rows(file, kTraceColumns, take);
}

CsvReading read_curves(const std::filesystem::path& file,
                       const std::function<void(CurveRecord&&)>& take) {
  return read_rows(file, kCurveColumns, take);
}

CsvReading read_planned(const std::filesystem::path& file,
                        const std::function<void(PlannedCell&&)>& take) {
  return read_rows(file, kPlannedColumns, take);
}

void write_file(const std::filesystem::path& file, std::string_view text) {
  std::filesystem::path partial = file;
  partial += ".partial";
  {
    std::ofstream out(partial, std::ios::binary | std::ios::trunc);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.flush();
    if (!out) {
      throw Error(ErrorKind::failed, "cannot be written", file.string(),
                  "check the disk's free space and the folder's rights");
    }
  }
  std::error_code error;
  std::filesystem::rename(partial, file, error);
  if (error) throw Error(ErrorKind::failed, error.message(), file.string());
}

}  // namespace tribench
