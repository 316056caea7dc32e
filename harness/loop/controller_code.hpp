// SPDX-License-Identifier: MIT
//
// A model of the closed loop as C for a controller: the formula, and where it needs the distance
// since the last reversal, which no sensor gives, the history that keeps it up to date.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "algorithms/expression/export.hpp"
#include "problems/preparation/derived_channels.hpp"

namespace tribench::loop {

// path: how `d` follows from what is measured; nothing where it is an input like any other.
std::string controller_code(const Expression& formula, std::span<const std::string> names,
                            const ExportOptions& options, std::optional<PathFrom> path);

}  // namespace tribench::loop
