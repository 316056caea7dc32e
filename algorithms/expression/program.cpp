// SPDX-License-Identifier: MIT
#include "algorithms/expression/program.hpp"

#include <algorithm>
#include <new>

#include "algorithms/expression/evaluate.hpp"

namespace tribench {
namespace {

constexpr std::align_val_t kCacheLine{64};
constexpr std::size_t kLine = 64;

// From one buffer to the next: not a multiple of 4 KiB, or a load from one waits for a store to the
// other (processors compare the lowest 12 bits of addresses first).
template <typename T>
constexpr std::size_t kStride = kBlockRows<T> + 3 * kLine / sizeof(T);

// Operands of a call: so many buffers can end with it.
constexpr std::size_t kMostOperands = 3;

std::size_t basic_index(Op op) {
  return static_cast<std::size_t>(op) - static_cast<std::size_t>(Op::add);
}
std::size_t function_index(Op op) {
  return static_cast<std::size_t>(op) - static_cast<std::size_t>(Op::neg);
}

}  // namespace

template <typename T>
void Program<T>::FreeBlocks::operator()(T* p) const {
  ::operator delete[](p, kCacheLine);
}

template <typename T>
void Program<T>::reserve(std::size_t nodes) {
  if (nodes <= capacity_) return;
  capacity_ = std::max<std::size_t>({2 * capacity_, nodes, 64});
  const std::size_t entries = capacity_ + 1 + kLeavesAtOnce;
  kinds_.resize(entries);
  operations_.resize(entries);
  planned_.resize(capacity_ + 2);
  calls_.resize(capacity_ + 1);
  // Values alive at once: at most one for two nodes.
  const std::size_t buffers = capacity_ / 2 + 2;
  owners_.assign(buffers + kMostOperands, -1);
  constexpr std::size_t kPerLine = kLine / sizeof(T);
  const std::size_t scalars = (entries / kPerLine + 1) * kPerLine;
  memory_size_ = scalars + buffers * kStride<T>;
  memory_.reset(new (kCacheLine) T[memory_size_]);
  memory_[0] = 0;
  scalars_ = memory_.get() + 1;
  buffers_ = memory_.get() + scalars;
  values_.assign(entries, memory_.get());
}

template <typename T>
void Program<T>::take_leaves(std::span<const Node> tape, std::span<const T* const> columns) {
  const T* const no_column = nullptr;
  const LeafLists<T> lists = {columns.empty() ? &no_column : columns.data(), scalars_,
                              values_.data() + 1, kinds_.data() + 1, operations_.data()};
  take_leaves_(tape, lists);
}

template <typename T>
void Program<T>::decide(std::span<const Node> tape) {
  std::uint8_t* const kinds = kinds_.data() + 1;
  T* const scalars = scalars_;
  Planned* next = planned_.data();
  for (const std::uint32_t* operation = operations_.data(); *operation < tape.size(); ++operation) {
    const std::size_t i = *operation;
    const std::size_t right = i - 1;
    const std::size_t left = right - tape[right].length;  // of a function: any node, or none
    const unsigned right_kind = kinds[right];
    const Decision& decision = kDecisionTable[decision_index(
        tape[i].op, kinds[static_cast<std::ptrdiff_t>(left)], right_kind)];
    if (decision.is_special != 0) {
      planned_count_ = static_cast<std::size_t>(next - planned_.data());
      decide_special(tape, i);
      next = planned_.data() + planned_count_;
      continue;
    }
    // The value if both are constants; else it is not looked at.
    const T x = scalars[static_cast<std::ptrdiff_t>(left)];
    const T y = scalars[right];
    const T folded[kBasicOps] = {x + y, x - y, x * y, x / y};
    scalars[i] = folded[basic_index(tape[i].op) % kBasicOps];
    *next = {static_cast<std::uint32_t>(right), right_kind - kHeldValue};
    next += decision.settles_right;
    *next = {static_cast<std::uint32_t>(i), decision.call};
    next += decision.calls;
    kinds[i] = decision.kind;
  }
  const std::size_t root = tape.size() - 1;
  *next = {static_cast<std::uint32_t>(root), kinds[root] - unsigned{kHeldValue}};
  next += kinds[root] >= kHeldValue ? 1 : 0;
  *next = {};  // looked up, never run
  planned_count_ = static_cast<std::size_t>(next - planned_.data());
}

// Makes an operation held back into a call of its own. It comes before the calls of later nodes:
// buffers are given back in the order of the tape.
template <typename T>
void Program<T>::settle(std::size_t node) {
  std::uint8_t& kind = kinds_[node + 1];
  if (kind < kHeldValue) return;
  const auto end = planned_.begin() + static_cast<std::ptrdiff_t>(planned_count_);
  const auto place =
      std::find_if(planned_.begin(), end, [&](const Planned& call) { return call.node > node; });
  std::copy_backward(place, end, end + 1);
  *place = {static_cast<std::uint32_t>(node), static_cast<std::uint32_t>(kind - kHeldValue)};
  planned_count_ += 1;
  kind = kBufferValue;
}

template <typename T>
void Program<T>::fold(BlockKernel<T> kernel, std::size_t node, std::size_t left,
                      std::size_t right) {
  kernel(scalars_ + node, scalars_ + left, scalars_ + right, nullptr, 1);
  kinds_[node + 1] = kScalarValue;
}

// Functions of constants, and powers.
template <typename T>
void Program<T>::decide_special(std::span<const Node> tape, std::size_t node) {
  const Op op = tape[node].op;
  const std::size_t right = node - 1;
  if (op == Op::pow) return decide_power(node, right - tape[right].length, right);
  fold(kernels_.function[function_index(op)], node, right, right);
}

template <typename T>
void Program<T>::decide_power(std::size_t node, std::size_t base, std::size_t exponent) {
  settle(base);
  settle(exponent);
  const T value = scalars_[exponent];
  const bool base_is_scalar = kinds_[base + 1] == kScalarValue;
  const bool exponent_is_scalar = kinds_[exponent + 1] == kScalarValue;
  const bool is_product = exponent_is_scalar && is_product_power(static_cast<double>(value));
  if (base_is_scalar && exponent_is_scalar) {
    return fold(is_product ? kernels_.integer_power : kernels_.power[kFormVV], node, base,
                exponent);
  }
  if (is_product && value == T{2}) {
    kinds_[node + 1] = kHeldSquare;
    return;
  }
  const int form = exponent_is_scalar ? kFormVS : (base_is_scalar ? kFormSV : kFormVV);
  plan(node, is_product ? kIntegerPowerCall : kPowerCall + form);
  kinds_[node + 1] = kBufferValue;
}

template <typename T>
void Program<T>::translate(const Expression& formula, std::span<const T* const> columns, T* out,
                           Result result) {
  tape_ = formula.nodes();
  reserve(tape_.size());
  out_ = out;
  out_moves_ = result == Result::rows ? ~std::size_t{0} : 0;
  take_leaves(tape_, columns);
  decide(tape_);
}

// Finds the operands of every call and runs it on the first block.
template <typename T>
void Program<T>::bind_and_run(std::size_t n) {
  const Node* const tape = tape_.data();
  const T** const values = values_.data() + 1;
  std::int32_t* owner = owners_.data() + kMostOperands;  // behind the last buffer in use
  Call* call = calls_.data();
  const Planned* const last = planned_.data() + planned_count_ - 1;
  // Which kernel comes next is known before the one in front of it is called: the processor, which
  // will have guessed wrong, learns so at once.
  BlockKernel<T> next = forms_[planned_.front().call].kernel;
  for (const Planned* planned = planned_.data(); planned <= last; ++planned, ++call) {
    const BlockKernel<T> kernel = next;
    next = forms_[planned[1].call].kernel;
    const auto node = static_cast<std::ptrdiff_t>(planned->node);
    const CallForm<T>& form = forms_[planned->call];
    const std::ptrdiff_t right_length = tape[node - 1].length;
    const std::ptrdiff_t inner = node - form.inner_is_child - (right_length & form.inner_is_left);
    const std::ptrdiff_t inner_length = tape[inner - 1].length;
    const T* const a = values[inner - 1 - (inner_length & form.a_is_left)];
    const T* const b = values[inner - 1 - (inner_length & form.b_is_left)];
    const T* const c = values[node - 1 - (right_length & form.other_is_left)];
    // Buffers of this subtree are the ones used last; they end here.
    const std::ptrdiff_t first = node + 1 - static_cast<std::ptrdiff_t>(tape[node].length);
    const int ended =
        (owner[-1] >= first ? 1 : 0) + (owner[-2] >= first ? 1 : 0) + (owner[-3] >= first ? 1 : 0);
    owner -= ended;
    T* const buffer =
        buffers_ + static_cast<std::size_t>(owner - owners_.data() - kMostOperands) * kStride<T>;
    *owner++ = static_cast<std::int32_t>(node);
    T* const out = planned == last ? out_ : buffer;
    values[node] = out;
    *call = {kernel, out, {a, b, c}};
    kernel(out, a, b, c, n);
  }
}

// Columns advance with the row; scalars and buffers, which share one piece of memory, do not.
template <typename T>
const T* Program<T>::at_row(const T* operand, std::size_t row) const {
  const std::size_t from_memory =
      reinterpret_cast<std::uintptr_t>(operand) - reinterpret_cast<std::uintptr_t>(memory_.get());
  return operand + (from_memory < memory_size_ * sizeof(T) ? 0 : row);
}

// A formula without a call: a column or a scalar.
template <typename T>
void Program<T>::run_leaf(std::size_t row, std::size_t n) const {
  const bool is_scalar = kinds_[tape_.size()] == kScalarValue;
  const BlockKernel<T> kernel = is_scalar ? kernels_.fill : kernels_.copy;
  kernel(out_ + (row & out_moves_), at_row(values_[tape_.size()], row), nullptr, nullptr, n);
}

template <typename T>
void Program<T>::run(std::size_t row, std::size_t n) {
  if (planned_count_ == 0) return run_leaf(row, n);
  if (row == 0) return bind_and_run(n);
  const Call* const last = calls_.data() + planned_count_ - 1;
  for (const Call* call = calls_.data(); call <= last; ++call) {
    T* const out = call == last ? out_ + (row & out_moves_) : call->out;
    call->kernel(out, at_row(call->operand[0], row), at_row(call->operand[1], row),
                 at_row(call->operand[2], row), n);
  }
}

template class Program<double>;
template class Program<float>;

}  // namespace tribench
