// SPDX-License-Identifier: MIT
//
// The changes of a nightly store as a feed (Atom, RFC 4287), for whoever reads such things instead
// of a page: a line that changed its level, a night that became the base.
#pragma once

#include <string>

#include "reports/night_history.hpp"

namespace tribench {

// The newest first, a hundred at most. An entry's name is made of the line and the night that it
// changed in: where later nights move that night, readers see a second entry.
std::string history_feed(const StoreHistory& history);

}  // namespace tribench
