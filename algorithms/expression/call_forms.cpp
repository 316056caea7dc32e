// SPDX-License-Identifier: MIT
#include "algorithms/expression/call_forms.hpp"

#include "algorithms/expression/vector/level.hpp"

namespace tribench {
namespace {

constexpr int kAdd = 0;
constexpr int kSub = 1;
constexpr int kMul = 2;
static_assert(static_cast<int>(Op::div) - static_cast<int>(Op::add) == kBasicOps - 1);
static_assert(static_cast<int>(Op::atan) - static_cast<int>(Op::neg) == kFunctions - 1);

constexpr bool is_commutative(int basic) { return basic == kAdd || basic == kMul; }

// The outer form of `c op (pair)`.
constexpr int outer_with_pair_on_the_right(int basic) {
  if (is_commutative(basic)) return basic;
  return basic == kSub ? kOuterSubFrom : kOuterDivInto;
}

constexpr Decision kSpecial{.is_special = 1};

constexpr Decision value(ValueKind kind) { return {.kind = kind}; }
constexpr Decision held(int op, int form) {
  return {.kind = static_cast<std::uint8_t>(kHeldValue + op * kFormCount + form)};
}
constexpr Decision called(int call, bool settles_right) {
  return {.call = static_cast<std::uint16_t>(call),
          .kind = kBufferValue,
          .settles_right = settles_right ? std::uint8_t{1} : std::uint8_t{0},
          .calls = 1};
}

constexpr Decision decide_basic(int op, int left, int right) {
  const bool left_is_held = left >= kHeldValue;
  const bool right_is_held = right >= kHeldValue;
  if (left_is_held) {
    return called(pair_call(left, op, false, right == kScalarValue), right_is_held);
  }
  if (right_is_held) {
    return called(pair_call(right, op, true, left == kScalarValue), false);
  }
  if (left == kScalarValue && right == kScalarValue) return value(kScalarValue);
  const int form = right == kScalarValue ? kFormVS : (left == kScalarValue ? kFormSV : kFormVV);
  return held(op, form);
}

constexpr Decision decide_function(int function, int argument) {
  if (argument == kScalarValue) return kSpecial;
  return called(kFunctionCall + function, argument >= kHeldValue);
}

constexpr std::array<Decision, kDecisions> make_decisions() {
  std::array<Decision, kDecisions> table{};
  for (int op = static_cast<int>(Op::add); op < kOpCount; ++op) {
    for (int left = 0; left < 16; ++left) {
      for (int right = 0; right < 16; ++right) {
        Decision& entry = table[decision_index(static_cast<Op>(op), static_cast<unsigned>(left),
                                               static_cast<unsigned>(right))];
        if (op < static_cast<int>(Op::pow)) {
          entry = decide_basic(op - static_cast<int>(Op::add), left, right);
        } else if (op == static_cast<int>(Op::pow)) {
          entry = kSpecial;
        } else {
          entry = decide_function(op - static_cast<int>(Op::neg), right);
        }
      }
    }
  }
  return table;
}

// Operation and form of what is held back; a scalar on the left of a sum or product stands right.
struct Held {
  int op;
  int form;
  std::int8_t a_is_left;
  std::int8_t b_is_left;
};
constexpr Held held_of(int kind) {
  if (kind == kHeldSquare) return {kMul, kFormVV, -1, -1};
  const int op = (kind - kHeldValue) / kFormCount;
  const int form = (kind - kHeldValue) % kFormCount;
  if (form == kFormSV && is_commutative(op)) return {op, kFormVS, 0, -1};
  return {op, form, -1, 0};
}

template <typename T>
CallForms<T> make_call_forms(const KernelTable<T>& kernels) {
  CallForms<T> forms{};
  const auto at = [&](int call) -> CallForm<T>& { return forms[static_cast<std::size_t>(call)]; };
  for (int kind = kHeldValue; kind <= kHeldSquare; ++kind) {
    const Held held = held_of(kind);
    at(kind - kHeldValue) = {
        kernels.binary[held.op][held.form], 0, 0, 0, held.a_is_left, held.b_is_left};
    for (int op = 0; op < kBasicOps; ++op) {
      for (int scalar = 0; scalar < 2; ++scalar) {
        const auto& pairs = kernels.pair[held.op][held.form];
        const bool other_is_scalar = scalar == 1;
        at(pair_call(kind, op, false, other_is_scalar)) = {
            pairs[op][scalar], 1, -1, 0, held.a_is_left, held.b_is_left};
        at(pair_call(kind, op, true, other_is_scalar)) = {
            pairs[outer_with_pair_on_the_right(op)][scalar],
            1,
            0,
            -1,
            held.a_is_left,
            held.b_is_left};
      }
    }
  }
  for (int f = 0; f < kFunctions; ++f) at(kFunctionCall + f).kernel = kernels.function[f];
  for (int form = 0; form < kFormCount; ++form) {
    at(kPowerCall + form) = {kernels.power[form], 0, 0, 0, -1, 0};
  }
  at(kIntegerPowerCall) = {kernels.integer_power, 0, 0, 0, -1, 0};
  return forms;
}

}  // namespace

constinit const std::array<Decision, kDecisions> kDecisionTable = make_decisions();

template <typename T>
const CallForms<T>& call_forms(VectorLevel level) {
  static const std::array<CallForms<T>, 3> kForms = {
      make_call_forms(kernel_table<T>(VectorLevel::baseline)),
      make_call_forms(kernel_table<T>(VectorLevel::avx2)),
      make_call_forms(kernel_table<T>(VectorLevel::avx512))};
  return kForms[static_cast<std::size_t>(level)];
}

template const CallForms<double>& call_forms<double>(VectorLevel level);
template const CallForms<float>& call_forms<float>(VectorLevel level);

}  // namespace tribench
