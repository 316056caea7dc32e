// SPDX-License-Identifier: MIT
#include "algorithms/expression/code_generator.hpp"

#if defined(__x86_64__)
#define XBYAK_NO_OP_NAMES
#include <xbyak/xbyak.h>
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <deque>
#include <utility>

#include "algorithms/expression/vector/kernels.hpp"

namespace tribench::compile {

#if defined(__x86_64__)
namespace {

using Xbyak::Address;
using Xbyak::Operand;
using Xbyak::Reg64;
using Xbyak::Xmm;

constexpr std::size_t kPointers = 9;     // registers for operands
constexpr std::size_t kCallerSaved = 3;  // the first of them
constexpr int kSpares = 5;               // vector registers kept from the register stack, AVX-512

// What stands behind the plan's scalars.
enum Extra : std::size_t { kSignBit, kAbsBits, kOne, kShift, kTopBit, kSignificand, kUnit };

// The instructions of a loop over rows, for one width of registers and one element.
class RowAssembler : public Xbyak::CodeGenerator, public CodeMemory {
 public:
  RowAssembler(std::size_t code_bytes, VectorLevel level, std::size_t element_bytes)
      : CodeGenerator(code_bytes, Xbyak::DontSetProtectRWE),
        wide_(level == VectorLevel::avx512),
        double_(element_bytes == 8) {}

  // Two registers less than there are at AVX2: one for scalars, one for what a power needs.
  int stack_registers() const { return wide_ ? 32 - kSpares : 15; }

 protected:
  Reg64 pointer(std::size_t k) const {
    const std::array<Reg64, kPointers> registers = {r8, r9, r10, rbx, rbp, r12, r13, r14, r15};
    return registers[k];
  }
  Xmm vector(int index) const {
    if (wide_) return Xbyak::Zmm(index);
    return Xbyak::Ymm(index);
  }
  Xmm spare(int k) const { return vector((wide_ ? 31 : 15) - k); }
  int offset(std::size_t scalar) const { return static_cast<int>(scalar * (double_ ? 8 : 4)); }
  void broadcast(const Xmm& to, std::size_t scalar) {
    const Address at = ptr[rsi + offset(scalar)];
    if (double_) {
      wide_ ? vbroadcastsd(Xbyak::Zmm(to.getIdx()), at) : vbroadcastsd(Xbyak::Ymm(to.getIdx()), at);
    } else {
      vbroadcastss(to, at);
    }
  }
  // Calls f with a scalar as an operand: in memory where an instruction can spread it.
  template <typename F>
  void with_scalar(std::size_t scalar, F f) {
    if (wide_) {
      f(ptr_b[rsi + offset(scalar)]);
    } else {
      broadcast(spare(0), scalar);
      f(spare(0));
    }
  }

  void arithmetic(Op op, const Xmm& to, const Xmm& a, const Operand& b) {
    switch (op) {
      case Op::add:
        return double_ ? vaddpd(to, a, b) : vaddps(to, a, b);
      case Op::sub:
        return double_ ? vsubpd(to, a, b) : vsubps(to, a, b);
      case Op::mul:
        return double_ ? vmulpd(to, a, b) : vmulps(to, a, b);
      default:
        return double_ ? vdivpd(to, a, b) : vdivps(to, a, b);
    }
  }

  void square_root(const Xmm& to, const Xmm& a) { double_ ? vsqrtpd(to, a) : vsqrtps(to, a); }
  void flip_bits(const Xmm& to, const Operand& bits) {
    double_ ? vxorpd(to, to, bits) : vxorps(to, to, bits);
  }
  void keep_bits(const Xmm& to, const Operand& bits) {
    double_ ? vandpd(to, to, bits) : vandps(to, to, bits);
  }
  void reciprocal(const Xmm& to, const Xmm& a) {  // to 14 bits
    double_ ? vrcp14pd(to, a) : vrcp14ps(to, a);
  }
  void fused(const Xmm& to, const Xmm& a, const Xmm& b) {  // to = a b + to
    double_ ? vfmadd231pd(to, a, b) : vfmadd231ps(to, a, b);
  }
  void fused_into_factor(const Xmm& to, const Xmm& a, const Xmm& b) {  // to = a to + b
    double_ ? vfmadd213pd(to, a, b) : vfmadd213ps(to, a, b);
  }
  void fused_negated(const Xmm& to, const Xmm& a, const Xmm& b) {  // to = to - a b
    double_ ? vfnmadd231pd(to, a, b) : vfnmadd231ps(to, a, b);
  }

