// SPDX-License-Identifier: MIT
//
// What a search does to formulas between evaluations: random formulas, edits, canonical forms,
// printing and parsing. Times are a node, or a turn of edits. Each case checks its results.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "algorithms/expression/canonical.hpp"
#include "algorithms/expression/edit.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/random_formula.hpp"
#include "algorithms/expression/text.hpp"

namespace tribench {
namespace {

constexpr std::size_t kInputs = 4;
const std::vector<std::string> kNames = {"a", "b", "c", "d"};
const RandomFormulas kFormulas({Op::add, Op::sub, Op::mul, Op::div, Op::exp, Op::sqrt}, kInputs);

std::vector<Expression> some_formulas(std::size_t nodes) {
  RandomStream random = RandomStream(key_of("edit bench")).split(nodes);
  std::vector<Expression> all;
  while (all.size() < 500) all.push_back(kFormulas.grown(nodes, random));
  return all;
}

void require(bool right, const char* what) {
  if (!right) throw std::runtime_error(what);
}

bool lengths_are_right(const Expression& formula) {
  std::vector<Node> nodes(formula.nodes().begin(), formula.nodes().end());
  return assign_lengths(nodes) && std::ranges::equal(nodes, formula.nodes());
}

void per_item(benchmark::State& state, std::size_t items, const char* name) {
  state.counters[name] = benchmark::Counter(
      static_cast<double>(items), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void grow(benchmark::State& state) {
  RandomStream random(key_of("grow"));
  std::vector<Node> tape;
  std::size_t nodes = 0;
  for (auto _ : state) {
    tape.clear();
    kFormulas.append_grown(static_cast<std::size_t>(state.range(0)), random, tape);
    nodes += tape.size();
  }
  require(lengths_are_right(Expression(tape)), "a tape's lengths are wrong");
  per_item(state, nodes, "per_node");
}
BENCHMARK(grow)->Arg(15)->Arg(31)->Arg(63);

// A turn: a subtree replaced by another formula's and, where they fit, operands swapped and a
// rotation, at random places.
void edit(benchmark::State& state) {
  const std::vector<Expression> formulas = some_formulas(static_cast<std::size_t>(state.range(0)));
  RandomStream random(key_of("edit"));
  Expression first;
  Expression second;
  std::size_t turns = 0;
  for (auto _ : state) {
    const Expression& a = formulas[turns % formulas.size()];
    const Expression& b = formulas[(turns + 7) % formulas.size()];
    const std::size_t i = random.below(a.size());
    const std::size_t j = random.below(b.size());
    splice(a, i, subtree_nodes(b, j), second);
    if (arity(a.node(i).op) == 2) swap_operands(a, i, first);
    if (arity(a.node(i).op) == 2 && arity(a.node(i - 1).op) > 0) rotate(a, i, 1, 0, first);
    ++turns;
    benchmark::DoNotOptimize(first.nodes().data());
  }
  // A single turn may have had nothing to swap.
  require(first.empty() || lengths_are_right(first), "a swap spoils lengths");
  require(lengths_are_right(second), "an edit spoils lengths");
  per_item(state, turns, "per_turn");
}
BENCHMARK(edit)->Arg(15)->Arg(31)->Arg(63);

void canonical(benchmark::State& state) {
  const std::vector<Expression> formulas = some_formulas(static_cast<std::size_t>(state.range(0)));
  Canonicalizer canonicalizer;
  std::size_t nodes = 0;
  for (auto _ : state) {
    for (const Expression& formula : formulas) {
      benchmark::DoNotOptimize(canonicalizer.canonical(formula).size());
      nodes += formula.size();
    }
  }
  Evaluator evaluator;
  const std::vector<double> point = {0.3, 1.7, 0.9, 2.2};
  for (const Expression& formula : formulas) {
    const double before = evaluator.evaluate_at(formula, point);
    const double after = evaluator.evaluate_at(canonicalizer.canonical(formula), point);
    // Cancellation may amplify rounding; a rewrite that is wrong is wrong in the first digits.
    require(!std::isfinite(before) || std::abs(after - before) <= 1e-6 * (1 + std::abs(before)),
            "a canonical form has another value");
  }
  per_item(state, nodes, "per_node");
}
BENCHMARK(canonical)->Arg(15)->Arg(31)->Arg(63);

void print_and_parse(benchmark::State& state) {
  const std::vector<Expression> formulas = some_formulas(static_cast<std::size_t>(state.range(0)));
  std::size_t nodes = 0;
  for (auto _ : state) {
    for (const Expression& formula : formulas) {
      benchmark::DoNotOptimize(parse(print(formula, kNames), kNames).size());
      nodes += formula.size();
    }
  }
  for (const Expression& formula : formulas) {
    require(parse(print(formula, kNames), kNames) == formula, "a formula reads back as another");
  }
  per_item(state, nodes, "per_node");
}
BENCHMARK(print_and_parse)->Arg(15)->Arg(63);

}  // namespace
}  // namespace tribench
