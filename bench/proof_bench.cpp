// SPDX-License-Identifier: MIT
//
// What a verdict costs: random formulas with division over the box of a joint with load, one after
// another. Counters: median, 99th percentile and worst CPU time of one formula in milliseconds and
// the share of formulas decided. Checks every proof at sampled points and every witness with the
// evaluator. Also the cost of the canonical hash, a node, and of the shortest form.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/expression/canonical.hpp"
#include "algorithms/expression/complexity.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/operator_set.hpp"
#include "algorithms/expression/random_formula.hpp"
#include "algorithms/expression/simplify.hpp"
#include "algorithms/expression/singularity.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/random.hpp"

namespace tribench {
namespace {

constexpr std::size_t kFormulas = 2000;
const InputBox kBox = {{-2, 2}, {-1, 1, 0}, {-60, 60}, {-1, 1, 2}};  // v, sgn_v, g, sgn_g

std::vector<Expression> formulas_with_division(std::size_t nodes) {
  RandomStream random = RandomStream(key_of("proof bench")).split(nodes);
  const RandomFormulas formulas(find_operator_set("paper+div"), kBox.size(), {.constant_scale = 3});
  std::vector<Expression> all;
  while (all.size() < kFormulas) {
    Expression formula = formulas.grown(nodes, random);
    const bool divides = std::any_of(formula.nodes().begin(), formula.nodes().end(),
                                     [](const Node& node) { return node.op == Op::div; });
    if (divides) all.push_back(std::move(formula));
  }
  return all;
}

double cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

// Whether the result bears a look: a witness is none, or a proof fails at a point.
bool is_right(const Expression& formula, const SingularityResult& result, RandomStream& random) {
  Evaluator evaluator;
  if (result.verdict == Verdict::refuted) {
    const Expression node = subtree(formula, result.witness->node);
    const double value = evaluator.evaluate_at(node, result.witness->point);
    if (result.witness->neighbour.empty()) return !std::isfinite(value);
    const double beside = evaluator.evaluate_at(node, result.witness->neighbour);
    return (value < 0 && beside > 0) || (value > 0 && beside < 0);
  }
  for (int i = 0; i < 20 && result.verdict == Verdict::proved_free; ++i) {
    std::vector<double> point = {random.uniform(-2, 2), 0, random.uniform(-60, 60), 0};
    point[1] = point[0] > 0 ? 1 : -1;
    point[3] = point[2] > 0 ? 1 : -1;
    if (!std::isfinite(evaluator.evaluate_at(formula, point))) return false;
  }
  return true;
}

void prove(benchmark::State& state) {
  const std::vector<Expression> formulas =
      formulas_with_division(static_cast<std::size_t>(state.range(0)));
  RandomStream random(key_of("proof bench points"));
  std::vector<double> times;
  std::size_t proved = 0;
  std::size_t refuted = 0;
  for (auto _ : state) {
    times.clear();
    proved = refuted = 0;
    for (const Expression& formula : formulas) {
      const double start = cpu_ms();
      const SingularityResult result = prove_free(formula, kBox);
      times.push_back(cpu_ms() - start);
      proved += result.verdict == Verdict::proved_free ? 1 : 0;
      refuted += result.verdict == Verdict::refuted ? 1 : 0;
      if (!is_right(formula, result, random)) state.SkipWithError("a verdict is wrong");
    }
  }
  std::sort(times.begin(), times.end());
  const auto total = static_cast<double>(times.size());
  state.counters["median_ms"] = times[times.size() / 2];
  state.counters["p99_ms"] = times[times.size() * 99 / 100];
  state.counters["worst_ms"] = times.back();
  state.counters["proved_%"] = 100 * static_cast<double>(proved) / total;
  state.counters["refuted_%"] = 100 * static_cast<double>(refuted) / total;
  state.counters["decided_%"] = 100 * static_cast<double>(proved + refuted) / total;
}
BENCHMARK(prove)->Arg(7)->Arg(15)->Arg(31)->Arg(63)->Unit(benchmark::kMillisecond)->Iterations(1);

// 1 / (q(v)^2 + gap) with the square multiplied out: its least values lie inside the box, next to
// 0.
std::vector<Expression> near_double_roots(std::size_t degree_of_root, double gap) {
  RandomStream random = RandomStream(key_of("near double roots")).split(degree_of_root);
  std::vector<Expression> all;
  while (all.size() < 200) {
    std::vector<double> q(degree_of_root + 1);
    for (double& c : q) c = random.uniform(-1, 1);
    std::vector<double> square(2 * degree_of_root + 1);
    for (std::size_t i = 0; i < square.size(); ++i) {
      for (std::size_t j = 0; j <= i && j < q.size(); ++j) {
        if (i - j < q.size()) square[i] += q[j] * q[i - j];
      }
    }
    Expression sum = Expression::constant(square[0] + gap);
    for (std::size_t k = 1; k < square.size(); ++k) {
      const Expression power = Expression::binary(Op::pow, Expression::variable(0),
                                                  Expression::constant(static_cast<double>(k)));
      const Expression term = Expression::binary(Op::mul, Expression::constant(square[k]), power);
      sum = Expression::binary(Op::add, sum, term);
    }
    all.push_back(Expression::binary(Op::div, Expression::constant(1), sum));
  }
  return all;
}

void prove_polynomials(benchmark::State& state) {
  const double gap = std::pow(10.0, -static_cast<double>(state.range(1)));
  const std::vector<Expression> formulas =
      near_double_roots(static_cast<std::size_t>(state.range(0)) / 2, gap);
  std::size_t boxes = 0;
  double worst = 0;
  for (auto _ : state) {
    boxes = 0;
    for (const Expression& formula : formulas) {
      const double start = cpu_ms();
      const SingularityResult result = prove_free(formula, kBox);
      worst = std::max(worst, cpu_ms() - start);
      boxes += result.boxes;
      if (result.verdict != Verdict::proved_free) state.SkipWithError("not proved");
    }
  }
  state.counters["boxes_each"] = static_cast<double>(boxes) / static_cast<double>(formulas.size());
  state.counters["worst_ms"] = worst;
}
BENCHMARK(prove_polynomials)
    ->ArgNames({"degree", "gap_1e-"})
    ->ArgsProduct({{2, 4, 6, 8}, {3, 6}})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

void hash(benchmark::State& state) {
  const std::vector<Expression> formulas =
      formulas_with_division(static_cast<std::size_t>(state.range(0)));
  Canonicalizer canonicalizer;
  std::size_t nodes = 0;
  for (auto _ : state) {
    for (const Expression& formula : formulas) {
      benchmark::DoNotOptimize(canonicalizer.hash(formula).exact);
      nodes += formula.size();
    }
  }
  for (const Expression& formula : formulas) {
    if (canonicalizer.hash(formula).shape != Canonicalizer().hash(formula).shape) {
      state.SkipWithError("a hash depends on the workspace's past");
    }
  }
  state.counters["per_node"] = benchmark::Counter(
      static_cast<double>(nodes), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(hash)->Arg(15)->Arg(31)->Unit(benchmark::kMicrosecond);

// Random formulas have no common factors: next to nothing to do. What searches leave, has.
void simplify_formulas(benchmark::State& state) {
  constexpr std::size_t kSimplified = 200;
  std::vector<Expression> formulas =
      formulas_with_division(static_cast<std::size_t>(state.range(0)));
  formulas.resize(kSimplified);
  std::vector<double> times;
  std::size_t shorter = 0;
  for (auto _ : state) {
    times.clear();
    shorter = 0;
    for (const Expression& formula : formulas) {
      const double start = cpu_ms();
      const Expression simple = simplify(formula, kBox);
      times.push_back(cpu_ms() - start);
      shorter += simple.size() < formula.size() ? 1 : 0;
    }
  }
  std::ranges::sort(times);
  state.counters["median_ms"] = times[times.size() / 2];
  state.counters["p99_ms"] = times[times.size() * 99 / 100];
  state.counters["shorter"] = static_cast<double>(shorter) / static_cast<double>(formulas.size());
}
BENCHMARK(simplify_formulas)->Arg(15)->Arg(31)->Unit(benchmark::kMillisecond)->Iterations(1);

// As a search printed them: each has to become as short as the law that it is.
void simplify_printed_formulas(benchmark::State& state) {
  const std::vector<std::string> names = {"v", "g", "t", "w"};
  const InputBox box = {{0.5, 5}, {0.5, 5}, {0.5, 5}, {0.5, 5}};
  const std::pair<const char*, int> forms[] = {
      {"v^1.5*g^1.5/t^1.5/((w + v)/t + 1)^1.5", 11},
      {"t*exp(-2*v*(g - w))*(exp(v*(g - w)) - 1)^2", 13},
      {"sqrt(w^2 + 1/v^2/g^2 - t*(2/g - v^2*t))", 16},
      {"0.4*exp(-0.5*v^2/t^2 + g*(v - 0.5*g)/t^2)/t", 14},
      {"-2*v/v*(cos(g*t*1)*v*1 - v*1)", 10},
  };
  for (auto _ : state) {
    for (const auto& [text, nodes] : forms) {
      const Expression simple = simplify(parse(text, names), box);
      if (node_count(simple) > nodes) state.SkipWithError(print(simple, names).c_str());
    }
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(std::size(forms)) * state.iterations());
}
BENCHMARK(simplify_printed_formulas)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tribench
