// SPDX-License-Identifier: MIT
//
// A tape translated for the block interpreter: a list of kernel calls whose operands are columns
// (read in place), scalars, or buffers of one block. Part of evaluate.hpp, which is what others
// use.
//
// An operation whose operands are ready is held back until its parent is seen, so that both run as
// one pass: a * b + c, c - x / 2, (x - y)^2 ... The two roundings remain; only the way through
// memory is saved. Operations on constants alone are done once, by the same kernels.
//
// Three steps, each without branches that depend on the formula (call_forms.hpp says why): leaves
// become operands; a table decides for every operation whether it is held back or calls a kernel;
// every call finds its operands. The last runs together with the first block of rows, where most of
// it hides behind the arithmetic.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "algorithms/expression/call_forms.hpp"
#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/leaves.hpp"
#include "algorithms/expression/vector/level.hpp"

namespace tribench {

// Rows a block: 2 KiB (double) or 4 KiB (float) a column, so that a dozen columns and buffers share
// the first-level cache. Shorter blocks of floats spend their time on calls.
template <typename T>
inline constexpr std::size_t kBlockRows = sizeof(T) == sizeof(double) ? 256 : 1024;

template <typename T>
class Program {
 public:
  explicit Program(VectorLevel level)
      : kernels_(kernel_table<T>(level)),
        forms_(call_forms<T>(level)),
        take_leaves_(leaf_reader<T>(level)) {}

  // Translates `formula`; column j starts at columns[j] and the result is written from `out` on.
  // where result_is_block, `out` holds one block that every block of rows overwrites.
  enum class Result { rows, block };
  void translate(const Expression& formula, std::span<const T* const> columns, T* out,
                 Result result);

  // Rows [row, row + n), n <= kBlockRows. The first run after a translation must be of row 0.
  void run(std::size_t row, std::size_t n);

 private:
  // A call before its operands are known.
  struct Planned {
    std::uint32_t node;
    std::uint32_t call;  // number in forms_
  };
  struct Call {
    BlockKernel<T> kernel;
    T* out;
    const T* operand[3];
  };

  void reserve(std::size_t nodes);
  void take_leaves(std::span<const Node> tape, std::span<const T* const> columns);
  void decide(std::span<const Node> tape);
  void decide_special(std::span<const Node> tape, std::size_t node);
  void decide_power(std::size_t node, std::size_t base, std::size_t exponent);
  void fold(BlockKernel<T> kernel, std::size_t node, std::size_t left, std::size_t right);
  void settle(std::size_t node);
  void plan(std::size_t node, int call) {
    planned_[planned_count_++] = {static_cast<std::uint32_t>(node),
                                  static_cast<std::uint32_t>(call)};
  }
  void bind_and_run(std::size_t n);
  void run_leaf(std::size_t row, std::size_t n) const;
  const T* at_row(const T* operand, std::size_t row) const;

  struct FreeBlocks {
    void operator()(T* p) const;
  };

  const KernelTable<T>& kernels_;
  const CallForms<T>& forms_;
  const LeafReader<T> take_leaves_;
  std::span<const Node> tape_;
  T* out_ = nullptr;
  std::size_t out_moves_ = 0;  // all ones where the result advances with the row, else 0

  // Of each node, one unused entry in front and kLeavesAtOnce behind.
  std::vector<std::uint8_t> kinds_;
  std::vector<const T*> values_;
  std::vector<std::uint32_t> operations_;  // nodes that are no leaves
  std::vector<Planned> planned_;
  std::size_t planned_count_ = 0;
  std::vector<Call> calls_;
  std::vector<std::int32_t> owners_;  // node whose value is in buffer k, three entries in front
  // Scalars, one a node (of what is no scalar: anything), and behind them the buffers.
  std::unique_ptr<T[], FreeBlocks> memory_;
  std::size_t memory_size_ = 0;
  T* scalars_ = nullptr;
  T* buffers_ = nullptr;
  std::size_t capacity_ = 0;  // nodes provided for
};

extern template class Program<double>;
extern template class Program<float>;

}  // namespace tribench
