// SPDX-License-Identifier: MIT
//
// A delimited text file as cells: what is a cell and where it stands, not what it means.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tribench {

struct CsvLine {
  std::size_t number = 0;  // in the file, from 1; of the line where the record begins
  std::vector<std::string> cells;
  bool blank() const { return cells.size() == 1 && cells.front().empty(); }
};

struct CsvCells {
  char delimiter = ',';
  std::vector<std::string> header;
  std::vector<CsvLine> lines;  // as many cells as the header; blank lines have one empty cell
};

// Cells are trimmed; a quoted cell keeps its blanks. Throws Error (bad_input) where the text is
// empty, binary, ragged, has an open quote, or its header lacks, repeats or numbers the columns.
CsvCells split_csv(std::string_view text, std::string_view file);

// "file:line" and "file:line:column name".
std::string csv_place(std::string_view file, std::size_t line);
std::string csv_place(std::string_view file, std::size_t line, std::string_view column);

// Fits square and multiply what they are given until larger numbers leave the range of doubles.
// Nothing measured is as large (nanoseconds since 1970 are 2e18), but markers for missing values
// are (3.4e38, 1.8e308).
inline constexpr double kLargestNumber = 1e30;

enum class CellKind { number, missing, text };
// number: a finite one that makes up the whole cell; missing: empty, nan, na, inf in any case and
// sign, and numbers beyond kLargestNumber.
CellKind read_cell(std::string_view cell, double& value);

}  // namespace tribench
