// SPDX-License-Identifier: MIT
#include "bench/measured_loop.hpp"

#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#else  // cannot be counted, runs all the same
#define RUNNING_ON_VALGRIND 0
#define CALLGRIND_START_INSTRUMENTATION
#define CALLGRIND_STOP_INSTRUMENTATION
#define CALLGRIND_DUMP_STATS
#endif

#include <cstdlib>

#include "foundation/calibration.hpp"

namespace tribench {
namespace {

bool is_counted() {
  static const bool kIs = RUNNING_ON_VALGRIND != 0;
  return kIs;
}

// Of the loop that runs in this thread; microseconds.
thread_local double reference_before_us = 0;

double reference_us() { return 1e6 * calibrate().cpu_s; }

}  // namespace

bool is_left_out_at_night(benchmark::State& state) {
  const bool is = std::getenv("TRIBENCH_NIGHT") != nullptr;
  if (is) state.SkipWithError("left out at night");
  return is;
}

}  // namespace tribench

// Names that the linker makes of the mangled ones; `this` is an ordinary first argument.
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming)
extern "C" {
void __real__ZN9benchmark5State16StartKeepRunningEv(benchmark::State* state);
void __real__ZN9benchmark5State17FinishKeepRunningEv(benchmark::State* state);

void __wrap__ZN9benchmark5State16StartKeepRunningEv(benchmark::State* state) {
  if (!tribench::is_counted()) tribench::reference_before_us = tribench::reference_us();
  __real__ZN9benchmark5State16StartKeepRunningEv(state);
  CALLGRIND_START_INSTRUMENTATION;
}

void __wrap__ZN9benchmark5State17FinishKeepRunningEv(benchmark::State* state) {
  CALLGRIND_STOP_INSTRUMENTATION;
  __real__ZN9benchmark5State17FinishKeepRunningEv(state);
  if (tribench::is_counted()) {
    static int dumps = 0;
    CALLGRIND_DUMP_STATS;
    state->counters["counted"] = ++dumps;
    return;
  }
  state->counters["reference_us"] =
      benchmark::Counter(0.5 * (tribench::reference_before_us + tribench::reference_us()),
                         benchmark::Counter::kAvgThreads);
}
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
