// SPDX-License-Identifier: MIT
//
// The rows of a delimited text as columns of numbers and of text. Numbers are read in place, one
// pass over the bytes: 200 MB/s and more on one core (bench/reading_bench.cpp). What the columns
// mean is csv.hpp's business.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "problems/reading/csv_layout.hpp"

namespace tribench {

enum class ColumnKind {
  found,  // number or text, as the first cell that is not missing has it
  number,
  time,  // numbers, or times written as text (time_text.hpp): the first cell decides
  text,
  spare,   // numbers; unused, where a cell is none
  unused,  // not looked at
};

inline constexpr std::size_t kNoRow = static_cast<std::size_t>(-1);

struct CsvColumn {
  ColumnKind kind = ColumnKind::found;
  std::vector<double> numbers;      // NaN where a cell is missing or no number
  std::vector<std::string> texts;   // of a column of text
  std::size_t first_text = kNoRow;  // row of a cell that is no number, in a column of numbers
  bool told_in_text = false;        // times, in seconds
  bool told_in_minutes = false;     // the same, by a clock without hours throughout
  bool hexadecimal = false;         // a cell is (0x1F)
};

struct CsvColumns {
  std::vector<CsvColumn> columns;
  std::vector<std::size_t> places;  // byte of each row, from which a message finds line and cell
  // Rows before which the line of names stands again: another recording begins there.
  std::vector<std::size_t> parts;
  std::vector<std::string> notes;

  std::size_t rows() const { return places.size(); }
};

// kinds: as many as the header has columns. Throws Error (bad_input) where a row is ragged. A last
// line that is cut off (fewer cells, no line end: the recording stopped while writing) is dropped
// and noted; so is text without a number after the last row.
CsvColumns read_columns(std::string_view text, std::string_view file, const CsvLayout& layout,
                        std::span<const ColumnKind> kinds);

// Where a row stands and what it holds, for messages.
std::size_t line_of(std::string_view text, std::size_t place);
std::string cell_at(std::string_view text, const CsvLayout& layout, std::size_t place,
                    std::size_t column);

}  // namespace tribench
