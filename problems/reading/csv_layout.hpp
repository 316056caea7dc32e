// SPDX-License-Identifier: MIT
//
// How a delimited text file is laid out, found from its first lines: what parts the cells, which
// line names the columns, whether a row of units follows, what a decimal point looks like.
//
// Understood: comma, semicolon, tab, bar or blanks; a byte order mark; lines of comment (# % //)
// anywhere, with the header in the last of them where no other line names the columns; title lines
// before the header; a row of units; a separator at the end of the lines; decimal commas.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tribench {

struct CsvLayout {
  char delimiter = ',';  // ' ' stands for runs of blanks
  bool decimal_comma = false;
  std::vector<std::string> header;
  std::vector<std::string> units;  // per column where there is such a row, else empty
  std::string head;                // the bytes from the line of names up to the rows
  std::size_t begin = 0;           // byte at which the rows begin
  std::size_t line = 1;            // its number in the file, from 1
  std::vector<std::vector<std::string>> first_rows;  // some tens of them
  std::vector<std::string> notes;                    // what was passed over, one sentence each
};

// Throws Error (bad_input) where the text is empty, binary, has no row, or no line that names every
// column once; `nameless`: a first line of numbers is a row, and the columns are column_1, column_2
// and so on.
CsvLayout find_layout(std::string_view text, std::string_view file, bool nameless = false);

// Walks over the cells of a text from `place`. One record may take several lines where a quoted
// cell holds a line end.
class CsvScanner {
 public:
  CsvScanner(std::string_view text, std::string_view file, char delimiter, std::size_t place,
             std::size_t line)
      : text_(text), file_(file), delimiter_(delimiter), place_(place), line_(line) {}

  bool at_end() const { return place_ >= text_.size(); }
  std::size_t place() const { return place_; }
  std::size_t line() const { return line_; }
  void move_to(std::size_t place) { place_ = place; }

  // The next cell of the record, trimmed; quotes are taken off and doubled ones made single (the
  // view is valid until the next cell). Throws Error (bad_input) for a quote that is not closed.
  std::string_view next_cell();
  // After a cell: whether the record goes on. Passes the delimiter, or the line end.
  bool goes_on();
  // Passes blank lines and lines of comment at the begin of a record; true: something is left.
  // A line that begins like a comment but has `width` cells is a row (0: never).
  bool find_record(std::size_t width);
  void skip_line();

 private:
  std::string_view quoted_cell();
  bool is_blank(char c) const { return c == ' ' || c == '\r' || (c == '\t' && delimiter_ != '\t'); }
  bool is_comment(std::size_t width) const;

  std::string_view text_;
  std::string_view file_;
  char delimiter_;
  std::size_t place_;
  std::size_t line_;
  std::string unquoted_;
};

// "file:line" and "file:line:column name".
std::string csv_place(std::string_view file, std::size_t line);
std::string csv_place(std::string_view file, std::size_t line, std::string_view column);

}  // namespace tribench
