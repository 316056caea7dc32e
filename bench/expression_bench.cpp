// SPDX-License-Identifier: MIT
//
// Evaluation in Operon's metric: 1000 random balanced trees of 1 to 64 nodes over nine inputs,
// node evaluations a second = (sum of tree lengths, leaves included) * rows / seconds, everything
// that a search pays for each tree included. bench/README.md says how to read the figures.
//
// Every case first checks its values against plain recursion.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "algorithms/expression/compile.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/random_formula.hpp"
#include "bench/measured_loop.hpp"
#include "tests/algorithms/expression/reference.hpp"

namespace tribench {
namespace {

constexpr std::size_t kTrees = 1000;
constexpr std::size_t kLargest = 64;
constexpr std::size_t kInputs = 9;

enum OperatorChoice : int { kProducts, kArithmetic, kWithExp, kWithAll };

std::vector<Op> operators_of(int choice) {
  std::vector<Op> operators = {Op::add, Op::sub, Op::mul};
  if (choice >= kArithmetic) operators.push_back(Op::div);
  if (choice >= kWithExp) operators.push_back(Op::exp);
  if (choice == kWithAll) operators.insert(operators.end(), {Op::sqrt, Op::log, Op::sin});
  return operators;
}

const char* name_of(int choice) {
  constexpr const char* kNames[] = {"+-*", "+-*/", "+-*/ exp", "+-*/ exp sqrt log sin"};
  return kNames[choice];
}

struct Trees {
  std::vector<Expression> formulas;
  std::uint64_t nodes = 0;
};

const Trees& trees_of(int choice) {
  static std::map<int, Trees> cache;
  Trees& trees = cache[choice];
  if (!trees.formulas.empty()) return trees;
  RandomStream random(key_of("expression bench"));
  const RandomFormulas formulas(operators_of(choice), kInputs);
  for (std::size_t i = 0; i < kTrees; ++i) {
    trees.formulas.push_back(formulas.balanced(1 + random.below(kLargest), random));
    trees.nodes += trees.formulas.back().size();
  }
  return trees;
}

// Columns that start at cache lines.
template <typename T>
struct Table {
  explicit Table(std::size_t rows) : stride((rows + 31) / 32 * 32) {
    constexpr std::align_val_t kLine{64};
    memory.reset(new (kLine) T[stride * kInputs]);
    RandomStream random(key_of("expression bench rows"));
    for (std::size_t j = 0; j < kInputs; ++j) {
      T* column = memory.get() + j * stride;
      for (std::size_t r = 0; r < rows; ++r) column[r] = static_cast<T>(random.uniform(-1, 1));
      columns.push_back(column);
    }
    inputs = {columns, rows};
  }
  struct Free {
    void operator()(T* p) const { ::operator delete[](p, std::align_val_t{64}); }
  };
  std::size_t stride;
  std::unique_ptr<T[], Free> memory;
  std::vector<const T*> columns;
  BasicInputs<T> inputs;
};

template <typename T>
void check(const Trees& trees, const Table<T>& table, BasicEvaluator<T>& evaluator) {
  std::vector<T> out(table.inputs.rows);
  for (std::size_t k = 0; k < trees.formulas.size(); k += 10) {
    evaluator.evaluate(trees.formulas[k], table.inputs, out);
    for (std::size_t r = 0; r < out.size(); r += 13) {
      std::vector<T> point;
      for (const T* column : table.columns) point.push_back(column[r]);
      const Expression& formula = trees.formulas[k];
      const T expected = reference::evaluate<T>(formula, formula.root(), point);
      if (out[r] != expected && !(std::isnan(out[r]) && std::isnan(expected))) {
        throw std::runtime_error("the evaluator and plain recursion disagree");
      }
    }
  }
}

template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  for (std::size_t r = 0; r < a.size(); ++r) {
    if (a[r] != b[r] && !(std::isnan(a[r]) && std::isnan(b[r]))) return false;
  }
  return true;
}

void report(benchmark::State& state, double nodes, std::size_t rows, const std::string& label) {
  state.counters["node_rows/s"] = benchmark::Counter(nodes * static_cast<double>(rows),
                                                     benchmark::Counter::kIsIterationInvariantRate);
  state.SetLabel(label);
}

template <typename T>
void interpreter(benchmark::State& state) {
  const Trees& trees = trees_of(static_cast<int>(state.range(0)));
  const auto rows = static_cast<std::size_t>(state.range(1));
  const auto& levels = available_vector_levels();
  const VectorLevel level = state.range(2) < 0 ? vector_level()
                            : static_cast<std::size_t>(state.range(2)) < levels.size()
                                ? levels[static_cast<std::size_t>(state.range(2))]
                                : levels.back();
  const Table<T> table(rows);
  BasicEvaluator<T> evaluator(level);
  check(trees, table, evaluator);
  std::vector<T> out(rows);
  for (auto _ : state) {
    for (const Expression& formula : trees.formulas) evaluator.evaluate(formula, table.inputs, out);
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  report(state, static_cast<double>(trees.nodes), rows,
         std::string(name_of(static_cast<int>(state.range(0)))) + ", " +
             std::string(vector_level_name(level)));
}

// Seconds of the wall that `threads` threads take for all trees, several times over; each thread
// has its own evaluator and takes every threads-th tree. last_values[k] is of tree k.
double seconds_of(const Trees& trees, const Table<double>& table, std::size_t threads,
                  std::vector<double>& last_values) {
  constexpr int kRounds = 10;
  const auto work = [&](std::size_t first) {
    Evaluator evaluator;
    std::vector<double> out(table.inputs.rows);
    for (int round = 0; round < kRounds; ++round) {
      for (std::size_t k = first; k < trees.formulas.size(); k += threads) {
        evaluator.evaluate(trees.formulas[k], table.inputs, out);
        if (round + 1 == kRounds) last_values[k] = out.back();
      }
    }
  };
  const auto start = std::chrono::steady_clock::now();
  std::vector<std::thread> others;
  for (std::size_t t = 1; t < threads; ++t) others.emplace_back(work, t);
  work(0);
  for (std::thread& other : others) other.join();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// One thread and several in turn, so that a machine that slows down slows both; `speedup` is the
// ratio of the shortest turns. Time is the wall's: nothing else may run.
void scaling(benchmark::State& state) {
  if (is_left_out_at_night(state)) return;
  const Trees& trees = trees_of(static_cast<int>(state.range(0)));
  const auto rows = static_cast<std::size_t>(state.range(1));
  const auto threads = static_cast<std::size_t>(state.range(2));
  if (threads > std::thread::hardware_concurrency()) {
    return state.SkipWithError("this machine has fewer processors");
  }
  const Table<double> table(rows);
  std::vector<double> alone(kTrees);
  std::vector<double> together(kTrees);
  double shortest_alone = 1e300;
  double shortest_together = 1e300;
  for (auto _ : state) {
    shortest_alone = std::min(shortest_alone, seconds_of(trees, table, 1, alone));
    const double seconds = seconds_of(trees, table, threads, together);
    shortest_together = std::min(shortest_together, seconds);
    state.SetIterationTime(seconds);
  }
  if (!same_bits(alone, together)) throw std::runtime_error("threads change the result");
  state.counters["speedup"] = shortest_alone / shortest_together;
  state.SetLabel(name_of(static_cast<int>(state.range(0))));
}

// Formulas evaluated again and again: kTurns times each, with constants handed in every time.
constexpr int kTurns = 8;
constexpr std::size_t kCompiled = 200;

template <typename T>
void compiled(benchmark::State& state) {
  const Trees& trees = trees_of(static_cast<int>(state.range(0)));
  const auto rows = static_cast<std::size_t>(state.range(1));
  const Table<T> table(rows);
  BasicEvaluator<T> evaluator;
  std::vector<BasicCompiledFormula<T>> codes;
  std::vector<std::vector<T>> constants;
  std::vector<T> out(rows);
  std::vector<T> expected(rows);
  double nodes = 0;
  for (std::size_t k = 0; k < kCompiled; ++k) {
    const Expression& formula = trees.formulas[k];
    auto code = BasicCompiledFormula<T>::compile(formula);
    if (!code) return state.SkipWithError("no code is generated on this machine");
    std::vector<T> values;
    for (const std::size_t i : constant_positions(formula)) {
      values.push_back(static_cast<T>(formula.node(i).value));
    }
    code->evaluate(values, table.inputs, out);
    evaluator.evaluate(formula, table.inputs, expected);
    if (!same_bits(out, expected)) throw std::runtime_error("code and interpreter disagree");
    codes.push_back(std::move(*code));
    constants.push_back(std::move(values));
    nodes += static_cast<double>(formula.size());
  }
  for (auto _ : state) {
    for (std::size_t k = 0; k < kCompiled; ++k) {
      for (int turn = 0; turn < kTurns; ++turn) codes[k].evaluate(constants[k], table.inputs, out);
    }
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  report(state, nodes * kTurns, rows, name_of(static_cast<int>(state.range(0))));
}

// Seconds to compile one formula of 64 nodes (63 where only binary operators are allowed).
void compiling(benchmark::State& state) {
  RandomStream random(key_of("compiling"));
  const RandomFormulas formulas(operators_of(static_cast<int>(state.range(0))), kInputs);
  std::vector<Expression> candidates;
  for (int k = 0; k < 50; ++k) candidates.push_back(formulas.balanced(64, random));
  std::size_t next = 0;
  for (auto _ : state) {
    auto code = CompiledFormula::compile(candidates[next]);
    if (!code) return state.SkipWithError("no code is generated on this machine");
    benchmark::DoNotOptimize(code->constants());
    next = (next + 1) % candidates.size();
  }
  state.SetLabel(name_of(static_cast<int>(state.range(0))));
}

void every_case(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"set", "rows", "level"});
  for (const int choice : {kArithmetic, kWithExp, kWithAll}) {
    for (const int rows : {200, 1000, 5000}) bench->Args({choice, rows, -1});
  }
}

void compiled_cases(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"set", "rows"});
  for (const int choice : {kProducts, kArithmetic, kWithExp, kWithAll}) {
    for (const int rows : {200, 1000, 5000}) bench->Args({choice, rows});
  }
}

