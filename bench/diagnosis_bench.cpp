// SPDX-License-Identifier: MIT
//
// One whole diagnosis of 5 760 rows with the built-in library and 1 999 flips on one core: where
// nothing is missing, and where one effect is. Target: below 50 ms. And what long recordings spend
// their time on: the Gram matrix of 14 000 rows, beside Eigen's own in the same run, and the scan
// for waves of any length over as many, in noise and with a wave (all flips are then looked at).
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "algorithms/inference/column_products.hpp"
#include "algorithms/inference/wave_scan.hpp"
#include "foundation/freed_memory.hpp"
#include "foundation/random.hpp"
#include "problems/kuka/planted.hpp"
#include "problems/preparation/test_movements.hpp"

namespace tribench {
namespace {

void diagnose_planted(benchmark::State& state, const kuka::PlantedCase& planted,
                      loop::Verdict expected) {
  keep_freed_memory();  // as the program does when it starts
  const loop::Observations data = loop::observe(kuka::make_planted(planted, 1).data);
  loop::DiagnosisOptions options;
  options.physical_vetoes = false;
  options.gear_ratios = {160};
  const std::vector<int> test = loop::choose_test_movements(data, 0.2);
  for (auto _ : state) {
    const loop::Diagnosis diagnosis =
        loop::diagnose(data, loop::coulomb_viscous_base, options, test);
    if (diagnosis.verdict != expected) {
      state.SkipWithError("the verdict is wrong");
      return;
    }
    benchmark::DoNotOptimize(diagnosis.leftover.p);
  }
  state.counters["rows"] = static_cast<double>(data.rows());
}

void BM_DiagnoseNothingMissing(benchmark::State& state) {
  diagnose_planted(state, {}, loop::Verdict::none);
}

void BM_DiagnoseOneEffect(benchmark::State& state) {
  diagnose_planted(state, {.effects = {{"load_coulomb", 1.0}}}, loop::Verdict::effects);
}

Eigen::MatrixXd long_columns(const benchmark::State& state) {
  Eigen::MatrixXd x(14'000, state.range(0));
  RandomStream random(1);
  for (double& value : x.reshaped()) value = random.normal();
  return x;
}

void BM_GramMatrix(benchmark::State& state) {
  const Eigen::MatrixXd x = long_columns(state);
  for (auto _ : state) benchmark::DoNotOptimize(loop::gram_of(x).trace());
}

void BM_GramMatrixOfEigen(benchmark::State& state) {
  const Eigen::MatrixXd x = long_columns(state);
  for (auto _ : state) {
    const Eigen::MatrixXd gram = x.transpose() * x;
    benchmark::DoNotOptimize(gram.trace());
  }
}

// A hundred movements over two rad; the argument: a wave as large as the noise, or none.
void BM_StrongestWave(benchmark::State& state) {
  constexpr int kMovements = 100;
  constexpr int kRowsEach = 140;
  std::vector<int> movement;
  std::vector<double> position;
  Eigen::VectorXf direction(kMovements * kRowsEach);
  Eigen::VectorXd scores(kMovements * kRowsEach);
  RandomStream random(1);
  for (int row = 0; row < kMovements * kRowsEach; ++row) {
    movement.push_back(row / kRowsEach);
    position.push_back(random.uniform(-1, 1));
    direction[row] = row / kRowsEach % 2 == 0 ? 1 : -1;
    const double wave = std::cos(88.2 * position.back());
    scores[row] = random.normal() + static_cast<double>(state.range(0)) * wave;
  }
  const loop::Clusters clusters = loop::make_clusters(movement, 1);
  const loop::WaveRange range = loop::waves_over(position, 2, 0.01).value();
  for (auto _ : state) {
    benchmark::DoNotOptimize(loop::strongest_wave(position, scores, direction, clusters, range,
                                                  1999, 0.002, RandomStream(2))
                                 .p);
  }
}

BENCHMARK(BM_StrongestWave)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_GramMatrix)->Arg(4)->Arg(12)->Arg(60)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_GramMatrixOfEigen)->Arg(4)->Arg(12)->Arg(60)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_DiagnoseNothingMissing)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_DiagnoseOneEffect)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tribench
