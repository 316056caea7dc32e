// SPDX-License-Identifier: MIT
//
// What pysr's search costs: children made, admitted and fitted a second (five Levenberg-Marquardt
// steps each, as Operon's runs were set), pairs of a place and a term ranked a second, and one
// whole search. Each case checks what it made.
#include <benchmark/benchmark.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "algorithms/pysr/growth.hpp"
#include "algorithms/pysr/mutation.hpp"
#include "algorithms/pysr/scorer.hpp"
#include "algorithms/pysr/search.hpp"
#include "algorithms/pysr/simplify.hpp"
#include "bench/measured_loop.hpp"

namespace tribench {
namespace {

constexpr int kOperonSteps = 5;
constexpr int kLargest = 30;    // nodes
constexpr double kSpeed = 1.9;  // rad/s

const std::vector<Input> kInputs = {{"v", "rad/s", Role::velocity, -kSpeed, kSpeed, {}},
                                    {"sgn_v", "-", Role::velocity_sign, -1, 1, 0}};

// The friction law that the peers were measured on, with its noise.
pysr::Rows friction_rows(std::size_t count) {
  RandomStream random(key_of("pysr bench"));
  std::vector<std::vector<double>> columns(2);
  std::vector<double> target;
  for (std::size_t r = 0; r < count; ++r) {
    const double v =
        -kSpeed + 2 * kSpeed * (static_cast<double>(r) + 0.5) / static_cast<double>(count);
    const double s = v > 0 ? 1 : -1;
    columns[0].push_back(v);
    columns[1].push_back(s);
    const double curve = -0.78 * v * v + 1.26 * std::abs(v) + 0.02 * v - 0.02 * s;
    target.push_back((3.66 * v + 8.52 * s - 0.44) * std::exp(curve) + 0.05 * random.normal());
  }
  return {std::move(columns), std::move(target)};
}

Budget unlimited() { return Budget(BudgetLimits{}); }

void fitted_children(benchmark::State& state) {
  if (state.threads() > 1 && is_left_out_at_night(state)) return;
  const pysr::Rows rows = friction_rows(static_cast<std::size_t>(state.range(0)));
  const OperatorSet& operators = find_operator_set("paper");
  const pysr::Options options = pysr::profile_options(pysr::Profile::native);
  const pysr::Validator validator(options, operators, kInputs);
  pysr::Scorer scorer(validator, {});
  const pysr::Alphabet alphabet{operators, 2};
  RandomStream random(key_of("children"));
  Budget budget = unlimited();
  std::vector<Expression> parents;
  while (parents.size() < 200) {
    const int nodes = 5 + static_cast<int>(random.below(kLargest - 5));
    parents.push_back(pysr::random_formula_of_size(nodes, alphabet, random));
  }
  std::int64_t children = 0;
  std::int64_t finite = 0;
  std::int64_t nodes = 0;
  for (auto _ : state) {
    const Expression& parent = parents[static_cast<std::size_t>(children) % parents.size()];
    const auto kind = static_cast<pysr::MutationKind>(random.below(3));  // rotate, add, delete
    auto child = pysr::mutate(kind, parent, alphabet, {}, random);
    if (!child) child = parent;
    *child = pysr::simplified(*child);
    if (!validator.admits(*child, kLargest + 2)) *child = parent;
    finite += scorer.fit(*child, rows, kOperonSteps, budget).has_value() ? 1 : 0;
    nodes += static_cast<std::int64_t>(child->size());
    ++children;
  }
  if (children > 1000 && finite < children / 10)
    throw std::runtime_error("hardly a child was finite");
  state.SetItemsProcessed(children);
  state.counters["nodes"] = static_cast<double>(nodes) / static_cast<double>(children);
}
BENCHMARK(fitted_children)->Arg(200)->Arg(5000)->Unit(benchmark::kMicrosecond);
BENCHMARK(fitted_children)->Arg(200)->Threads(2)->UseRealTime()->Unit(benchmark::kMicrosecond);

void ranked_growth(benchmark::State& state) {
  const pysr::Rows rows = friction_rows(static_cast<std::size_t>(state.range(0)));
  const OperatorSet& operators = find_operator_set("paper");
  const pysr::Form form(kInputs.size());
  const pysr::TermLibraries libraries = pysr::make_term_libraries(form, rows, operators);
  const pysr::Options options = pysr::profile_options(pysr::Profile::native);
  const pysr::Validator validator(options, operators, kInputs);
  pysr::Scorer scorer(validator, {});
  pysr::Grower grower(operators, form, libraries);
  Budget budget = unlimited();
  RandomStream random(key_of("growth"));
  // (a v + b s) exp(c v^2): what is missing is |v| in the exponent.
  const Expression v = Expression::variable(0);
  const auto times = [](double c, const Expression& x) {
    return Expression::binary(Op::mul, Expression::constant(c), x);
  };
  const Expression line =
      Expression::binary(Op::add, times(4, v), times(8, Expression::variable(1)));
  const Expression square = Expression::binary(Op::pow, v, Expression::constant(2));
  Expression formula =
      Expression::binary(Op::mul, line, Expression::unary(Op::exp, times(-0.4, square)));
  scorer.fit(formula, rows, 50, budget);
  std::size_t proposals = 0;
  for (auto _ : state) {
    proposals += grower.grow(formula, rows, 0, 6, random, budget).size();
  }
  if (proposals == 0) throw std::runtime_error("nothing was proposed");
}
BENCHMARK(ranked_growth)->Arg(200)->Arg(5000)->Unit(benchmark::kMicrosecond);

void whole_search(benchmark::State& state) {
  const pysr::Rows rows = friction_rows(200);
  const std::vector<int> movement(rows.size(), 0);
  const TrainingData data{kInputs, rows.pointers, rows.target, movement};
  std::uint64_t seed = 0;
  for (auto _ : state) {
    Budget budget = unlimited();
    FitContext context{data, find_operator_set("paper"), budget, RandomStream(seed++), 1, nullptr};
    const FitResult result = pysr::search(pysr::profile_options(pysr::Profile::native), context);
    std::vector<double> values(rows.size());
    Evaluator().evaluate(result.front[result.chosen], rows.inputs(), values);
    double square = 0;
    for (std::size_t r = 0; r < values.size(); ++r)
      square += std::pow(values[r] - rows.target[r], 2);
    // The noise has 0.05.
    if (std::sqrt(square / 200) > 0.07) throw std::runtime_error("the law was not found");
  }
}
BENCHMARK(whole_search)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tribench
