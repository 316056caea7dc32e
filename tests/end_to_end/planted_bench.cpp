// SPDX-License-Identifier: MIT
//
// A loop with a known amount of work: of a hundred turns one more where PLANTED_EXTRA is set.
#include <benchmark/benchmark.h>

#include <cstdint>

namespace {

#ifndef PLANTED_EXTRA
#define PLANTED_EXTRA 0
#endif

void inner_loop(benchmark::State& state) {
  std::uint64_t sum = 1;
  for (auto _ : state) {
    for (int i = 0; i < 100'000 + 1'000 * PLANTED_EXTRA; ++i) {
      sum = sum * 6364136223846793005ULL + 1442695040888963407ULL;
      benchmark::DoNotOptimize(sum);
    }
  }
}
BENCHMARK(inner_loop);

}  // namespace
