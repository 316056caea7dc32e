// SPDX-License-Identifier: MIT
//
// Comma-separated values as every file of a run uses them: RFC 4180, a header line first, LF at
// the end of every line (CRLF is read too), UTF-8. A missing figure is an empty field, never a
// word; numbers are the shortest text that reads back as the same double.
//
// Not for data sets (those have units, roles and other separators): problems/dataset reads them.
// Memory: one row at a time; a file of any length can be read.
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tribench {

// Appends one field, quoted only where it must be (comma, quote, CR or LF in it).
void append_csv_field(std::string& line, std::string_view text);
// Appends the fields with commas and the line's end.
void append_csv_row(std::string& text, std::span<const std::string> fields);

// Empty for NaN ("missing"), else the shortest text that reads back: 0.1, 1e-09, inf, -inf.
std::string csv_number(double value);
// NaN for an empty field. False where the text is not a number (value is then untouched).
bool read_csv_number(std::string_view text, double& value);

// What became of a file that was read: torn or damaged rows are counted, never hidden.
struct CsvReading {
  std::size_t rows = 0;                 // rows handed to the callback
  std::vector<std::string> complaints;  // "line 7: 21 fields where the header has 24", first 20
  std::size_t dropped = 0;              // rows not handed on, also those not among the complaints
  void complain(std::string text);      // counts a dropped row
};

// Calls `row` with the fields of every complete row after the header and with the number of the
// row's last line, from 1; the views die with the call.
// A last line without its end is taken for torn and dropped unless it has all its fields; a row
// with another number of fields than the header is dropped. `header` is called once, first.
CsvReading read_csv(
    std::istream& in, const std::function<void(const std::vector<std::string_view>&)>& header,
    const std::function<void(const std::vector<std::string_view>&, std::size_t)>& row);
// The same for whoever needs no line.
CsvReading read_csv(std::istream& in,
                    const std::function<void(const std::vector<std::string_view>&)>& header,
                    const std::function<void(const std::vector<std::string_view>&)>& row);

}  // namespace tribench
