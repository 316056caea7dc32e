// SPDX-License-Identifier: MIT
//
// A state along a recording: its column, and what it owes to its parameters and to its start.
//
// Rows come in runs: stretches without a break in time. Each run starts from rest
// (state_law.hpp); `start_influence` says how much of that is left. Row r of a run is the state at
// the row's time, after the step from the row before.
//
// All drives and times must be finite, times must not fall within a run. Cost: about 10 ns a row
// and state, with sensitivities some 60.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "algorithms/states/state_law.hpp"

namespace tribench {

// What happened, row by row; non-owning. Of a problem's tables: their trail (problems/problem.hpp).
struct MotionRows {
  std::span<const double* const> columns;  // columns[j]: rows() doubles of input j
  std::span<const double> time;            // s
  std::span<const std::size_t> starts;     // first rows of the runs, increasing, the first 0

  std::size_t rows() const { return time.size(); }
};

// out.size() == rows. The bits are those of `advance`, row after row.
void state_column(const StateDeclaration& state, const MotionRows& rows, std::span<double> out);

struct StateSensitivities {
  std::vector<double> z;
  std::vector<std::vector<double>> by_parameter;  // dz/dp, a column for each parameter
  // dz by the state at the start of the run: 1 there, 0 once it has forgotten.
  std::vector<double> start_influence;
};
StateSensitivities state_sensitivities(const StateDeclaration& state, const MotionRows& rows);

}  // namespace tribench
