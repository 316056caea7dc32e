// SPDX-License-Identifier: MIT
//
// How a formula is cut into pieces for compiling: scalars (subtrees of constants alone), regions of
// arithmetic that become loops, and functions that the block kernels do in between. Part of
// compile.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "algorithms/expression/expression.hpp"

namespace tribench::compile {

// What a node's value is while the code runs.
enum class Place : std::uint8_t {
  scalar,    // depends on constants alone: computed once per call
  column,    // an input, read in place
  buffer,    // the result of a kernel, one block of rows
  computed,  // in a register, within a region
};

struct NodePlan {
  Place place = Place::computed;
  std::uint32_t index = 0;      // of the scalar, or of the operand: inputs first, then buffers
  std::uint16_t registers = 1;  // needed at once (Sethi and Ullman 1970)
};

// One thing to do for each block, in this order.
struct Step {
  enum class Kind : std::uint8_t {
    region,    // arithmetic of the subtree at `node`, into `out`
    function,  // op(operand), into `out`
    power,     // operand ^ exponent
  };
  Kind kind = Kind::region;
  std::size_t node = 0;
  std::uint32_t out = 0;  // operand number of the buffer; kResult for the result
};
inline constexpr std::uint32_t kResult = 0xffffffff;

struct Plan {
  std::vector<NodePlan> nodes;  // of each node of the tape
  std::vector<Step> steps;
  std::vector<std::size_t> scalars;    // nodes that are scalars, children before parents
  std::vector<std::uint16_t> columns;  // the inputs used, by operand number
  std::uint32_t operands = 0;          // inputs and buffers
};

// Whether ^ at node i is a product of squares: its exponent is a constant with a whole value.
bool is_whole_power(const Expression& formula, std::size_t i);

Plan make_plan(const Expression& formula);

}  // namespace tribench::compile