  bool wide_;
  bool double_;
};

// The loop of a region of a formula.
class Generator : public RowAssembler {
 public:
  Generator(const Expression& formula, const Plan& plan, VectorLevel level,
            std::size_t element_bytes, std::size_t code_bytes)
      : RowAssembler(code_bytes, level, element_bytes),
        formula_(formula),
        plan_(plan),
        multiplies_(wide_ && divider_is_slow()) {}

  Loop loop(std::size_t root) {
    root_ = root;
    align(32);
    const auto entry = getCurr<Loop>();
    used_.clear();
    collect(root);
    std::sort(used_.begin(), used_.end());
    used_.erase(std::unique(used_.begin(), used_.end()), used_.end());
    const std::size_t saved = std::min(used_.size(), kPointers);
    for (std::size_t k = kCallerSaved; k < saved; ++k) push(pointer(k));
    for (std::size_t k = 0; k < saved; ++k) {
      mov(pointer(k), ptr[rdi + 8 * static_cast<std::size_t>(used_[k])]);
    }
    if (multiplies_) broadcast(spare(4), extra(kOne));
    xor_(eax, eax);
    Xbyak::Label next;
    align(16);
    L(next);
    emit(root, 0);
    vmovups(ptr[rdx + rax], vector(0));
    add(rax, wide_ ? 64 : 32);
    cmp(rax, rcx);
    jb(next, T_NEAR);
    for (std::size_t k = saved; k > kCallerSaved; --k) pop(pointer(k - 1));
    vzeroupper();
    ret();
    emit_slow_divisions();
    return entry;
  }

 private:
  struct SlowDivision {
    Xbyak::Label begin;
    Xbyak::Label done;
    int result;
    int a;
    int b;
  };

  std::size_t extra(Extra which) const { return plan_.scalars.size() + which; }

  // Whether the value is there before the region runs. Its root is what it computes.
  bool is_leaf(std::size_t i) const {
    const Place place = plan_.nodes[i].place;
    return place == Place::column || place == Place::scalar ||
           (place == Place::buffer && i != root_);
  }
  bool is_scalar(std::size_t i) const { return plan_.nodes[i].place == Place::scalar; }

  // The operands that the region reads, so that each has its pointer in a register.
  void collect(std::size_t i) {
    if (is_scalar(i)) return;
    if (is_leaf(i)) {
      used_.push_back(plan_.nodes[i].index);
      return;
    }
    collect(formula_.last_child(i));
    if (arity(formula_.node(i).op) == 2) collect(formula_.left_child(i));
  }

  // The rows of an operand; one scratch register serves those that have none of their own.
  Address rows_of(std::size_t i) {
    const std::uint32_t operand = plan_.nodes[i].index;
    const auto at = static_cast<std::size_t>(std::lower_bound(used_.begin(), used_.end(), operand) -
                                             used_.begin());
    if (at < kPointers) return ptr[pointer(at) + rax];
    mov(r11, ptr[rdi + 8 * static_cast<std::size_t>(operand)]);
    return ptr[r11 + rax];
  }
  template <typename F>
  void with_leaf(std::size_t i, F f) {
    if (is_scalar(i)) {
      with_scalar(plan_.nodes[i].index, f);
    } else {
      f(rows_of(i));
    }
  }

