// SPDX-License-Identifier: MIT
//
// Which cells a run takes, in which order, and what they are expected to cost. Not for running
// them: neither order nor cost changes a result.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "harness/grid.hpp"
#include "reports/run_folder.hpp"

namespace tribench {

// The part of a grid that one machine takes: `index` of `count`, from 1.
struct Shard {
  std::size_t index = 1;
  std::size_t count = 1;
  bool is_whole() const { return count == 1; }
  bool operator==(const Shard&) const = default;
};

// "3/8". Throws Error (bad_input).
Shard parse_shard(std::string_view text);

// Seconds a cell of each method took before (the median), by the method's name; may be empty.
using MeasuredCosts = std::map<std::string, double, std::less<>>;
// Of a run that has ended: its fits' seconds and what judging takes.
MeasuredCosts measured_costs(const RunFolder& run);

struct PlannedWork {
  Cell cell;
  double predicted_s = 0;
};

// CPU seconds the cell is expected to take: measured ones where there are any, else the most that
// its budget allows, at a cautious rate of evaluation. Many methods end long before that.
double predict_seconds(const Grid& grid, const Cell& cell, const MeasuredCosts& costs = {});

// The shard's cells, the most expensive first, so that the last to end are short. Cells are dealt
// to the shards in that order, one each in turn: every shard gets about the same work, and which
// cell goes where depends on the grid alone.
void for_each_planned(const Grid& grid, const Shard& shard, const MeasuredCosts& costs,
                      const std::function<void(const PlannedWork&)>& take);
// The same as a list, which takes six times as much memory.
std::vector<PlannedWork> plan_work(const Grid& grid, const Shard& shard = {},
                                   const MeasuredCosts& costs = {});

}  // namespace tribench
