// SPDX-License-Identifier: MIT
//
// What people read about a closed loop: loop.md and loop.html from loop.json alone. Nothing is
// computed here that the diagnosis has not decided.
//
// loop.json has the keys
//   verdict, alpha, seed, noise, effects, leftover, untestable, events, error, candidates, formula
// and, for this report, an object `pictures` (every part of it may be absent):
//
//   "pictures": {
//     "target": "friction torque",            // y axis title
//     "unit": "N m",                           // of the target and of every residual
//     "base_formula": "...",                   // what was fitted before the loop, print form
//     "residuals": [{                          // one a channel that is worth a look
//        "channel": "velocity", "unit": "rad/s",
//        "x": [..],                            // thinned to about 1500 rows
//        "before": [..], "after": [..],        // residual of those rows; null where missing
//        "effect": [..],                       // what the refitted model says beyond the base
//        "effects": [{"family": "stribeck", "y": [..]}]  // optionally each by itself
//     }],
//     "movements": [{"name": "17", "test": true, "mae_before": 0.5, "mae_after": 0.1}],
//     "alias_map": {"families": ["stribeck", ..], "correlation": [[1, 0.3], [0.3, 1]]}
//   }
//
// Keys that are unknown are ignored, keys that are missing leave their part out; a part whose
// arrays differ in length is left out with a line that says so.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace tribench {

// One plain sentence an effect, the errors before and after, what else it could be, what to
// measure next. title: names the data, e.g. the file.
std::string loop_markdown(const nlohmann::json& loop, const std::string& title);

// One self-contained page with the pictures.
std::string loop_html(const nlohmann::json& loop, const std::string& title);

// Writes loop.md and loop.html into the folder. Throws Error (failed) where it cannot be written.
void write_loop_report(const nlohmann::json& loop, const std::string& title,
                       const std::filesystem::path& folder);

}  // namespace tribench
