// SPDX-License-Identifier: MIT
//
// Constants by Levenberg-Marquardt, and Jacobians in Operon's metric: nodes (leaves included) x
// rows / second over 1 000 random balanced trees of up to 64 nodes, set-up included.
#include <benchmark/benchmark.h>

#include <cmath>

#include "algorithms/expression/differentiate.hpp"
#include "algorithms/expression/text.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "foundation/random.hpp"

namespace tribench {
namespace {

// The paper's ParFam formula (joint 2) fitted from random starts to 90 rows of itself with noise.
void fit_parfam_formula(benchmark::State& state) {
  const std::vector<std::string> names = {"v", "s"};
  const Expression truth =
      parse("(3.66*v + 8.52*s - 0.44)*exp(-0.78*v^2 + 1.26*v*s + 0.02*v)", names);
  std::vector<double> v(90);
  std::vector<double> s(90);
  std::vector<double> y(90);
  for (int i = 0; i < 90; ++i) {
    s[i] = i < 45 ? -1 : 1;
    v[i] = s[i] * (0.015 + 0.665 * (i % 45) / 44.0);
  }
  const std::vector<const double*> columns = {v.data(), s.data()};
  const Inputs inputs{columns, 90};
  Evaluator().evaluate(truth, inputs, y);
  RandomStream random(1);
  for (double& value : y) value += 0.05 * random.normal();
  ConstantFitter fitter;
  std::int64_t starts = 0;
  std::int64_t iterations = 0;
  std::int64_t reached = 0;
  for (auto _ : state) {
    Expression formula = truth;
    for (std::size_t place : truth.constant_positions()) {
      if (truth.node(place).value != 2) formula.set_constant(place, random.normal());
    }
    const ConstantFitResult result = fitter.fit(formula, inputs, y, {}, {.max_iterations = 100});
    starts += 1;
    iterations += result.iterations;
    if (result.sum_squares < 90 * 0.05 * 0.05 * 1.5) reached += 1;
  }
  if (starts > 100 && reached < starts / 2) state.SkipWithError("too few starts reach the truth");
  state.counters["iterations_per_start"] =
      static_cast<double>(iterations) / static_cast<double>(starts);
  state.counters["reached"] = static_cast<double>(reached) / static_cast<double>(starts);
}
BENCHMARK(fit_parfam_formula)->Unit(benchmark::kMicrosecond);

// Balanced: the larger half of the remaining length goes to either side alike.
void grow(RandomStream& random, std::size_t length, std::span<const Op> operators,
          std::vector<Node>& tape) {
  if (length <= 1) {
    tape.push_back(random.chance(0.5) ? Node::constant(random.uniform(0.5, 2))
                                      : Node::input(random.below(9)));
    return;
  }
  const Op op = operators[random.below(operators.size())];
  if (arity(op) == 1 || length == 2) {
    const Op unary = arity(op) == 1 ? op : Op::neg;
    grow(random, length - 1, operators, tape);
    tape.push_back({0, 0, 0, unary});
    return;
  }
  const std::size_t left = (length - 1) / 2;
  grow(random, left, operators, tape);
  grow(random, length - 1 - left, operators, tape);
  tape.push_back({0, 0, 0, op});
}

void jacobian_of_random_trees(benchmark::State& state) {
  const auto rows = static_cast<std::size_t>(state.range(0));
  std::vector<Op> operators = {Op::add, Op::sub, Op::mul, Op::div};
  if (state.range(1) != 0) operators.insert(operators.end(), {Op::exp, Op::sqrt, Op::log, Op::sin});
  RandomStream random(5);
  std::vector<std::vector<double>> data(9, std::vector<double>(rows));
  std::vector<const double*> columns;
  for (auto& column : data) {
    for (double& value : column) value = random.uniform(-1, 1);
    columns.push_back(column.data());
  }
  const Inputs inputs{columns, rows};
  std::vector<Expression> formulas;
  std::vector<std::vector<std::size_t>> places;
  std::uint64_t nodes = 0;
  for (int i = 0; i < 1000; ++i) {
    std::vector<Node> tape;
    grow(random, 1 + random.below(64), operators, tape);
    formulas.emplace_back(tape);
    places.push_back(formulas.back().constant_positions());
    nodes += formulas.back().size();
  }
  Differentiator differentiator;
  std::vector<double> values(rows);
  std::vector<double> jacobian(rows * 64);
  for (auto _ : state) {
    for (std::size_t i = 0; i < formulas.size(); ++i) {
      differentiator.prepare(formulas[i], places[i]);
      differentiator.jacobian(inputs, values, jacobian);
      benchmark::DoNotOptimize(jacobian.data());
    }
  }
  // The last formula against its own values: a wrong fast path must fail.
  std::vector<double> expected(rows);
  Evaluator().evaluate(formulas.back(), inputs, expected);
  for (std::size_t r = 0; r < rows; ++r) {
    const bool same = std::isfinite(expected[r])
                          ? std::abs(values[r] - expected[r]) <= 1e-12 * std::abs(expected[r])
                          : !std::isfinite(values[r]);
    if (!same) state.SkipWithError("values differ from the evaluator's");
  }
  state.counters["node_rows/s"] = benchmark::Counter(
      static_cast<double>(nodes * rows) * static_cast<double>(state.iterations()),
      benchmark::Counter::kIsRate);
}
BENCHMARK(jacobian_of_random_trees)
    ->ArgNames({"rows", "functions"})
    ->ArgsProduct({{200, 1000, 5000}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tribench
