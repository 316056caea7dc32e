// SPDX-License-Identifier: MIT
#include "problems/reading/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <ostream>
#include <set>

#include "foundation/error.hpp"
#include "foundation/suggestion.hpp"
#include "foundation/text.hpp"
#include "problems/reading/channel_names.hpp"
#include "problems/reading/csv_cells.hpp"
#include "problems/reading/csv_checks.hpp"

namespace tribench {
namespace {

// What a column turned out to be.
enum class ColumnKind { number, text, movement };

struct Column {
  NameReading reading;
  bool role_given = false;
  ColumnKind kind = ColumnKind::number;
};

std::string cell_complaint(std::string_view cell) {
  if (cell.empty()) return "the cell is empty";
  double value = 0;
  const bool too_large = read_cell(cell, value) == CellKind::missing && value != 0;
  return fmt::format("'{}' is {}", cell,
                     too_large ? "too large for what is measured" : "not a finite number");
}

std::string number_mend(std::string_view cell, char delimiter) {
  if (delimiter != ',' && cell.find(',') != std::string_view::npos) {
    return "write numbers with a decimal point";
  }
  return "mend the value, or drop such rows with --drop-missing";
}

void check_roles_name_columns(const CsvCells& cells, const CsvOptions& options,
                              std::string_view file) {
  for (const auto& [column, role] : options.roles) {
    if (std::find(cells.header.begin(), cells.header.end(), column) != cells.header.end()) continue;
    throw_bad_input(fmt::format("a role is given for column '{}', which is not there", column),
                    file, did_you_mean(column, cells.header));
  }
}

// Text where no cell is a number; but a role that needs numbers is never text.
ColumnKind kind_of(const CsvCells& cells, std::size_t column, const NameReading& reading) {
  if (reading.role == Role::movement) return ColumnKind::movement;
  if (reading.role != Role::none) return ColumnKind::number;
  bool has_text = false;
  for (const CsvLine& line : cells.lines) {
    if (line.blank()) continue;
    double value = 0;
    const CellKind kind = read_cell(line.cells[column], value);
    if (kind == CellKind::number) return ColumnKind::number;
    has_text = has_text || kind == CellKind::text;
  }
  return has_text ? ColumnKind::text : ColumnKind::number;
}

// A role given by hand takes it away from columns that only sound like it; of several that sound
// alike the first keeps it.
void settle_roles(const CsvCells& cells, std::vector<Column>& columns, DataFile& reading) {
  std::map<Role, std::size_t> owner;
  for (const bool given : {true, false}) {
    for (std::size_t j = 0; j < columns.size(); ++j) {
      Column& column = columns[j];
      if (column.role_given != given || column.reading.role == Role::none) continue;
      const auto [place, is_new] = owner.try_emplace(column.reading.role, j);
      if (is_new) continue;
      if (!given) {
        reading.warnings.push_back(fmt::format(
            "column '{}' is read without a role: '{}' already is the {}", cells.header[j],
            cells.header[place->second], role_name(column.reading.role)));
      }
      if (!given || column.reading.role == Role::movement) column.reading.role = Role::none;
    }
  }
}

std::vector<Column> read_columns(const CsvCells& cells, const CsvOptions& options,
                                 DataFile& reading) {
  std::vector<Column> columns;
  for (const std::string& name : cells.header) {
    Column column;
    column.reading = read_channel_name(name);
    if (const auto given = options.roles.find(name); given != options.roles.end()) {
      column.reading.role = given->second;
      column.role_given = true;
    }
    columns.push_back(std::move(column));
  }
  settle_roles(cells, columns, reading);
  for (std::size_t j = 0; j < columns.size(); ++j) {
    columns[j].kind = kind_of(cells, j, columns[j].reading);
  }
  return columns;
}

// The first cell of a line that should be a number and is not; the header's size where all are.
// Text in a column of numbers is never dropped silently: only missing values are.
std::size_t first_missing(const CsvCells& cells, const CsvLine& line,
                          const std::vector<Column>& columns, std::string_view file,
                          std::vector<double>& values) {
  if (line.blank()) return 0;
  std::size_t missing = columns.size();
  for (std::size_t j = 0; j < columns.size(); ++j) {
    if (columns[j].kind == ColumnKind::movement && line.cells[j].empty()) {
      missing = std::min(missing, j);
    }
    if (columns[j].kind != ColumnKind::number) continue;
    const CellKind kind = read_cell(line.cells[j], values[j]);
    if (kind == CellKind::text) {
      throw_bad_input(cell_complaint(line.cells[j]), csv_place(file, line.number, cells.header[j]),
                      number_mend(line.cells[j], cells.delimiter));
    }
    if (kind == CellKind::missing) missing = std::min(missing, j);
  }
  return missing;
}

// Gives each movement its number; rows of one stand together.
class MovementCounter {
 public:
  MovementCounter(Dataset& data, std::string_view file) : data_(data), file_(file) {}

