// SPDX-License-Identifier: MIT
//
// What it takes to run one cell, and what comes of it: the two messages between the run and its
// worker processes. Both go as one line of JSON; doubles come back bit for bit.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/cell.hpp"
#include "harness/grid.hpp"
#include "reports/record/record.hpp"

namespace tribench {

struct CellTask {
  Cell cell;
  Method method;
  OperatorSet operators;
  CellLimits limits;
  int threads = 1;
  std::string data;  // folder of the measured sets; empty where there is none
  Prior prior = {};
  std::optional<user::UserProblem> own = {};  // what cell.problem is, where the grid brings it
  const std::atomic<bool>* stop = nullptr;  // as BudgetLimits has it; of this process, not written
};

struct CellResult {
  Record record;
  std::vector<FrontRecord> front;
  std::vector<TraceRecord> trace;
  bool keeps_form = false;  // as FitResult has it; of this process, not written
};

CellTask make_task(const Grid& grid, const Cell& cell, const std::string& data);

std::string print_task(const CellTask& task);
CellTask parse_task(std::string_view json);  // throws Error (failed) where it is malformed
std::string print_result(const CellResult& result);
CellResult parse_result(std::string_view json);  // throws Error (failed) where it is malformed

// A record that carries the cell's names and nothing else yet.
Record empty_record(const Cell& cell);

}  // namespace tribench
