// SPDX-License-Identifier: MIT
//
// The cells of a delimited text one after the other, with the places that messages name. What parts
// the cells is known by then (csv_layout.hpp); what a cell holds is not asked (csv_cells.hpp).
// Cost: one pass, no copy but of quoted cells.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tribench {

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
  // A line that begins like a comment but has `width` cells is a row (0: never). Between blanks,
  // where every word of a comment is a cell, it is none if its first cell is the sign alone.
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
