// SPDX-License-Identifier: MIT
//
// What every bench has in common: its cases' loops are what is measured, and nothing besides.
//
// Under valgrind (callgrind with --instr-atstart=no) instructions and cache misses are counted from
// a loop's first turn to its last and dumped case by case; the case's counter "counted" is the
// number of its dump. Otherwise a fixed piece of arithmetic (foundation/calibration.hpp) is timed
// right before and after each loop, in the same thread: its counter "reference_us" takes the
// machine's pace out of the case's time.
//
// What is counted hangs on the program alone: before each case all that is free on the heap is
// taken and its end is moved to a round address, because Google Benchmark has read and printed the
// machine (number of processors, host name) by then and left other pieces on every machine.
//
// measured_loop.cpp does it by wrapping the functions that register a case and that begin and end
// its loop when the bench is linked (ld --wrap).
#pragma once

#include <benchmark/benchmark.h>

namespace tribench {

// For a case that a night leaves out: it starts threads, whose order decides what is counted, or
// takes minutes. True in a night (the variable TRIBENCH_NIGHT is set), and then it is skipped.
bool is_left_out_at_night(benchmark::State& state);

}  // namespace tribench
