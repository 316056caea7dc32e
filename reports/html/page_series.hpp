// SPDX-License-Identifier: MIT
//
// The parts of a page's data that are series: fronts, traces, shares, curves. Each is bounded.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "reports/run_folder.hpp"
#include "reports/summary.hpp"

namespace tribench {

// Formulas of all seeds of a method that no other of them beats in complexity and error, and the
// chosen ones.
nlohmann::ordered_json fronts_json(const RunFolder& run);

// traces: best training error so far, median and range over seeds, on a logarithmic grid of
// evaluations and of CPU seconds. ecdf: share of (cell, target) pairs reached against evaluations;
// targets are 2, 1.5, 1.2, 1.1, 1.05 and 1.01 times the best training error that any method had on
// the same problem and seed (Hansen et al. 2021, COCO).
nlohmann::ordered_json traces_json(const RunFolder& run, const RunSummary& summary,
                                   nlohmann::ordered_json& ecdf);

// Share of cells within a factor of the best error of their problem and seed (Dolan, More 2002).
nlohmann::ordered_json profiles_json(const RunFolder& run, const RunSummary& summary);

// curves.csv as columns a curve.
nlohmann::ordered_json curves_json(const RunFolder& run);

// NaN and infinity become null.
nlohmann::ordered_json finite_or_null(double value);

}  // namespace tribench