  // The value of node i into vector r; registers from r on are free.
  void emit(std::size_t i, int r) {
    if (is_leaf(i)) {
      if (is_scalar(i)) {
        broadcast(vector(r), plan_.nodes[i].index);
      } else {
        vmovups(vector(r), rows_of(i));
      }
      return;
    }
    const Op op = formula_.node(i).op;
    if (op == Op::pow) return emit_power(i, r);
    if (arity(op) == 2) return emit_binary(op, i, r);
    emit(formula_.last_child(i), r);
    if (op == Op::sqrt) {
      square_root(vector(r), vector(r));
    } else if (op == Op::neg) {
      with_scalar(extra(kSignBit), [&](const Operand& bits) { flip_bits(vector(r), bits); });
    } else {
      with_scalar(extra(kAbsBits), [&](const Operand& bits) { keep_bits(vector(r), bits); });
    }
  }

  void emit_binary(Op op, std::size_t i, int r) {
    const std::size_t a = formula_.left_child(i);
    const std::size_t b = formula_.last_child(i);
    const bool multiplies = op == Op::div && multiplies_;
    if (is_leaf(b) && !multiplies) {
      emit(a, r);
      return with_leaf(b, [&](const Operand& x) { arithmetic(op, vector(r), vector(r), x); });
    }
    if (is_leaf(a) && (op == Op::add || op == Op::mul)) {
      emit(b, r);
      return with_leaf(a, [&](const Operand& x) { arithmetic(op, vector(r), vector(r), x); });
    }
    // The side that needs more registers first; a leaf last.
    const bool left_first = plan_.nodes[a].registers >= plan_.nodes[b].registers && !is_leaf(a);
    emit(left_first ? a : b, r);
    emit(left_first ? b : a, r + 1);
    const int in_a = left_first ? r : r + 1;
    const int in_b = left_first ? r + 1 : r;
    if (multiplies && divisions_++ % 3 != 0) return emit_quotient(r, in_a, in_b);
    arithmetic(op, vector(r), vector(in_a), vector(in_b));
  }

  // As the block kernel: squares of the base, multiplied together where the exponent has a bit.
  void emit_power(std::size_t i, int r) {
    const int exponent = static_cast<int>(formula_.node(formula_.last_child(i)).value);
    const auto size = static_cast<unsigned>(exponent < 0 ? -exponent : exponent);
    if (size == 0) return broadcast(vector(r), extra(kOne));
    emit(formula_.left_child(i), r);
    int result = r;
    bool started = false;
    for (unsigned m = size; m != 0; m >>= 1) {
      if ((m & 1U) != 0 && started) {
        arithmetic(Op::mul, vector(r + 1), vector(r + 1), vector(r));
      } else if ((m & 1U) != 0 && m != 1) {
        vmovaps(vector(r + 1), vector(r));
        result = r + 1;
        started = true;
      }
      if (m != 1) arithmetic(Op::mul, vector(r), vector(r), vector(r));
    }
    if (exponent < 0) {
      broadcast(spare(0), extra(kOne));
      arithmetic(Op::div, vector(r), spare(0), vector(result));
    } else if (result != r) {
      vmovaps(vector(r), vector(result));
    }
  }

  // divide_by_multiplying of foundation/elementary/lanes.hpp.
  void emit_quotient(int result, int in_a, int in_b) {
    const Xmm a = vector(in_a);
    const Xmm b = vector(in_b);
    const Xmm t = spare(0);
    const Xmm e = spare(1);
    const Xmm y = spare(2);
    const Xmm q = spare(3);
    const Xmm one = spare(4);
    slow_.emplace_back();
    slow_.back().result = result;
    slow_.back().a = in_a;
    slow_.back().b = in_b;
    jump_if_unusual(a, b, t, e, slow_.back().begin);
    reciprocal(y, b);
    vmovaps(e, one);
    fused_negated(e, b, y);
    if (double_) {
      vmovaps(t, e);
      fused(t, e, e);
      fused_into_factor(y, t, y);
      vmovaps(e, one);
      fused_negated(e, b, y);
    }
    fused_into_factor(y, e, y);
    vmovaps(e, one);
    fused_negated(e, b, y);
    fused_into_factor(y, e, y);
    arithmetic(Op::mul, q, a, y);
    vmovaps(t, a);
    fused_negated(t, b, q);
    fused_into_factor(t, y, q);
    vmovaps(vector(result), t);
    L(slow_.back().done);
  }

