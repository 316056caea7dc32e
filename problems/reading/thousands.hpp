// SPDX-License-Identifier: MIT
//
// Numbers whose thousands are parted by a sign: "1,234.5", "1.234,5", "1'234.5", "1 234,5".
// Internal to the room.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "problems/reading/csv_layout.hpp"

namespace tribench {

struct NumberSigns {
  char decimal = '.';
  std::string_view thousands;  // one sign, of one byte or more
};

// Whether a cell is a number with such signs, whichever they are.
bool may_hold_thousands(std::string_view cell);

// The signs of a file's numbers: the only ones by which every cell of the columns that are looked
// at is a number, and which a cell shows beyond doubt ("1,234" alone may be less than two). None
// where there are no such or several. Cost: one pass over the cells.
std::optional<NumberSigns> find_thousands(std::string_view text, std::string_view file,
                                          const CsvLayout& layout,
                                          const std::vector<bool>& looked_at);

// The cell with its thousands put together; as it stands where they are parted otherwise.
std::string without_thousands(std::string_view cell, std::string_view sign);

}  // namespace tribench
