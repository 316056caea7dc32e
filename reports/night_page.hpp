// SPDX-License-Identifier: MIT
//
// A nightly store as one page without a network: the changes of level, a trend line for each method
// on each problem and for each bench, the base. For what it shows: night_history.hpp.
#pragma once

#include <string>

#include "reports/night_history.hpp"

namespace tribench {

// At most some hundred points a line: ten years stay below some megabytes.
std::string history_page(const StoreHistory& history);

}  // namespace tribench