  void jump_if_unusual(const Xmm& a, const Xmm& b, const Xmm& t, const Xmm& e,
                       Xbyak::Label& where) {
    const auto scalar = [&](Extra which) { return ptr_b[rsi + offset(extra(which))]; };
    if (double_) {
      vpaddq(t, a, scalar(kShift));
      vpaddq(e, b, scalar(kShift));
      vpandq(t, t, e);
      vptestnmq(k1, t, scalar(kTopBit));
      vpaddq(e, b, scalar(kUnit));
      vptestnmq(k2, e, scalar(kSignificand));
      kortestb(k1, k2);
    } else {
      vpaddd(t, a, scalar(kShift));
      vpaddd(e, b, scalar(kShift));
      vpandd(t, t, e);
      vptestnmd(k1, t, scalar(kTopBit));
      vpaddd(e, b, scalar(kUnit));
      vptestnmd(k2, e, scalar(kSignificand));
      kortestw(k1, k2);
    }
    jnz(where, T_NEAR);
  }

  void emit_slow_divisions() {
    for (SlowDivision& division : slow_) {
      L(division.begin);
      arithmetic(Op::div, vector(division.result), vector(division.a), vector(division.b));
      jmp(division.done, T_NEAR);
    }
    slow_.clear();
  }

  const Expression& formula_;
  const Plan& plan_;
  bool multiplies_;
  std::size_t root_ = 0;
  unsigned divisions_ = 0;
  std::vector<std::uint32_t> used_;
  std::deque<SlowDivision> slow_;
};

// More than the code of any formula of this shape takes.
std::size_t code_bytes(const Expression& formula, const Plan& plan) {
  std::size_t bytes = 1024 + 256 * plan.steps.size();
  for (const Node& node : formula.nodes()) {
    bytes += node.op == Op::div || node.op == Op::pow ? 320 : 24;
  }
  return (bytes + 4095) / 4096 * 4096;
}

}  // namespace

template <>
std::span<const double> extra_scalars<double>() {
  static constexpr auto kBits = [](std::uint64_t bits) { return std::bit_cast<double>(bits); };
  static constexpr std::array kExtras = {-0.0,
                                         kBits(0x7fffffffffffffff),
                                         1.0,
                                         kBits(std::uint64_t{512} << 52),
                                         kBits(std::uint64_t{1} << 62),
                                         kBits(0x000fffffffffffff),
                                         kBits(1)};
  return kExtras;
}
template <>
std::span<const float> extra_scalars<float>() {
  static constexpr auto kBits = [](std::uint32_t bits) { return std::bit_cast<float>(bits); };
  static constexpr std::array kExtras = {
      -0.0F,           kBits(0x7fffffff), 1.0F,    kBits(64U << 23),
      kBits(1U << 30), kBits(0x007fffff), kBits(1)};
  return kExtras;
}

template <typename T>
Loops generate_loops(const Expression& formula, const Plan& plan, VectorLevel level) {
  Loops loops;
  if (level == VectorLevel::baseline) return loops;
  try {
    auto code =
        std::make_unique<Generator>(formula, plan, level, sizeof(T), code_bytes(formula, plan));
    for (const Step& step : plan.steps) {
      const bool is_region = step.kind == Step::Kind::region;
      if (is_region && plan.nodes[step.node].registers > code->stack_registers()) return {};
      loops.of_step.push_back(is_region ? code->loop(step.node) : nullptr);
    }
    code->setProtectModeRE();
    loops.memory = std::move(code);
    return loops;
  } catch (const Xbyak::Error&) {  // no memory may be made executable here, or too long
    return {};
  }
}

#else

template <typename T>
Loops generate_loops(const Expression&, const Plan&, VectorLevel) {
  return {};
}

#endif

template Loops generate_loops<double>(const Expression&, const Plan&, VectorLevel);
template Loops generate_loops<float>(const Expression&, const Plan&, VectorLevel);

}  // namespace tribench::compile
