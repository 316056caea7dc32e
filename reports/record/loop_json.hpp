// SPDX-License-Identifier: MIT
//
// loop.json: a LoopRecord with stable keys. The keys of the diagnosis are documented in
// docs/closed_loop.md; figures that do not exist are null.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "reports/record/loop_record.hpp"

namespace tribench {

// Without `pictures`.
nlohmann::ordered_json loop_json(const LoopRecord& record);

// The pictures' series (loop_pictures.hpp), without `residuals`: arrays side by side, rounded to
// what a picture shows.
nlohmann::ordered_json loop_pictures_json(const LoopRecord& record);

// loop.json as it is written: both, and under pictures/residuals the rows themselves, thinned.
std::string write_loop_json(const LoopRecord& record);

}  // namespace tribench
