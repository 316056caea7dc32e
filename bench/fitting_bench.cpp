// SPDX-License-Identifier: MIT
//
// Constants by Levenberg-Marquardt, and Jacobians in Operon's metric: nodes (leaves included) x
// rows / second over 1 000 random balanced trees of up to 64 nodes, set-up included.
#include <benchmark/benchmark.h>

#include <cmath>
#include <stdexcept>

#include "algorithms/expression/compile.hpp"
#include "algorithms/expression/differentiate.hpp"
#include "algorithms/expression/text.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "algorithms/fitting/ipopt_minimizer.hpp"
#include "algorithms/fitting/nlopt_minimizer.hpp"
#include "foundation/random.hpp"

namespace tribench {
namespace {

// The paper's ParFam formula (joint 2) with 90 rows of itself and noise, to be fitted from random
// starts: Levenberg-Marquardt, NLopt's L-BFGS and Ipopt from the same ones.
struct ParFamCurve {
  std::vector<std::string> names = {"v", "s"};
  Expression truth = parse("(3.66*v + 8.52*s - 0.44)*exp(-0.78*v^2 + 1.26*v*s + 0.02*v)", names);
  std::vector<std::size_t> places = constant_positions(truth);
  std::vector<double> v;
  std::vector<double> s;
  std::vector<double> y;
  std::vector<const double*> columns;
  Inputs inputs;
  RandomStream random{1};

  explicit ParFamCurve(std::size_t rows = 90)
      : v(rows), s(rows), y(rows), columns{v.data(), s.data()}, inputs{columns, rows} {
    std::erase_if(places, [&](std::size_t place) { return truth.node(place).value == 2; });
    const std::size_t half = rows / 2;
    for (std::size_t i = 0; i < rows; ++i) {
      s[i] = i < half ? -1 : 1;
      v[i] = s[i] * (0.015 + 0.665 * static_cast<double>(i % half) / static_cast<double>(half - 1));
    }
    Evaluator().evaluate(truth, inputs, y);
    for (double& value : y) value += kNoise * random.normal();
  }
  std::vector<double> start() {
    std::vector<double> x(places.size());
    for (double& value : x) value = random.normal();
    return x;
  }
  static constexpr double kNoise = 0.05;
  // A minimum counts where it leaves little more than the noise.
  static bool is_reached(double sum_squares) { return sum_squares < 90 * kNoise * kNoise * 1.5; }
};

// What one pass over the rows with other constants costs: interpreted, compiled, and with the sums
// that a step of a fit needs. Compiled code has to pay back 20 us (expression_bench).
void one_pass(benchmark::State& state) {
  ParFamCurve curve(static_cast<std::size_t>(state.range(1)));
  std::vector<double> out(curve.y.size());
  std::vector<double> expected(curve.y.size());
  Evaluator evaluator;
  auto code = CompiledFormula::compile(curve.truth);
  if (!code) return state.SkipWithError("no code is generated on this machine");
  std::vector<double> constants;
  for (const std::size_t place : constant_positions(curve.truth)) {
    constants.push_back(curve.truth.node(place).value);
  }
  evaluator.evaluate(curve.truth, curve.inputs, expected);
  code->evaluate(constants, curve.inputs, out);
  if (out != expected) throw std::runtime_error("code and interpreter disagree");
  Differentiator differentiator;
  differentiator.prepare(curve.truth, curve.places);
  std::vector<double> fitted;
  for (const std::size_t place : curve.places) fitted.push_back(curve.truth.node(place).value);
  NormalEquations sums;
  for (auto _ : state) {
    if (state.range(0) == 0) {
      evaluator.evaluate(curve.truth, curve.inputs, out);
    } else if (state.range(0) == 1) {
      code->evaluate(constants, curve.inputs, out);
    } else {
      differentiator.set_constants(fitted);
      differentiator.normal_equations(curve.inputs, curve.y, {}, sums);
    }
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
}
BENCHMARK(one_pass)
    ->ArgNames({"interpreted_0_compiled_1_sums_2", "rows"})
    ->ArgsProduct({{0, 1, 2}, {90, 1000, 5000}});

void report(benchmark::State& state, std::int64_t starts, std::int64_t reached) {
  if (starts > 100 && reached < starts / 3) state.SkipWithError("too few starts reach the truth");
  state.counters["reached"] = static_cast<double>(reached) / static_cast<double>(starts);
}

void fit_parfam_formula(benchmark::State& state) {
  ParFamCurve curve;
  ConstantFitter fitter;
  std::int64_t starts = 0;
  std::int64_t iterations = 0;
  std::int64_t reached = 0;
  for (auto _ : state) {
    Expression formula = curve.truth;
    const std::vector<double> start = curve.start();
    for (std::size_t k = 0; k < start.size(); ++k) {
      set_constant(formula, curve.places[k], start[k]);
    }
    const ConstantFitResult result =
        fitter.fit(formula, curve.inputs, curve.y, {}, {.max_iterations = 100});
    starts += 1;
    iterations += result.iterations;
    if (ParFamCurve::is_reached(result.sum_squares)) reached += 1;
  }
  state.counters["iterations_per_start"] =
      static_cast<double>(iterations) / static_cast<double>(starts);
  report(state, starts, reached);
}
BENCHMARK(fit_parfam_formula)->Unit(benchmark::kMicrosecond);

void fit_parfam_formula_generally(benchmark::State& state) {
  ParFamCurve curve;
  Differentiator differentiator;
  differentiator.prepare(curve.truth, curve.places);
  NormalEquations sums;
  const Objective objective = [&](std::span<const double> x, std::span<double> gradient) {
    differentiator.set_constants(x);
    differentiator.normal_equations(curve.inputs, curve.y, {}, sums);
    for (std::size_t k = 0; k < gradient.size(); ++k) gradient[k] = 2 * sums.gradient[k];
    return sums.sum_squares;
  };
  std::int64_t starts = 0;
  std::int64_t reached = 0;
  std::uint64_t evaluations = 0;
  for (auto _ : state) {
    const std::vector<double> start = curve.start();
    const Minimum minimum = state.range(0) == 0
                                ? minimize_nlopt(NloptMethod::lbfgs, objective, start)
                                : minimize_ipopt(objective, start);
    starts += 1;
    evaluations += minimum.evaluations;
    if (ParFamCurve::is_reached(minimum.value)) reached += 1;
  }
  state.counters["evaluations_per_start"] =
      static_cast<double>(evaluations) / static_cast<double>(starts);
  report(state, starts, reached);
}
BENCHMARK(fit_parfam_formula_generally)
    ->ArgName("nlopt_0_ipopt_1")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMicrosecond);

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
    places.push_back(constant_positions(formulas.back()));
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
