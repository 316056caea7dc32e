// SPDX-License-Identifier: MIT
//
// How fast a log becomes numbers: bytes a second of a table like a robot's.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <string>

#include "problems/reading/csv.hpp"

namespace tribench {
namespace {

std::string log_of(int rows) {
  std::string text = "stamp,q_deg,dq [deg/s],i_mA,T_degC\n";
  for (int i = 0; i < rows; ++i) {
    text += fmt::format("{},{:.5f},{:.4f},{:.1f},{:.2f}\n",
                        1'700'000'000'000'000'000 + i * 1'000'000LL, 57 * std::sin(0.001 * i),
                        57 * std::cos(0.001 * i), 1500 * std::cos(0.003 * i), 30 + 1e-5 * i);
  }
  return text;
}

void read_log(benchmark::State& state) {
  const std::string text = log_of(200'000);
  for (auto _ : state) benchmark::DoNotOptimize(parse_csv(text, "log.csv").data.rows());
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * text.size()));
}
BENCHMARK(read_log)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tribench

BENCHMARK_MAIN();
