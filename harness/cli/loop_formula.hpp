// SPDX-License-Identifier: MIT
//
// What a command takes of a loop.json: the formula over what sensors give, and where it was fitted.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>

#include "algorithms/expression/input_box.hpp"
#include "problems/preparation/derived_channels.hpp"

namespace tribench {

struct LoopFormula {
  std::string text;
  std::optional<NamedBox> box;                  // its inputs in the rows that it was fitted to
  std::optional<loop::PathFrom> distance_from;  // where it is not measured
  std::string gravity;  // in q, beside the friction; empty where none was fitted
  std::string unit;     // of the friction: "N m", "N", "A" ...
};

// stay: inputs even where the file has a formula for them ("g"). Throws Error (bad_input) where the
// file is no loop.json.
LoopFormula read_loop_formula(const std::string& file, std::span<const std::string> stay = {});
// What was read of it already.
LoopFormula loop_formula_of(const nlohmann::json& json, const std::string& file,
                            std::span<const std::string> stay = {});

}  // namespace tribench
