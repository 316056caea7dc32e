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

#include <malloc.h>

#include <cstdint>
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

// What is asked for here is kept for good. Volatile: it is asked for though nobody reads it.
std::uintptr_t keep(std::size_t bytes) {
  void* volatile piece = std::malloc(bytes);
  return reinterpret_cast<std::uintptr_t>(piece);
}

// The C library's free pieces: those that it tells, and up to seven of each small size that it
// keeps for a thread and counts as used.
void take_free_pieces() {
  const auto told = [] {
    const auto heap = mallinfo2();
    return heap.fordblks - heap.keepcost;
  };
  const auto take_small = [] {
    for (std::size_t bytes = 24; bytes <= 1032; bytes += 16) {
      for (int k = 0; k < 7; ++k) keep(bytes);
    }
  };
  const auto take_told = [&](std::size_t bytes) {
    for (std::size_t before = told() + 1; told() < before; keep(bytes)) before = told();
  };
  for (std::size_t before = told() + 1; told() < before;) {
    before = told();
    take_small();
    for (std::size_t bytes = 65536; bytes > 24; bytes /= 2) take_told(bytes);
    take_told(24);
  }
  take_small();
}

// Google Benchmark reads the machine (processors, caches, host name, load) and prints it before the
// first loop; what that leaves free on the heap would decide where a case's data lie and how long
// an allocation takes. So each case begins with nothing free and the heap's end at a round address.
void settle_heap(const benchmark::State& /*state*/) {
  static std::uintptr_t round = 1U << 20;  // the first time more than the machine can have taken
  take_free_pieces();
  for (std::uintptr_t at = keep(24); at % round != 0; at = keep(24)) {
    if (at % 32 != 0) keep(40);  // pieces are 16 bytes and a multiple of 16 apart
  }
  malloc_trim(0);  // where the system's share ends decides when it is asked for more
  round = 1U << 16;
}

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
benchmark::internal::Benchmark*
__real__ZN9benchmark8internal25RegisterBenchmarkInternalEPNS0_9BenchmarkE(
    benchmark::internal::Benchmark* bench);

benchmark::internal::Benchmark*
__wrap__ZN9benchmark8internal25RegisterBenchmarkInternalEPNS0_9BenchmarkE(
    benchmark::internal::Benchmark* bench) {
  if (tribench::is_counted()) bench->Setup(tribench::settle_heap);
  return __real__ZN9benchmark8internal25RegisterBenchmarkInternalEPNS0_9BenchmarkE(bench);
}

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
