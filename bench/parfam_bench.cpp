// SPDX-License-Identifier: MIT
//
// ParFam's hot paths: loss and gradient of the largest structure of the published small grid, one
// evaluation of our projected problem, and whole fits of the peer problem friction1d's size.
#include <benchmark/benchmark.h>

#include <cmath>

#include "algorithms/parfam/projection.hpp"
#include "algorithms/parfam/published_model.hpp"
#include "foundation/random.hpp"

namespace tribench::parfam {
namespace {

struct Sample {
  std::vector<std::vector<double>> data;
  std::vector<const double*> columns;
  std::vector<double> y;
  Sample(std::size_t inputs, std::size_t rows) : data(inputs, std::vector<double>(rows)), y(rows) {
    RandomStream random(3);
    for (auto& column : data) {
      for (double& value : column) value = random.uniform(-1, 1);
      columns.push_back(column.data());
    }
    for (double& value : y) value = random.normal();
  }
};

// 46 parameters, 500 rows: degrees 2/1 in and out of four inputs, one exp.
void published_loss_and_gradient(benchmark::State& state) {
  const Sample sample(4, 500);
  const std::vector<int> caps(4, kMaximalPotence);
  PublishedModel model(make_structure({2, 1, 2, 1, {Op::exp}, false}, caps), sample.columns, 500);
  RandomStream random(5);
  std::vector<double> theta(model.parameters());
  for (double& value : theta) value = random.normal();
  std::vector<double> gradient(theta.size());
  double loss = 0;
  for (auto _ : state) {
    loss = model.loss(theta, sample.y, 1e-3, gradient);
    benchmark::DoNotOptimize(gradient.data());
  }
  // Against finite differences of the same model without its rounding to single precision.
  PublishedModel exact(make_structure({2, 1, 2, 1, {Op::exp}, false}, caps), sample.columns, 500,
                       {.single_precision_hidden = false});
  loss = exact.loss(theta, sample.y, 1e-3, gradient);
  const double h = 1e-7;
  theta[30] += h;
  const double slope = (exact.loss(theta, sample.y, 1e-3, {}) - loss) / h;
  if (model.parameters() != 46 || std::abs(slope - gradient[30]) > 1e-3 * (1 + std::abs(slope))) {
    state.SkipWithError("the gradient is not that of the loss");
  }
  state.counters["evaluations/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(published_loss_and_gradient)->Unit(benchmark::kMicrosecond);

// Value and projected sums, what one step of our search costs.
void projected_step(benchmark::State& state) {
  const auto inputs = static_cast<std::size_t>(state.range(0));
  const auto rows = static_cast<std::size_t>(state.range(1));
  const Sample sample(inputs, rows);
  const std::vector<int> caps(inputs, kMaximalPotence);
  Budget budget{BudgetLimits{}};
  Projection projection(make_structure({2, 0, 2, 0, {Op::exp}, false}, caps), sample.columns,
                        sample.y, Denominators::safe, budget);
  RandomStream random(5);
  std::vector<double> inner(projection.inner_parameters());
  for (double& value : inner) value = 0.5 * random.normal();
  NormalEquations sums;
  double value = 0;
  for (auto _ : state) {
    value = projection.sum_squares(inner);
    projection.normal_equations(sums);
    benchmark::DoNotOptimize(sums.gradient.data());
  }
  if (!(value > 0) || std::abs(sums.sum_squares - value) > 1e-9 * value) {
    state.SkipWithError("the sums do not belong to the value");
  }
}
BENCHMARK(projected_step)
    ->ArgNames({"inputs", "rows"})
    ->Args({2, 200})
    ->Args({2, 500})
    ->Args({4, 500})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace tribench::parfam
