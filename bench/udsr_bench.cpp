// SPDX-License-Identifier: MIT
//
// uDSR's hot paths: drawing formulas from the policy, the gradient of its loss, scoring a batch
// with the linear token. Items are sequences.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "algorithms/udsr/policy.hpp"
#include "algorithms/udsr/population.hpp"

namespace tribench::udsr {
namespace {

struct Setting {
  TokenLibrary library{find_operator_set("paper"), 2, {.constants = true, .linear = true}};
  Prior prior{library, {}, {{-1, -1}, -1, 1}};
  Policy policy{library, RandomStream(1)};
};

void BM_Sample(benchmark::State& state) {
  const Setting setting;
  const auto batch = static_cast<std::size_t>(state.range(0));
  std::uint64_t step = 0;
  for (auto _ : state) {
    const std::vector<Sequence> sequences =
        setting.policy.sample(batch, setting.prior, RandomStream(2).split(step++));
    if (sequences.size() != batch || !setting.prior.allows(sequences.back())) {
      state.SkipWithError("a sampled sequence breaks the constraints");
      break;
    }
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(BM_Sample)->Arg(500)->Arg(1000)->Unit(benchmark::kMillisecond);

void BM_Gradient(benchmark::State& state) {
  const Setting setting;
  const auto batch = static_cast<std::size_t>(state.range(0));
  const std::vector<Sequence> sequences =
      setting.policy.sample(batch, setting.prior, RandomStream(2));
  std::vector<WeightedSequence> weighted;
  for (const Sequence& sequence : sequences) weighted.push_back({&sequence, 0.1, 0.01});
  Eigen::VectorXd gradient;
  for (auto _ : state) {
    if (!std::isfinite(setting.policy.loss(weighted, setting.prior, 0.7, gradient))) {
      state.SkipWithError("the loss is not finite");
      break;
    }
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(BM_Gradient)->Arg(25)->Arg(500)->Unit(benchmark::kMillisecond);

void BM_Score(benchmark::State& state) {
  const Setting setting;
  const auto rows = static_cast<std::size_t>(state.range(0));
  std::vector<double> v(rows);
  std::vector<double> s(rows);
  std::vector<double> y(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    v[i] = -1 + 2 * (static_cast<double>(i) + 0.5) / static_cast<double>(rows);
    s[i] = v[i] > 0 ? 1 : -1;
    y[i] = 8 * s[i] + 14 * v[i] - 4 * s[i] * std::pow(v[i], 4);
  }
  const std::vector<const double*> columns = {v.data(), s.data()};
  const std::vector<Input> inputs = {{"v", "rad/s", Role::velocity, -1, 1, std::nullopt},
                                     {"sgn_v", "-", Role::velocity_sign, -1, 1, 0}};
  const ScoringProblem problem({inputs, columns, y, {}}, setting.library, 3);
  const std::vector<Sequence> sequences =
      setting.policy.sample(500, setting.prior, RandomStream(3));
  for (auto _ : state) {
    Scorer scorer(problem);
    double best = 0;
    for (const Sequence& sequence : sequences) best = std::max(best, scorer.score(sequence).reward);
    if (!(best > 0.9)) {
      state.SkipWithError("no sequence explains the curve");
      break;
    }
  }
  state.SetItemsProcessed(state.iterations() * 500);
}
BENCHMARK(BM_Score)->Arg(90)->Arg(4000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tribench::udsr
