// SPDX-License-Identifier: MIT
//
// What loop.html is drawn from, as JSON: the words, and every picture with its titles, axes and
// series, in the units in which they are read. Scripts only draw it.
//
//   {"id": "effect-0", "kind": "effect", "title", "caption", "x", "y": axis titles,
//    "series": [{"name", "x": [..], "measured": [..], "spread", "before", "after", "band"}], ...}
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "reports/record/loop_record.hpp"

namespace tribench {

nlohmann::ordered_json loop_page_data(const LoopRecord& record);

}  // namespace tribench
