// SPDX-License-Identifier: MIT
//
// The micro-benchmarks of a night: every program of a folder is counted under valgrind and timed
// against its reference kernel (bench/measured_loop.hpp).
//
// Counting: callgrind with cache simulation, the loops' first to last turn, one turn each, so that
// no clock decides how much is done. The vector level is pinned to one that valgrind knows
// (it has no AVX-512), the caches are pinned, too, the environment is emptied and the program is
// called by its bare name: what lies on the stack moves addresses, and addresses decide misses.
// Functions of libraries are looked up before the first loop, not in the first that calls them, and
// each case begins with a settled heap (bench/measured_loop.hpp), so that the number of processors,
// a machine's name and where the benches lie change nothing.
//
// Timing: Google Benchmark, several repetitions, each case's CPU time divided by that of the
// reference kernel run before and after it in the same thread.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "reports/night.hpp"

namespace tribench {

struct BenchOptions {
  std::filesystem::path folder;  // with the programs; what lies in folders below it is left alone
  int repetitions = 5;           // of each case's timing
  double least_time_s = 0.02;    // of a repetition
  double patience_s = 1800;      // for one program, counted or timed
};

struct BenchRun {
  std::vector<NightBench> benches;  // by program and case
  std::string conditions;           // valgrind, level, caches, heap, C library; or "not counted"
  std::vector<std::string> complaints;
};

// Throws Error (bad_input) where the folder has no program: to be asked before hours are spent.
void require_benches(const std::filesystem::path& folder);

// As require_benches. A program that fails is a complaint, and its
// cases are missing. Cost: some fifty times a turn of every case.
BenchRun run_benches(const BenchOptions& options, const std::atomic<bool>& stop);

}  // namespace tribench
