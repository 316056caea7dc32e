// SPDX-License-Identifier: MIT
//
// Methods that behave and methods that do not, for tests of the harness. They are part of a program
// of the tests' own (tribench_test_program) and of nothing that is installed.
//
//   test_mean        the mean of the target
//   test_search      draws lines over the first input until its budget is spent; the best wins
//   test_sleep       test_mean after `seconds` without using the processor
//   test_spin        test_mean after `seconds` of CPU
//   test_crash       writes to address 0
//   test_abort       ends by an exception that nobody catches, in a thread of its own
//   test_hang        never returns, without using the processor
//   test_busy_hang   never returns and uses all it gets
//   test_eat_memory  takes memory until there is none
//   test_exit        leaves the process with status 7
//   test_throw       throws an error
//   test_nothing     returns no formula
//   test_pole        a formula with a pole between the data
//   test_fill_disk   writes a file until the disk (or its limit) is full, then fails
//   test_flaky       crashes in some cells when it is not the worker's first one
#pragma once

#include "algorithms/registry.hpp"

namespace tribench {

void add_test_methods(Registry& registry);

}  // namespace tribench
