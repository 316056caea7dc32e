// SPDX-License-Identifier: MIT
//
// A delimited text file as cells: what is a cell and where it stands, not what it means.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "problems/reading/csv_layout.hpp"

namespace tribench {

struct CsvLine {
  std::size_t number = 0;  // in the file, from 1; of the line where the record begins
  std::vector<std::string> cells;
  bool blank() const { return cells.size() == 1 && cells.front().empty(); }
};

struct CsvCells {
  char delimiter = ',';
  std::vector<std::string> header;
  std::vector<CsvLine> lines;  // as many cells as the header
};

// The whole text as cells; for files that are written again. Reading numbers: csv_columns.hpp.
// Cells are trimmed; a quoted cell keeps its blanks. Throws Error (bad_input) as find_layout does,
// and where a line is ragged or has an open quote.
CsvCells split_csv(std::string_view text, std::string_view file);

// Fits square and multiply what they are given until larger numbers leave the range of doubles.
// Nothing measured is as large (nanoseconds since 1970 are 2e18), but markers for missing values
// are (3.4e38, 1.8e308).
inline constexpr double kLargestMeasured = 1e30;
// Of a quantity in whatever unit: the sum of its squares is still a double. Methods are handed
// numbers beyond 1e30 divided by a power of two (algorithms/scaled_data.hpp).
inline constexpr double kLargestNumber = 1e150;

enum class CellKind { number, missing, text };
// number: one that makes up the whole cell, however large; missing: empty, nan, na, null, none,
// inf in any case and sign. decimal_comma: "1,5" is a number too.
CellKind read_cell(std::string_view cell, bool decimal_comma, double& value);

// As a bus's monitor writes a counter: 0x1F, a whole number without a sign.
bool is_hexadecimal(std::string_view cell);

// The record at the scanner: `width` cells and a separator at the end at most.
// Throws Error (bad_input) naming the line where it is ragged.
void check_width(std::size_t cells, bool last_is_empty, const CsvLayout& layout,
                 std::string_view file, std::size_t line);

}  // namespace tribench
