// SPDX-License-Identifier: MIT
//
// A model of the closed loop as C for a controller: the formula over what sensors give, and where
// it needs the distance since the last reversal, which none gives, the history that keeps it up to
// date.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "algorithms/expression/export.hpp"
#include "problems/preparation/derived_channels.hpp"

namespace tribench::loop {

struct NamedFormula {
  Expression formula;
  std::vector<std::string> names;  // of its inputs
};

// `formula` with what follows from other inputs put in: `formulas` by name ("g": "4.9*sin(q)"). A
// name stays whose sign the formula reads, as no formula has signs.
NamedFormula with_formulas(const Expression& formula, std::span<const std::string> names,
                           const std::map<std::string, std::string>& formulas);

// path: how `d` follows from what is measured; nothing where it is an input like any other.
std::string controller_code(const Expression& formula, std::span<const std::string> names,
                            const ExportOptions& options, std::optional<PathFrom> path);

}  // namespace tribench::loop
