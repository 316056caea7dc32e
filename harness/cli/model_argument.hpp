// SPDX-License-Identifier: MIT
//
// What a command calls MODEL: a formula, or a file with one: what `fit --json` or `--save` wrote,
// or a loop.json.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace tribench {

// An object with a text "formula" at least. Throws Error (bad_input) for a file that is none.
nlohmann::json model_argument(const std::string& model);

}  // namespace tribench
