// SPDX-License-Identifier: MIT
#include "problems/reading/thousands.hpp"

#include <algorithm>
#include <array>

#include "problems/reading/csv_cells.hpp"
#include "problems/reading/csv_scanner.hpp"

namespace tribench {
namespace {

constexpr std::array<std::string_view, 7> kSigns = {
    ",", ".", "'", " ", "\xE2\x80\x99", "\xC2\xA0", "\xE2\x80\xAF"};

std::size_t digits_at(std::string_view text) {
  return std::min(text.find_first_not_of("0123456789"), text.size());
}

// A number's parts as some signs tell them.
struct Parted {
  bool is_number = false;
  std::size_t groups = 0;  // of three digits, behind a sign
  bool has_decimals = false;
};

Parted part_number(std::string_view cell, const NumberSigns& signs) {
  Parted parted;
  if (cell.starts_with('+') || cell.starts_with('-')) cell.remove_prefix(1);
  std::size_t digits = digits_at(cell);
  const bool may_be_first = digits > 0 && digits <= 3 && cell.front() != '0';
  cell.remove_prefix(digits);
  while (may_be_first && cell.starts_with(signs.thousands) &&
         digits_at(cell.substr(signs.thousands.size())) == 3) {
    cell.remove_prefix(signs.thousands.size() + 3);
    ++parted.groups;
  }
  if (cell.starts_with(signs.decimal)) {
    cell.remove_prefix(1);
    digits += digits_at(cell);
    cell.remove_prefix(digits_at(cell));
    parted.has_decimals = true;
  }
  if (digits > 0 && (cell.starts_with('e') || cell.starts_with('E'))) {
    cell.remove_prefix(1);
    if (cell.starts_with('+') || cell.starts_with('-')) cell.remove_prefix(1);
    digits = digits_at(cell);
    cell.remove_prefix(digits);
  }
  parted.is_number = digits > 0 && cell.empty();
  return parted;
}

// A comma or a point before three digits may be the decimal sign, unless that or another stands
// behind it.
bool shows_thousands(const Parted& parted, const NumberSigns& signs) {
  const bool may_be_decimal = signs.thousands == "," || signs.thousands == ".";
  return parted.groups > 0 && (!may_be_decimal || parted.has_decimals || parted.groups > 1);
}

struct Candidate {
  NumberSigns signs;
  bool is_possible = true;
  bool is_shown = false;
};

std::vector<Candidate> all_candidates() {
  std::vector<Candidate> candidates;
  for (const std::string_view sign : kSigns) {
    for (const char decimal : {'.', ','}) {
      if (sign.front() != decimal) candidates.push_back({{decimal, sign}});
    }
  }
  return candidates;
}

}  // namespace

bool may_hold_thousands(std::string_view cell) {
  return std::ranges::any_of(all_candidates(), [&](const Candidate& candidate) {
    const Parted parted = part_number(cell, candidate.signs);
    return parted.is_number && parted.groups > 0;
  });
}

std::optional<NumberSigns> find_thousands(std::string_view text, std::string_view file,
                                          const CsvLayout& layout,
                                          const std::vector<bool>& looked_at) {
  std::vector<Candidate> candidates = all_candidates();
  CsvScanner scanner(text, file, layout.delimiter, layout.begin, layout.line);
  while (scanner.find_record(layout.width_behind_sign())) {
    std::size_t column = 0;
    do {
      const std::string_view cell = scanner.next_cell();
      const bool is_looked_at = column < looked_at.size() && looked_at[column];
      ++column;
      double value = 0;
      if (!is_looked_at || read_cell(cell, false, value) == CellKind::missing) continue;
      for (Candidate& candidate : candidates) {
        const Parted parted = part_number(cell, candidate.signs);
        candidate.is_possible = candidate.is_possible && parted.is_number;
        candidate.is_shown = candidate.is_shown || shows_thousands(parted, candidate.signs);
      }
    } while (scanner.goes_on());
  }
  std::optional<NumberSigns> found;
  for (const Candidate& candidate : candidates) {
    if (!candidate.is_possible || !candidate.is_shown) continue;
    if (found && found->thousands != candidate.signs.thousands) return {};
    if (!found) found = candidate.signs;
  }
  return found;
}

std::string without_thousands(std::string_view cell, std::string_view sign) {
  const bool is_parted = std::ranges::any_of(std::array{'.', ','}, [&](char decimal) {
    return sign.front() != decimal && part_number(cell, {decimal, sign}).is_number;
  });
  std::string plain(cell);
  if (!is_parted) return plain;
  for (std::size_t at = plain.find(sign); at != std::string::npos; at = plain.find(sign)) {
    plain.erase(at, sign.size());
  }
  return plain;
}

}  // namespace tribench
