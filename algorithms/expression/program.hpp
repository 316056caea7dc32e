// SPDX-License-Identifier: MIT
//
// A tape translated for the block interpreter: a list of kernel calls whose operands are columns
// (read in place), scalars, or buffers of one block. Part of evaluate.hpp, which is what others
// use.
//
// An operation whose operands are ready is held back until its parent is seen, so that both run as
// one pass: a * b + c, c - x / 2, (x - y)^2 ... The two roundings remain; only the way through
// memory is saved. Operations on constants alone are done once, by the same kernels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/vector/kernels.hpp"

namespace tribench {

// Rows a block: 2 KiB (double) or 4 KiB (float) a column, so that a dozen columns and buffers share
// the first-level cache. Shorter blocks of floats spend their time on calls.
template <typename T>
inline constexpr std::size_t kBlockRows = sizeof(T) == sizeof(double) ? 256 : 1024;

template <typename T>
class Program {
 public:
  explicit Program(const KernelTable<T>& kernels) : kernels_(kernels) {}

  // Translates `formula`; column j starts at columns[j] and the result is written from `out` on.
  // where result_is_block, `out` holds one block that every block of rows overwrites.
  enum class Result { rows, block };
  void translate(const Expression& formula, std::span<const T* const> columns, T* out,
                 Result result);

  // Rows [row, row + n), n <= kBlockRows.
  void run(std::size_t row, std::size_t n) const;

 private:
  // A value that exists: in a column, a buffer or a scalar.
  struct Value {
    const T* data = nullptr;  // null: the scalar
    T scalar = 0;
    std::int32_t buffer = -1;  // to be given back after its last use
    bool moves = false;        // data advances with the row: a column
    bool is_scalar() const { return data == nullptr; }
  };
  // Operand of an operation not yet seen: a value, or an operation held back.
  struct Entry {
    Value a;
    Value b;
    std::int8_t basic = -1;  // 0..3: a (+ - * /) b is held back; -1: a is the value
  };
  struct Call {
    BlockKernel<T> kernel;
    T* out;
    const T* operand[3];
    T scalar[3];
    // All ones where the pointer advances with the row, else 0.
    std::size_t moves[3];
    std::size_t out_moves;
  };

  void apply_basic(int op);
  void apply_power();
  void apply_function(Op op);
  void settle(Entry& entry);
  Value emit(BlockKernel<T> kernel, const Value& a, const Value& b, const Value& c);
  Value fold(BlockKernel<T> kernel, const Value& a, const Value& b) const;
  void bind(Call& call, int index, const Value& value);
  void release(const Value& value);
  void reserve(std::size_t nodes);

  struct FreeBlocks {
    void operator()(T* p) const;
  };

  const KernelTable<T>& kernels_;
  std::vector<Call> calls_;
  std::size_t call_count_ = 0;
  std::vector<Entry> stack_;
  std::size_t depth_ = 0;
  std::unique_ptr<T[], FreeBlocks> buffers_;
  std::vector<std::int32_t> free_buffers_;
  std::size_t free_count_ = 0;
  std::size_t capacity_ = 0;  // nodes provided for
};

extern template class Program<double>;
extern template class Program<float>;

}  // namespace tribench
