// SPDX-License-Identifier: MIT
#include "problems/reading/csv_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "foundation/error.hpp"
#include "foundation/text.hpp"
#include "problems/reading/csv_scanner.hpp"

namespace tribench {
namespace {

bool is_missing(std::string_view cell) {
  if (cell.find_first_not_of('-') == std::string_view::npos) return true;  // empty, or a dash
  if (cell.front() == '+' || cell.front() == '-') cell.remove_prefix(1);
  if (cell.starts_with("1.#")) return true;  // "-1.#IND", as older libraries of C write it
  if (cell.empty() || cell.size() > 9) return false;
  constexpr std::array kMissing = {"nan",  "inf",  "infinity", "na",     "n/a", "n.a.",  "#n/a",
                                   "null", "none", "nil",      "<null>", "\\n", "nan()", "?"};
  return std::find(kMissing.begin(), kMissing.end(), in_small_letters(cell)) != kMissing.end();
}

CellKind read_hexadecimal(std::string_view digits, double& value) {
  std::uint64_t whole = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stop, code] = std::from_chars(digits.data() + 2, end, whole, 16);
  if (stop != end || code != std::errc()) return CellKind::text;
  value = static_cast<double>(whole);
  return CellKind::number;
}

}  // namespace

bool is_hexadecimal(std::string_view cell) {
  if (cell.starts_with('+')) cell.remove_prefix(1);
  return cell.starts_with("0x") || cell.starts_with("0X");
}

CellKind read_cell(std::string_view cell, bool decimal_comma, double& value) {
  constexpr std::string_view kMinus = "\xE2\x88\x92";  // as a printed text has it
  if (cell.find(kMinus) != std::string_view::npos) {
    std::string plain(cell);
    for (std::size_t at = plain.find(kMinus); at != std::string::npos; at = plain.find(kMinus)) {
      plain.replace(at, kMinus.size(), "-");
    }
    return read_cell(plain, decimal_comma, value);
  }
  std::string_view digits = cell;
  // from_chars takes no plus sign and would take a second minus after one.
  if (!digits.empty() && digits.front() == '+') {
    digits.remove_prefix(1);
    if (!digits.empty() && digits.front() == '-') return CellKind::text;
  }
  std::array<char, 64> plain;
  const std::size_t comma = decimal_comma ? digits.find(',') : std::string_view::npos;
  if (comma != std::string_view::npos && digits.size() <= plain.size()) {
    if (digits.find('.') != std::string_view::npos) return CellKind::text;
    std::ranges::copy(digits, plain.begin());
    plain[comma] = '.';
    digits = {plain.data(), digits.size()};
  }
  if (is_hexadecimal(digits)) return read_hexadecimal(digits, value);
  // Fortran writes 1.5D-03.
  const std::size_t exponent = digits.find_first_of("dD");
  if (exponent != std::string_view::npos && exponent > 0 && digits.size() <= plain.size()) {
    if (digits.data() != plain.data()) std::ranges::copy(digits, plain.begin());
    plain[exponent] = 'e';
    digits = {plain.data(), digits.size()};
  }
  const char* end = digits.data() + digits.size();
  const auto [stop, code] = std::from_chars(digits.data(), end, value);
  if (stop != end || code == std::errc::invalid_argument) {
    return is_missing(cell) ? CellKind::missing : CellKind::text;
  }
  if (code == std::errc::result_out_of_range) {
    // Too small is 0 to the last bit; too large has no double.
    value = std::strtod(std::string(digits).c_str(), nullptr);
    return CellKind::number;
  }
  return std::isfinite(value) ? CellKind::number : CellKind::missing;
}

void check_width(std::size_t cells, bool last_is_empty, const CsvLayout& layout,
                 std::string_view file, std::size_t line) {
  const std::size_t expected = layout.header.size();
  if (cells == expected || (cells == expected + 1 && last_is_empty)) return;
  throw_bad_input(
      fmt::format("{} cell{} where the header has {}", cells, cells == 1 ? "" : "s", expected),
      csv_place(file, line),
      cells > expected && layout.delimiter == ','
          ? "numbers with a decimal comma need semicolons or tabs between them, or "
            "quotes; quote a cell that holds a comma"
          : "complete the line or remove it");
}

CsvCells split_csv(std::string_view text, std::string_view file) {
  CsvLayout layout = find_layout(text, file);
  CsvCells cells;
  cells.delimiter = layout.delimiter;
  CsvScanner scanner(text, file, layout.delimiter, layout.begin, layout.line);
  while (scanner.find_record(layout.width_behind_sign())) {
    CsvLine line;
    line.number = scanner.line();
    do {
      line.cells.emplace_back(scanner.next_cell());
    } while (scanner.goes_on());
    check_width(line.cells.size(), line.cells.back().empty(), layout, file, line.number);
    line.cells.resize(layout.header.size());
    cells.lines.push_back(std::move(line));
  }
  cells.header = std::move(layout.header);
  return cells;
}

}  // namespace tribench
