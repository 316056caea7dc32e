// SPDX-License-Identifier: MIT
//
// How a delimited text file is laid out, found from its first lines: what parts the cells, which
// line names the columns, whether a row of units follows, what a decimal point looks like.
//
// Understood: comma, semicolon, tab, bar or blanks; a byte order mark; lines of comment (# % //)
// anywhere, with the header in the last of them where no other line names the columns; title lines
// before the header; a row of units; the blocks of LabVIEW and of TwinCAT's scope; a separator at
// the end of the lines; decimal commas.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tribench {

struct CsvLayout {
  char delimiter = ',';  // ' ' stands for runs of blanks
  bool decimal_comma = false;
  std::string thousands = {};  // the sign that parts them (thousands.hpp); empty: none does
  std::vector<std::string> header;
  std::vector<std::string> units;  // per column where there is such a row, else empty
  std::string head;                // the bytes from the line of names up to the rows
  std::size_t begin = 0;           // byte at which the rows begin
  std::size_t line = 1;            // its number in the file, from 1
  std::vector<std::vector<std::string>> first_rows;  // some tens of them
  std::vector<std::string> notes;                    // what was passed over, one sentence each

  // For CsvScanner::find_record: below a first column of numbers no row begins with the sign of a
  // comment, below one of texts ("#12") it may.
  std::size_t width_behind_sign() const;
};

// Throws Error (bad_input) where the text is empty, binary, has no row, or no line that names every
// column once; `nameless`: a first line of numbers is a row, and the columns are column_1, column_2
// and so on.
CsvLayout find_layout(std::string_view text, std::string_view file, bool nameless = false);

}  // namespace tribench
