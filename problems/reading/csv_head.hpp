// SPDX-License-Identifier: MIT
//
// The first lines of a delimited text, one of which names the columns (csv_layout.hpp says which),
// and the block that LabVIEW writes before them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tribench {

struct HeadLine {
  std::size_t begin = 0;
  std::size_t number = 1;
  bool comment = false;
  std::string_view text;  // without the comment's sign
};

using Cells = std::vector<std::string>;

// Some tens of lines that are not blank; a quoted cell may go on in the next line.
std::vector<HeadLine> head_of(std::string_view text);

// Trimmed, without control characters.
Cells cells_of(const HeadLine& line, char delimiter);

// What stood before "***End_of_Header***" in a .lvm file; none: 0 lines.
struct LabviewHeader {
  std::size_t lines = 0;
  Cells units;  // per column, where it tells them
};
LabviewHeader take_labview_header(std::vector<HeadLine>& lines);

}  // namespace tribench
