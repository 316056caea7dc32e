// SPDX-License-Identifier: MIT
//
// uDSR's hot paths: drawing formulas from the policy, the gradient of its loss, scoring a batch
// with the linear token, and a whole step with the share of each part. Items are sequences.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "algorithms/udsr/genetic.hpp"
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

// 8 s + 14 v - 4 s v^4 over v in (-1, 1).
struct Curve {
  std::vector<double> v, s, y;
  std::vector<const double*> columns;
  std::vector<Input> inputs = {{"v", "rad/s", Role::velocity, -1, 1, std::nullopt},
                               {"sgn_v", "-", Role::velocity_sign, -1, 1, 0}};

  explicit Curve(std::size_t rows) : v(rows), s(rows), y(rows) {
    for (std::size_t i = 0; i < rows; ++i) {
      v[i] = -1 + 2 * (static_cast<double>(i) + 0.5) / static_cast<double>(rows);
      s[i] = v[i] > 0 ? 1 : -1;
      y[i] = 8 * s[i] + 14 * v[i] - 4 * s[i] * std::pow(v[i], 4);
    }
    columns = {v.data(), s.data()};
  }
};

void BM_Score(benchmark::State& state) {
  const Setting setting;
  const Curve curve(static_cast<std::size_t>(state.range(0)));
  const ScoringProblem problem({curve.inputs, curve.columns, curve.y, {}}, setting.library, 3);
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

// One step of training as the method runs it, and what each part takes of it. Genetic programming
// is timed a second time with every formula known: that is its own work, without evaluation.
void BM_Step(benchmark::State& state) {
  using Clock = std::chrono::steady_clock;
  const Setting setting;
  const Curve curve(static_cast<std::size_t>(state.range(0)));
  const ScoringProblem problem({curve.inputs, curve.columns, curve.y, {}}, setting.library, 3);
  double policy_s = 0;
  double evaluation_s = 0;
  double genetic_s = 0;
  const auto seconds_of = [](const auto& work) {
    const Clock::time_point start = Clock::now();
    work();
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  std::uint64_t step = 0;
  for (auto _ : state) {
    const RandomStream random = RandomStream(4).split(step++);
    Budget budget({});
    Scoreboard scoreboard(problem, budget, nullptr, 1);
    std::vector<Sequence> batch;
    std::vector<double> rewards;
    std::vector<Elite> elites;
    policy_s += seconds_of([&] { batch = setting.policy.sample(500, setting.prior, random); });
    evaluation_s += seconds_of([&] { rewards = scoreboard.rewards(batch); });
    const auto evolve_once = [&] {
      elites = evolve(batch, rewards, setting.prior, {}, setting.library, random, scoreboard);
    };
    const double with_evaluation = seconds_of(evolve_once);
    const double without = seconds_of(evolve_once);
    genetic_s += without;
    evaluation_s += std::max(0.0, with_evaluation - without);
    std::vector<WeightedSequence> kept;
    for (std::size_t i = 0; i < 25 && i < elites.size(); ++i) {
      kept.push_back({&elites[i].sequence, 0.01, 0.001});
    }
    Eigen::VectorXd gradient;
    policy_s += seconds_of([&] { setting.policy.loss(kept, setting.prior, 0.7, gradient); });
    if (elites.empty() || !(scoreboard.best_reward() > 0.9)) {
      state.SkipWithError("no sequence explains the curve");
      break;
    }
  }
  const double total = policy_s + evaluation_s + genetic_s;
  state.counters["policy_share"] = policy_s / total;
  state.counters["evaluation_share"] = evaluation_s / total;
  state.counters["genetic_share"] = genetic_s / total;
}
BENCHMARK(BM_Step)->Arg(90)->Arg(4000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tribench::udsr