  void add(const std::string& name, std::size_t line) {
    if (data_.movement_names.empty() || data_.movement_names.back() != name) {
      if (!seen_.insert(name).second) {
        throw_bad_input(fmt::format("movement '{}' goes on after another one began", name),
                        csv_place(file_, line),
                        "rows of one movement stand together: sort the file, or give each "
                        "recording its own name");
      }
      data_.movement_names.push_back(name);
    }
    data_.movement.push_back(static_cast<int>(data_.movement_names.size()) - 1);
  }

 private:
  Dataset& data_;
  std::string_view file_;
  std::set<std::string> seen_;
};

std::string stem_of(std::string_view file) { return std::filesystem::path(file).stem().string(); }

void fill_rows(const CsvCells& cells, const std::vector<Column>& columns, std::string_view file,
               const CsvOptions& options, DataFile& reading, std::vector<std::size_t>& kept_lines) {
  const auto movement = std::find_if(columns.begin(), columns.end(), [](const Column& column) {
    return column.kind == ColumnKind::movement;
  });
  MovementCounter movements(reading.data, file);
  std::vector<double> values(columns.size());
  for (const CsvLine& line : cells.lines) {
    const std::size_t missing = first_missing(cells, line, columns, file, values);
    if (missing < columns.size()) {
      if (!options.drop_missing) {
        const std::string_view cell = line.blank() ? std::string_view() : line.cells[missing];
        throw_bad_input(cell_complaint(cell), csv_place(file, line.number, cells.header[missing]),
                        number_mend(cell, cells.delimiter));
      }
      ++reading.dropped_rows;
      continue;
    }
    movements.add(movement == columns.end()
                      ? stem_of(file)
                      : line.cells[static_cast<std::size_t>(movement - columns.begin())],
                  line.number);
    std::size_t channel = 0;
    std::size_t text = 0;
    for (std::size_t j = 0; j < columns.size(); ++j) {
      if (columns[j].kind == ColumnKind::number) {
        reading.data.channels[channel++].values.push_back(values[j]);
      } else if (columns[j].kind == ColumnKind::text) {
        reading.texts[text++].values.push_back(line.cells[j]);
      }
    }
    kept_lines.push_back(line.number);
  }
}

}  // namespace

DataFile parse_csv(std::string_view text, std::string_view file, const CsvOptions& options) {
  const CsvCells cells = split_csv(text, file);
  check_roles_name_columns(cells, options, file);
  DataFile reading;
  const std::vector<Column> columns = read_columns(cells, options, reading);
  reading.data.name = stem_of(file);
  for (std::size_t j = 0; j < columns.size(); ++j) {
    if (columns[j].kind == ColumnKind::number) {
      reading.data.channels.push_back(
          {cells.header[j], columns[j].reading.unit, columns[j].reading.role, {}});
    } else if (columns[j].kind == ColumnKind::text) {
      reading.texts.push_back({cells.header[j], {}});
    }
  }
  if (reading.data.channels.empty()) {
    throw_bad_input("no column holds numbers", file, "give at least one column of numbers");
  }
  std::vector<std::size_t> lines;
  fill_rows(cells, columns, file, options, reading, lines);
  if (reading.data.rows() == 0) {
    throw_bad_input(fmt::format("all {} rows have missing values", reading.dropped_rows), file,
                    "remove the column that is empty");
  }
  check_time(reading, lines, file);
  demote_current(options, reading);
  check_torque_units(reading.data, file);
  return reading;
}

DataFile read_csv(const std::filesystem::path& file, const CsvOptions& options) {
  std::error_code code;
  if (std::filesystem::is_directory(file, code)) {
    throw_bad_input("this is a folder", file.string(), "give a CSV file");
  }
  return parse_csv(read_file(file), file.string(), options);
}

namespace {

void check_same_channels(const DataFile& all, const DataFile& next, std::string_view file) {
  const auto names = [](const DataFile& reading) {
    std::vector<std::string> list;
    for (const Channel& channel : reading.data.channels) list.push_back(channel.name);
    for (const TextColumn& column : reading.texts) list.push_back(column.name + " (text)");
    return list;
  };
  if (names(all) == names(next)) return;
  throw_bad_input(fmt::format("its columns ({}) are not those of the first file ({})",
                              fmt::join(names(next), ", "), fmt::join(names(all), ", ")),
                  file, "give files with the same columns in the same order");
}

void append(DataFile& all, DataFile next, std::string_view file) {
  check_same_channels(all, next, file);
  const auto first = static_cast<int>(all.data.movement_names.size());
  for (std::string& name : next.data.movement_names) {
    auto& names = all.data.movement_names;
    const bool taken = std::find(names.begin(), names.end(), name) != names.end();
    names.push_back(taken ? fmt::format("{} ({})", name, file) : std::move(name));
  }
  for (const int movement : next.data.movement) all.data.movement.push_back(first + movement);
  for (std::size_t j = 0; j < all.data.channels.size(); ++j) {
    auto& values = all.data.channels[j].values;
    const auto& more = next.data.channels[j].values;
    values.insert(values.end(), more.begin(), more.end());
  }
  for (std::size_t j = 0; j < all.texts.size(); ++j) {
    auto& values = all.texts[j].values;
    const auto& more = next.texts[j].values;
    values.insert(values.end(), more.begin(), more.end());
  }
  all.dropped_rows += next.dropped_rows;
  for (std::string& warning : next.warnings) {
    all.warnings.push_back(fmt::format("{}: {}", file, warning));
  }
}

}  // namespace

DataFile read_csv_files(std::span<const std::filesystem::path> files, const CsvOptions& options) {
  if (files.empty()) throw_bad_input("no data file is given", {}, "name one CSV file or more");
  DataFile all = read_csv(files.front(), options);
  for (const std::filesystem::path& file : files.subspan(1)) {
    append(all, read_csv(file, options), file.string());
  }
  return all;
}

namespace {

std::string quoted(const std::string& cell) {
  if (cell.find_first_of(",;\t\"\n\r") == std::string::npos && !cell.empty() &&
      cell.front() != ' ' && cell.back() != ' ') {
    return cell;
  }
  std::string text = "\"";
  for (const char c : cell) {
    if (c == '"') text += '"';
    text += c;
  }
  return text + '"';
}

}  // namespace

void write_csv(const Dataset& data, std::ostream& out) {
  fmt::memory_buffer buffer;
  buffer.append(std::string_view("movement"));
  for (const Channel& channel : data.channels) {
    fmt::format_to(std::back_inserter(buffer), ",{}", quoted(channel.name));
  }
  buffer.push_back('\n');
  for (std::size_t r = 0; r < data.rows(); ++r) {
    const auto movement = static_cast<std::size_t>(data.movement[r]);
    buffer.append(std::string_view(quoted(data.movement_names[movement])));
    for (const Channel& channel : data.channels) {
      fmt::format_to(std::back_inserter(buffer), ",{}", channel.values[r]);
    }
    buffer.push_back('\n');
  }
  out.write(buffer.data(), static_cast<std::streamsize>(buffer.size()));
}

void write_csv(const Dataset& data, const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::binary);
  if (out) write_csv(data, out);
  out.flush();
  if (!out) {
    throw Error(ErrorKind::failed, "cannot write the file", file.string(),
                "check that the folder exists and is writable");
  }
}

}  // namespace tribench
