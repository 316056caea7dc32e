// SPDX-License-Identifier: MIT
//
// One whole diagnosis of 5 760 rows with the built-in library and 1 999 flips on one core: where
// nothing is missing, and where one effect is. Target: below 50 ms. And what long recordings spend
// their time on: the Gram matrix of 14 000 rows, beside Eigen's own in the same run.
#include <benchmark/benchmark.h>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "algorithms/inference/column_products.hpp"
#include "foundation/random.hpp"
#include "problems/kuka/planted.hpp"
#include "problems/preparation/test_movements.hpp"

namespace tribench {
namespace {

void diagnose_planted(benchmark::State& state, const kuka::PlantedCase& planted,
                      loop::Verdict expected) {
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

BENCHMARK(BM_GramMatrix)->Arg(4)->Arg(12)->Arg(60)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_GramMatrixOfEigen)->Arg(4)->Arg(12)->Arg(60)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_DiagnoseNothingMissing)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_DiagnoseOneEffect)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tribench
