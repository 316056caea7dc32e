// SPDX-License-Identifier: MIT
#include "algorithms/expression/compile.hpp"

#include <algorithm>
#include <new>
#include <utility>

#include "algorithms/expression/code_generator.hpp"
#include "algorithms/expression/compile_plan.hpp"
#include "algorithms/expression/edit.hpp"
#include "algorithms/expression/program.hpp"
#include "algorithms/expression/vector/kernels.hpp"

namespace tribench {
namespace {

using compile::Place;
using compile::Step;

constexpr std::align_val_t kCacheLine{64};
constexpr std::size_t kWidest = 64;  // bytes of a vector

int function_index(Op op) { return static_cast<int>(op) - static_cast<int>(Op::neg); }

}  // namespace

template <typename T>
struct BasicCompiledFormula<T>::Code {
  Code(const Expression& formula, VectorLevel level);

  void set_scalars(std::span<const T> constants);
  T scalar_of(std::size_t node, std::size_t& next_constant, std::span<const T> constants) const;
  void run(T* out, std::size_t n) const;
  void run_power(const Step& step, T* out, std::size_t n) const;
  void run_rest(const BasicInputs<T>& inputs, std::size_t row, std::size_t n, T* out);
  const T* operand(std::size_t node) const {
    return static_cast<const T*>(operands[plan.nodes[node].index]);
  }