void lower_levels(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"set", "rows", "level"});
  for (const int level : {0, 1}) {
    for (const int choice : {kArithmetic, kWithAll}) bench->Args({choice, 1000, level});
  }
}

// Sums of squared errors against a bound that the first block exceeds (as for most candidates of a
// search) or that none does.
void error_sums(benchmark::State& state) {
  const Trees& trees = trees_of(kArithmetic);
  const bool is_early = state.range(1) != 0;
  const auto rows = static_cast<std::size_t>(state.range(0));
  const Table<double> table(rows);
  const std::vector<double> target(rows, 1e3);
  Evaluator evaluator;
  std::size_t done = 0;
  for (auto _ : state) {
    done = 0;
    for (const Expression& formula : trees.formulas) {
      const ErrorSum sum =
          evaluator.sum_squared_errors(formula, table.inputs, target, is_early ? 1.0 : kNoBound);
      done += sum.rows;
      if (is_early && sum.status == ErrorSumStatus::complete) {
        throw std::runtime_error("an error sum above its bound is called complete");
      }
    }
  }
  state.counters["rows_done_%"] =
      100 * static_cast<double>(done) / static_cast<double>(rows * trees.formulas.size());
  report(state, static_cast<double>(trees.nodes), rows, is_early ? "given up early" : "to the end");
}

void scaling_cases(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"set", "rows", "threads"});
  for (const int threads : {2, 4, 8, 16}) {
    for (const int choice : {kArithmetic, kWithAll}) {
      for (const int rows : {200, 1000, 5000}) bench->Args({choice, rows, threads});
    }
  }
}

BENCHMARK(interpreter<double>)->Apply(every_case)->Unit(benchmark::kMicrosecond);
BENCHMARK(interpreter<float>)->Apply(every_case)->Unit(benchmark::kMicrosecond);
BENCHMARK(interpreter<double>)->Apply(lower_levels)->Unit(benchmark::kMicrosecond);
BENCHMARK(error_sums)
    ->ArgNames({"rows", "early"})
    ->ArgsProduct({{200, 1000, 5000}, {0, 1}})
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(scaling)
    ->Apply(scaling_cases)
    ->UseManualTime()
    ->MinTime(0.3)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(compiled<double>)->Apply(compiled_cases)->Unit(benchmark::kMicrosecond);
BENCHMARK(compiled<float>)->Apply(compiled_cases)->Unit(benchmark::kMicrosecond);
BENCHMARK(compiling)
    ->ArgName("set")
    ->DenseRange(kProducts, kWithAll)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace tribench
