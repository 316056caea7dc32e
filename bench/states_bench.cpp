// SPDX-License-Identifier: MIT
//
// A state along 14 000 rows: nanoseconds a row, by law; with sensitivities; a single step.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "algorithms/states/state_column.hpp"

namespace tribench {
namespace {

constexpr std::size_t kRows = 14000;

struct Motion {
  std::vector<double> time;
  std::vector<double> velocity;
  std::vector<double> load;
  std::vector<std::size_t> starts = {0};
  std::vector<const double*> columns;

  Motion() {
    for (std::size_t r = 0; r < kRows; ++r) {
      time.push_back(0.002 * static_cast<double>(r));
      velocity.push_back(0.1 * std::sin(3 * time.back()));
      load.push_back(std::cos(time.back()));
    }
    columns = {velocity.data(), load.data()};
  }
  MotionRows rows() const { return {columns, time, starts}; }
};

StateDeclaration state_of(std::int64_t law) {
  static const std::vector<StateDeclaration> kStates = {
      {"z", StateLaw::lag, {0}, {0.02}},
      {"z", StateLaw::dahl, {0}, {3e-4}},
      {"z", StateLaw::lugre, {0}, {2e-4, 3e-4, 0.01}},
      {"z", StateLaw::slip, {0}, {4e-4}},
      {"z", StateLaw::gms, {0}, {2e-4, 3e-4, 0.01, 0.02}},
      {"z", StateLaw::backlash, {0, 1}, {1e-3, 0.003}},
      {"z", StateLaw::warmth, {0, 1}, {1.5}}};
  return kStates.at(static_cast<std::size_t>(law));
}

void report(benchmark::State& state, std::int64_t law) {
  state.SetLabel(state_law_info(static_cast<StateLaw>(law)).name);
  state.counters["ns_per_row"] = benchmark::Counter(
      static_cast<double>(kRows) * static_cast<double>(state.iterations()) * 1e-9,
      benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void column(benchmark::State& state) {
  const Motion motion;
  const StateDeclaration declared = state_of(state.range(0));
  std::vector<double> out(kRows);
  for (auto _ : state) {
    state_column(declared, motion.rows(), out);
    benchmark::DoNotOptimize(out.data());
  }
  report(state, state.range(0));
}
BENCHMARK(column)->DenseRange(0, 6);

void sensitivities(benchmark::State& state) {
  const Motion motion;
  const StateDeclaration declared = state_of(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(state_sensitivities(declared, motion.rows()));
  report(state, state.range(0));
}
BENCHMARK(sensitivities)->DenseRange(0, 6);

void single_step(benchmark::State& state) {
  const StateDeclaration declared = state_of(state.range(0));
  StateMemory memory;
  const StateDrive from{0.05, 1};
  const StateDrive to{0.051, 1};
  for (auto _ : state) {
    advance(declared.law, std::span<const double>(declared.parameters), memory, from, to, 1e-3);
    benchmark::DoNotOptimize(memory);
  }
  state.SetLabel(state_law_info(declared.law).name);
}
BENCHMARK(single_step)->DenseRange(0, 6);

}  // namespace
}  // namespace tribench
