// SPDX-License-Identifier: MIT
#include "algorithms/expression/program.hpp"

#include <algorithm>
#include <new>
#include <utility>

#include "algorithms/expression/evaluate.hpp"

namespace tribench {
namespace {

constexpr std::align_val_t kCacheLine{64};
constexpr int kAdd = 0;
constexpr int kMul = 2;

int basic_index(Op op) { return static_cast<int>(op) - static_cast<int>(Op::add); }
int function_index(Op op) { return static_cast<int>(op) - static_cast<int>(Op::neg); }
static_assert(static_cast<int>(Op::div) - static_cast<int>(Op::add) == kBasicOps - 1);
static_assert(static_cast<int>(Op::tanh) - static_cast<int>(Op::neg) == kFunctions - 1);

bool is_commutative(int basic) { return basic == kAdd || basic == kMul; }

// The outer form of `c op (pair)`.
int outer_with_pair_on_the_right(int basic) {
  if (is_commutative(basic)) return basic;
  return basic == 1 ? kOuterSubFrom : kOuterDivInto;
}

}  // namespace

template <typename T>
void Program<T>::FreeBlocks::operator()(T* p) const {
  ::operator delete[](p, kCacheLine);
}

template <typename T>
void Program<T>::reserve(std::size_t nodes) {
  if (nodes <= capacity_) return;
  capacity_ = std::max<std::size_t>(2 * capacity_, std::max<std::size_t>(nodes, 64));
  calls_.resize(capacity_ + 1);
  stack_.resize(capacity_ + 1);
  // Values alive at once: at most one a leaf.
  const std::size_t buffers = capacity_ / 2 + 2;
  buffers_.reset(new (kCacheLine) T[buffers * kBlockRows<T>]);
  free_buffers_.resize(buffers);
  for (std::size_t i = 0; i < buffers; ++i) {
    free_buffers_[i] = static_cast<std::int32_t>(buffers - 1 - i);
  }
  free_count_ = buffers;
}

template <typename T>
void Program<T>::bind(Call& call, int index, const Value& value) {
  call.scalar[index] = value.scalar;
  call.operand[index] = value.is_scalar() ? &call.scalar[index] : value.data;
  call.moves[index] = value.moves ? ~std::size_t{0} : 0;
}

template <typename T>
void Program<T>::release(const Value& value) {
  if (value.buffer >= 0) free_buffers_[free_count_++] = value.buffer;
}

template <typename T>
auto Program<T>::emit(BlockKernel<T> kernel, const Value& a, const Value& b, const Value& c)
    -> Value {
  Call& call = calls_[call_count_++];
  call.kernel = kernel;
  bind(call, 0, a);
  bind(call, 1, b);
  bind(call, 2, c);
  release(a);
  release(b);
  release(c);
  const std::int32_t buffer = free_buffers_[--free_count_];
  call.out = buffers_.get() + static_cast<std::size_t>(buffer) * kBlockRows<T>;
  call.out_moves = 0;
  return {call.out, 0, buffer, false};
}

template <typename T>
auto Program<T>::fold(BlockKernel<T> kernel, const Value& a, const Value& b) const -> Value {
  Value result;
  kernel(&result.scalar, &a.scalar, &b.scalar, nullptr, 1);
  return result;
}

// Makes an operation held back into a value.
template <typename T>
void Program<T>::settle(Entry& entry) {
  if (entry.basic < 0) return;
  const int form = entry.b.is_scalar() ? kFormVS : (entry.a.is_scalar() ? kFormSV : kFormVV);
  entry.a = emit(kernels_.binary[entry.basic][form], entry.a, entry.b, {});
  entry.basic = -1;
}

template <typename T>
void Program<T>::apply_basic(int op) {
  Entry& right = stack_[--depth_];
  Entry& left = stack_[depth_ - 1];
  if (left.basic >= 0 && right.basic >= 0) settle(right);
  if (left.basic >= 0 || right.basic >= 0) {
    const bool on_the_left = left.basic >= 0;
    const Entry& pair = on_the_left ? left : right;
    const Value& other = on_the_left ? right.a : left.a;
    const int outer = on_the_left ? op : outer_with_pair_on_the_right(op);
    const int form = pair.b.is_scalar() ? kFormVS : (pair.a.is_scalar() ? kFormSV : kFormVV);
    left.a = emit(kernels_.pair[pair.basic][form][outer][other.is_scalar() ? 1 : 0], pair.a, pair.b,
                  other);
    left.basic = -1;
    return;
  }
  if (left.a.is_scalar() && right.a.is_scalar()) {
    left.a = fold(kernels_.binary[op][kFormVV], left.a, right.a);
    return;
  }
  left.b = right.a;
  if (left.a.is_scalar() && is_commutative(op)) std::swap(left.a, left.b);
  left.basic = static_cast<std::int8_t>(op);
}

template <typename T>
void Program<T>::apply_power() {
  settle(stack_[--depth_]);
  Entry& base = stack_[depth_ - 1];
  const Value exponent = stack_[depth_].a;
  settle(base);
  const bool product =
      exponent.is_scalar() && is_product_power(static_cast<double>(exponent.scalar));
  if (base.a.is_scalar() && exponent.is_scalar()) {
    base.a = fold(product ? kernels_.integer_power : kernels_.power[kFormVV], base.a, exponent);
  } else if (product && exponent.scalar == T{2}) {
    base.b = base.a;
    base.b.buffer = -1;  // the same buffer: given back once
    base.basic = kMul;
  } else if (product) {
    base.a = emit(kernels_.integer_power, base.a, exponent, {});
  } else {
    const int form = exponent.is_scalar() ? kFormVS : (base.a.is_scalar() ? kFormSV : kFormVV);
    base.a = emit(kernels_.power[form], base.a, exponent, {});
  }
}

template <typename T>
void Program<T>::apply_function(Op op) {
  Entry& entry = stack_[depth_ - 1];
  settle(entry);
  const BlockKernel<T> kernel = kernels_.function[function_index(op)];
  if (entry.a.is_scalar()) {
    entry.a = fold(kernel, entry.a, {});
  } else if (op == Op::neg) {  // -x is x * -1, zeros and infinities included
    entry.b = {};
    entry.b.scalar = T{-1};
    entry.basic = kMul;
  } else {
    entry.a = emit(kernel, entry.a, {}, {});
  }
}

template <typename T>
void Program<T>::translate(const Expression& formula, std::span<const T* const> columns, T* out,
                           Result result) {
  reserve(formula.size());
  call_count_ = 0;
  depth_ = 0;
  for (const Node& node : formula.nodes()) {
    if (node.op == Op::variable) {
      Entry& entry = stack_[depth_++];
      entry.a = {columns[node.variable], 0, -1, true};
      entry.basic = -1;
    } else if (node.op == Op::constant) {
      Entry& entry = stack_[depth_++];
      entry.a = {nullptr, static_cast<T>(node.value), -1, false};
      entry.basic = -1;
    } else if (node.op < Op::pow) {
      apply_basic(basic_index(node.op));
    } else if (node.op == Op::pow) {
      apply_power();
    } else {
      apply_function(node.op);
    }
  }
  Entry& root = stack_[0];
  settle(root);
  if (root.a.buffer < 0) {  // a leaf or a constant
    root.a = emit(root.a.is_scalar() ? kernels_.fill : kernels_.copy, root.a, {}, {});
  }
  release(root.a);
  Call& last = calls_[call_count_ - 1];
  last.out = out;
  last.out_moves = result == Result::rows ? ~std::size_t{0} : 0;
}

template <typename T>
void Program<T>::run(std::size_t row, std::size_t n) const {
  const Call* const end = calls_.data() + call_count_;
  for (const Call* call = calls_.data(); call != end; ++call) {
    call->kernel(call->out + (row & call->out_moves), call->operand[0] + (row & call->moves[0]),
                 call->operand[1] + (row & call->moves[1]),
                 call->operand[2] + (row & call->moves[2]), n);
  }
}

template class Program<double>;
template class Program<float>;

}  // namespace tribench