  Expression formula;
  compile::Plan plan;
  compile::Loops loops;
  const KernelTable<T>& kernels;
  std::size_t lanes;
  std::size_t block;  // rows at once
  std::vector<T> scalars;
  std::vector<const void*> operands;
  std::size_t constant_count = 0;
  struct Free {
    void operator()(T* p) const { ::operator delete[](p, kCacheLine); }
  };
  std::unique_ptr<T[], Free> buffers;  // of the plan, then one vector a column and for the result
};

template <typename T>
BasicCompiledFormula<T>::Code::Code(const Expression& source, VectorLevel level)
    : formula(source),
      plan(compile::make_plan(formula)),
      loops(compile::generate_loops<T>(formula, plan, level)),
      kernels(kernel_table<T>(level)),
      lanes((level == VectorLevel::avx512 ? kWidest : kWidest / 2) / sizeof(T)) {
  const std::size_t columns = plan.columns.size();
  const std::size_t held = plan.operands - columns;
  // One region alone needs no buffers and thus no blocks.
  block = held == 0 ? ~std::size_t{0} / 2 / lanes * lanes : kBlockRows<T>;
  const std::size_t per_vector = kWidest / sizeof(T);
  buffers.reset(new (kCacheLine) T[held * kBlockRows<T> + (columns + 1) * per_vector]);
  operands.resize(plan.operands);
  for (std::size_t k = 0; k < held; ++k) {
    operands[columns + k] = buffers.get() + k * kBlockRows<T>;
  }
  scalars.resize(plan.scalars.size());
  for (const T& value : compile::extra_scalars<T>()) scalars.push_back(value);
  for (const Node& node : formula.nodes()) constant_count += node.is_constant() ? 1 : 0;
}

// Children stand before their parents, constants in the order of the tape.
template <typename T>
T BasicCompiledFormula<T>::Code::scalar_of(std::size_t i, std::size_t& next_constant,
                                           std::span<const T> constants) const {
  const Node& node = formula.node(i);
  if (node.is_constant()) return constants[next_constant++];
  const T& b = scalars[plan.nodes[formula.last_child(i)].index];
  T result = 0;
  if (arity(node.op) == 1) {
    kernels.function[function_index(node.op)](&result, &b, nullptr, nullptr, 1);
    return result;
  }
  const T& a = scalars[plan.nodes[formula.left_child(i)].index];
  BlockKernel<T> kernel = kernels.power[kFormVV];
  if (node.op != Op::pow) {
    kernel = kernels.binary[static_cast<int>(node.op) - static_cast<int>(Op::add)][kFormVV];
  } else if (is_product_power(static_cast<double>(b))) {
    kernel = kernels.integer_power;
  }
  kernel(&result, &a, &b, nullptr, 1);
  return result;
}

template <typename T>
void BasicCompiledFormula<T>::Code::set_scalars(std::span<const T> constants) {
  std::size_t next_constant = 0;
  for (std::size_t k = 0; k < plan.scalars.size(); ++k) {
    scalars[k] = scalar_of(plan.scalars[k], next_constant, constants);
  }
}

template <typename T>
void BasicCompiledFormula<T>::Code::run_power(const Step& step, T* out, std::size_t n) const {
  const std::size_t base = formula.left_child(step.node);
  const std::size_t exponent = formula.last_child(step.node);
  const bool fixed_base = plan.nodes[base].place == Place::scalar;
  const bool fixed_exponent = plan.nodes[exponent].place == Place::scalar;
  const T* const a = fixed_base ? &scalars[plan.nodes[base].index] : operand(base);
  const T* const b = fixed_exponent ? &scalars[plan.nodes[exponent].index] : operand(exponent);
  if (fixed_exponent && is_product_power(static_cast<double>(*b))) {
    kernels.integer_power(out, a, b, nullptr, n);
  } else {
    const int form = fixed_exponent ? kFormVS : (fixed_base ? kFormSV : kFormVV);
    kernels.power[form](out, a, b, nullptr, n);
  }
}

// n rows, a multiple of the vector's, from where the operands stand.
template <typename T>
void BasicCompiledFormula<T>::Code::run(T* out, std::size_t n) const {
  for (std::size_t s = 0; s < plan.steps.size(); ++s) {
    const Step& step = plan.steps[s];
    T* const to =
        step.out == compile::kResult ? out : static_cast<T*>(const_cast<void*>(operands[step.out]));
    if (step.kind == Step::Kind::region) {
      loops.of_step[s](operands.data(), scalars.data(), to, n * sizeof(T));
    } else if (step.kind == Step::Kind::power) {
      run_power(step, to, n);
    } else {
      const Op op = formula.node(step.node).op;
      kernels.function[function_index(op)](to, operand(formula.last_child(step.node)), nullptr,
                                           nullptr, n);
    }
  }
}

// The last rows, fewer than a vector has: the columns are brought into vectors of our own.
template <typename T>
void BasicCompiledFormula<T>::Code::run_rest(const BasicInputs<T>& inputs, std::size_t row,
                                             std::size_t n, T* out) {
  const std::size_t columns = plan.columns.size();
  const std::size_t per_vector = kWidest / sizeof(T);
  T* const scratch = buffers.get() + (plan.operands - columns) * kBlockRows<T>;
  for (std::size_t k = 0; k < columns; ++k) {
    const T* const from = inputs.columns[plan.columns[k]] + row;
    T* const to = scratch + k * per_vector;
    std::copy_n(from, n, to);
    std::fill(to + n, to + lanes, from[0]);
    operands[k] = to;
  }
  T* const result = scratch + columns * per_vector;
  run(result, lanes);
  std::copy_n(result, n, out);
}

template <typename T>
std::optional<BasicCompiledFormula<T>> BasicCompiledFormula<T>::compile(const Expression& formula,
                                                                        VectorLevel level) {
  auto code = std::make_unique<Code>(formula, level);
  if (!code->loops.memory) return std::nullopt;
  return BasicCompiledFormula(std::move(code));
}

template <typename T>
BasicCompiledFormula<T>::BasicCompiledFormula(std::unique_ptr<Code> code)
    : code_(std::move(code)) {}
template <typename T>
BasicCompiledFormula<T>::~BasicCompiledFormula() = default;
template <typename T>
BasicCompiledFormula<T>::BasicCompiledFormula(BasicCompiledFormula&&) noexcept = default;
template <typename T>
BasicCompiledFormula<T>& BasicCompiledFormula<T>::operator=(BasicCompiledFormula&&) noexcept =
    default;

template <typename T>
std::size_t BasicCompiledFormula<T>::constants() const {
  return code_->constant_count;
}

template <typename T>
void BasicCompiledFormula<T>::evaluate(std::span<const T> constants, const BasicInputs<T>& inputs,
                                       std::span<T> out) {
  Code& code = *code_;
  code.set_scalars(constants);
  for (std::size_t row = 0; row < inputs.rows; row += code.block) {
    const std::size_t n = std::min(code.block, inputs.rows - row);
    const std::size_t whole = n / code.lanes * code.lanes;
    for (std::size_t k = 0; k < code.plan.columns.size(); ++k) {
      code.operands[k] = inputs.columns[code.plan.columns[k]] + row;
    }
    if (whole > 0) code.run(out.data() + row, whole);
    if (whole < n) code.run_rest(inputs, row + whole, n - whole, out.data() + row + whole);
  }
}

template class BasicCompiledFormula<double>;
template class BasicCompiledFormula<float>;

namespace {

// Measured (bench/README.md): what compiling costs, and what interpreting costs a node and row.
constexpr double kCompileNs = 15000;
constexpr double kCompileNsPerNode = 300;
constexpr double kInterpretNsPerNode = 8;
constexpr double kInterpretNsPerNodeRow = 0.08;

}  // namespace

void RepeatedEvaluator::prepare(const Expression& formula) {
  formula_ = formula;
  code_.reset();
  tried_ = false;
  spent_ns_ = 0;
  positions_.clear();
  constants_.clear();
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (!formula.node(i).is_constant()) continue;
    positions_.push_back(i);
    constants_.push_back(formula.node(i).value);
  }
}

void RepeatedEvaluator::set_constants(std::span<const double> constants) {
  for (std::size_t k = 0; k < positions_.size(); ++k) {
    if (is_exponent(formula_, positions_[k])) continue;
    constants_[k] = constants[k];
    set_constant(formula_, positions_[k], constants[k]);
  }
}

void RepeatedEvaluator::evaluate(const Inputs& inputs, std::span<double> out) {
  if (code_) return code_->evaluate(constants_, inputs, out);
  const auto nodes = static_cast<double>(formula_.size());
  spent_ns_ +=
      nodes * (kInterpretNsPerNode + kInterpretNsPerNodeRow * static_cast<double>(inputs.rows));
  evaluator_.evaluate(formula_, inputs, out);
  if (!tried_ && spent_ns_ > kCompileNs + kCompileNsPerNode * nodes) {
    tried_ = true;
    code_ = CompiledFormula::compile(formula_, evaluator_.level());
  }
}

}  // namespace tribench
