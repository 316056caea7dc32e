// SPDX-License-Identifier: MIT
//
// Rows whose time does not run forward, as recorders leave them: a message that was overtaken by
// others, a file that has its newest row first, a clock that was set back or a second recording
// behind the first. What is plain is put in order and said; the rest is refused.
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

#include "problems/reading/csv.hpp"

namespace tribench {

// Rows of one movement come out in the order of their time. A few that stand out of it are sorted;
// where time runs back for good another movement begins, unless a column names the movements.
// line_of: of a row in the file, for messages. Throws Error (bad_input) where neither is plain;
// where a column changes whenever time runs back, the mend names it: it names the recordings.
void order_by_time(DataFile& reading, const std::function<std::size_t(std::size_t)>& line_of,
                   std::string_view file);

}  // namespace tribench
