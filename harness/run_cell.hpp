// SPDX-License-Identifier: MIT
//
// Runs one cell in this process: makes the problem, drives the method through the problem's
// stages, has the judge compute the figures. What a worker process does with each task, and what
// `tribench fit` does with the user's own data.
#pragma once

#include <functional>
#include <list>
#include <memory>
#include <string>
#include <utility>

#include "algorithms/registry.hpp"
#include "algorithms/regressor.hpp"
#include "harness/cell_task.hpp"
#include "harness/yardsticks.hpp"
#include "problems/problem.hpp"

namespace tribench {

// The method as it searches in a round after the first (restarts.hpp); empty: as it is.
using WidenedMethod = std::function<std::unique_ptr<Regressor>(int round)>;

// Fits every stage of the problem, each to what the stages before have left, and judges the sum.
// Errors of the method become a failed record; std::bad_alloc is passed on. The record's yardsticks
// are left to whoever knows them.
CellResult fit_and_judge(const Problem& problem, const Regressor& method, const CellTask& task,
                         const WidenedMethod& widened = {});

// Of this process, or of a program that it ran where one took more, since fit_and_judge last began;
// NaN where the kernel does not say.
double peak_memory_mib();

// Keeps the last problems made: cells that follow each other often share one, and making it (20 ms
// for A without load) can cost more than a baseline's fit.
class CellRunner {
 public:
  explicit CellRunner(const Registry& registry) : registry_(registry) {}

  // `on_problem` hears the record with what is known before the fit starts, so that a cell that
  // crashes can still be named in full.
  CellResult run(const CellTask& task, const std::function<void(const Record&)>& on_problem);

 private:
  struct Measured {
    Problem problem;
    Yardsticks yardsticks;
  };
  const Measured& problem(const CellTask& task);

  const Registry& registry_;
  std::list<std::pair<std::string, Measured>> problems_;  // by key; the one used last stands first
};

}  // namespace tribench
