// SPDX-License-Identifier: MIT
//
// Data files, in and out. One header line, then numbers; comma, semicolon or tab (whichever the
// header has most of), quotes, a byte order mark, CRLF and a missing last newline are accepted.
//
//   movement,time_s,velocity_rad_s,friction_torque_Nm
//   up slow,0.000,0.31,9.82
//
// Roles and units come from the column's name (see channel_names.hpp) unless given. A column named
// `movement` may hold any text; rows of one movement stand together, and their order is the
// campaign's. Without one the file is one movement, named after the file. A column that holds no
// number at all is text: it is kept apart and is no channel.
//
// Missing values: an empty cell, nan, inf, NA. They are an error that names line and column, or
// the row is dropped and counted. Nothing is interpolated.
//
// Errors: tribench::Error (bad_input) with file:line:column and the mend. Cost: O(bytes).
#pragma once

#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "problems/dataset.hpp"

namespace tribench {

struct CsvOptions {
  std::map<std::string, Role, std::less<>> roles;  // by column; wins over the name
  bool drop_missing = false;
};

struct TextColumn {
  std::string name;
  std::vector<std::string> values;  // per row of the dataset
};

struct DataFile {
  Dataset data;
  std::vector<TextColumn> texts;
  std::size_t dropped_rows = 0;
  std::vector<std::string> warnings;  // one sentence each
};

DataFile read_csv(const std::filesystem::path& file, const CsvOptions& options = {});

// The same from memory; `file` names it in messages.
DataFile parse_csv(std::string_view text, std::string_view file, const CsvOptions& options = {});

// Several files as one campaign, in the order given; all must have the same channels. Movements
// that share a name in different files are told apart by the file's name.
DataFile read_csv_files(std::span<const std::filesystem::path> files,
                        const CsvOptions& options = {});

// Comma-separated, numbers as the shortest text that reads back to the same double, a `movement`
// column first. Throws Error (failed) where the file cannot be written.
void write_csv(const Dataset& data, std::ostream& out);
void write_csv(const Dataset& data, const std::filesystem::path& file);

}  // namespace tribench
