// SPDX-License-Identifier: MIT
//
// The limit: loops written by hand, compiled for this very processor, and what the interpreter and
// the compiled formula reach on the same formulas. Two fixed formulas over columns in cache:
//
//   A  31 nodes, + - * / (four quotients), five inputs
//   B  29 nodes, the friction law of the peer problem friction1d, one exp
//
// node_rows/s = nodes * rows / second. The hand-written loops need no translation, no buffers and
// no constants from memory: a ceiling, not a rival.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "algorithms/expression/compile.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/random.hpp"

#if defined(__AVX512F__)
#define TRIBENCH_LANE_BYTES 64
#elif defined(__AVX2__)
#define TRIBENCH_LANE_BYTES 32
#else
#define TRIBENCH_LANE_BYTES 16
#endif
#include "algorithms/expression/vector/elementary_float.hpp"

namespace tribench {
namespace {

const std::vector<std::string> kNames = {"a", "b", "c", "d", "e"};
constexpr const char* kFormulaA = "(a*b + c)*(d/e) + a/(b + c) - (c*d - a)/(e + b) + b/(d*a)";
constexpr const char* kFormulaB =
    "(3.66*a + 8.52*b - 0.44)*exp(-0.78*a*a + 1.26*abs(a) + 0.02*a - 0.02*b)";

template <typename T>
struct Columns {
  explicit Columns(std::size_t rows) : stride((rows + 31) / 32 * 32) {
    memory.reset(new (std::align_val_t{64}) T[stride * (kNames.size() + 1)]);
    RandomStream random(key_of("limits"));
    for (std::size_t j = 0; j < kNames.size(); ++j) {
      for (std::size_t r = 0; r < stride; ++r) {
        memory[j * stride + r] = static_cast<T>(random.uniform(0.5, 2));
      }
      pointers.push_back(memory.get() + j * stride);
    }
    out = {memory.get() + kNames.size() * stride, rows};
    inputs = {pointers, rows};
  }
  struct Free {
    void operator()(T* p) const { ::operator delete[](p, std::align_val_t{64}); }
  };
  std::size_t stride;
  std::unique_ptr<T[], Free> memory;
  std::vector<const T*> pointers;
  BasicInputs<T> inputs;
  std::span<T> out;
};

template <typename T>
void loop_a(const Columns<T>& data) {
  const T* __restrict a = data.pointers[0];
  const T* __restrict b = data.pointers[1];
  const T* __restrict c = data.pointers[2];
  const T* __restrict d = data.pointers[3];
  const T* __restrict e = data.pointers[4];
  T* __restrict out = data.out.data();
  for (std::size_t r = 0; r < data.inputs.rows; ++r) {
    out[r] = (a[r] * b[r] + c[r]) * (d[r] / e[r]) + a[r] / (b[r] + c[r]) -
             (c[r] * d[r] - a[r]) / (e[r] + b[r]) + b[r] / (d[r] * a[r]);
  }
}

template <typename T>
void loop_b(const Columns<T>& data) {
  using V = Vector<T>;
  for (std::size_t r = 0; r < data.inputs.rows; r += kWidth<T>) {
    const V a = load<V>(data.pointers[0] + r);
    const V b = load<V>(data.pointers[1] + r);
    const V inner = T(-0.78) * a * a + T(1.26) * abs(a) + T(0.02) * a - T(0.02) * b;
    store(data.out.data() + r, (T(3.66) * a + T(8.52) * b - T(0.44)) * exp(inner));
  }
}

template <typename T>
void expect_same(const Columns<T>& data, const Expression& formula) {
  std::vector<T> expected(data.inputs.rows);
  BasicEvaluator<T>().evaluate(formula, data.inputs, expected);
  for (std::size_t r = 0; r < expected.size(); ++r) {
    if (data.out[r] != expected[r]) throw std::runtime_error("a way of evaluating disagrees");
  }
}

Expression formula_of(int which) { return parse(which == 0 ? kFormulaA : kFormulaB, kNames); }

template <typename T, typename F>
void measure(benchmark::State& state, F f) {
  const Expression formula = formula_of(static_cast<int>(state.range(0)));
  Columns<T> data(static_cast<std::size_t>(state.range(1)));
  f(data);
  expect_same(data, formula);
  for (auto _ : state) {
    f(data);
    benchmark::ClobberMemory();
  }
  state.counters["node_rows/s"] =
      benchmark::Counter(static_cast<double>(formula.size() * data.inputs.rows),
                         benchmark::Counter::kIsIterationInvariantRate);
}

template <typename T>
void by_hand(benchmark::State& state) {
  if (state.range(0) == 0) {
    measure<T>(state, [](Columns<T>& data) { loop_a(data); });
  } else {
    measure<T>(state, [](Columns<T>& data) { loop_b(data); });
  }
}

template <typename T>
void interpreted(benchmark::State& state) {
  const Expression formula = formula_of(static_cast<int>(state.range(0)));
  BasicEvaluator<T> evaluator;
  measure<T>(state, [&](Columns<T>& data) { evaluator.evaluate(formula, data.inputs, data.out); });
}

template <typename T>
void compiled(benchmark::State& state) {
  const Expression formula = formula_of(static_cast<int>(state.range(0)));
  auto code = BasicCompiledFormula<T>::compile(formula);
  if (!code) return state.SkipWithError("no code is generated on this machine");
  std::vector<T> constants;
  for (const std::size_t i : constant_positions(formula)) {
    constants.push_back(static_cast<T>(formula.node(i).value));
  }
  measure<T>(state, [&](Columns<T>& data) { code->evaluate(constants, data.inputs, data.out); });
}

void cases(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"formula", "rows"})->ArgsProduct({{0, 1}, {1024, 10240}});
}

BENCHMARK(by_hand<double>)->Apply(cases);
BENCHMARK(interpreted<double>)->Apply(cases);
BENCHMARK(compiled<double>)->Apply(cases);
BENCHMARK(by_hand<float>)->Apply(cases);
BENCHMARK(interpreted<float>)->Apply(cases);
BENCHMARK(compiled<float>)->Apply(cases);

}  // namespace
}  // namespace tribench
