// SPDX-License-Identifier: MIT
//
// Machine code for the loops of a compiled formula. Part of compile.hpp.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "algorithms/expression/compile_plan.hpp"
#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/vector/level.hpp"

namespace tribench::compile {

// operands[k]: where operand k of the plan starts in this block; scalars: the values of the plan's
// scalars, then those of `extra_scalars`; bytes: of the rows, a multiple of the vector's. Writes
// `bytes` bytes from out on.
using Loop = void (*)(const void* const* operands, const void* scalars, void* out,
                      std::size_t bytes);

// Memory that holds code; executable and read-only. Shared by the loops of one formula.
class CodeMemory {
 public:
  virtual ~CodeMemory() = default;
};

struct Loops {
  std::unique_ptr<CodeMemory> memory;  // null where no code could be generated
  std::vector<Loop> of_step;           // null for steps that are not regions
};

// What the code wants behind the plan's scalars.
template <typename T>
std::span<const T> extra_scalars();
template <>
std::span<const double> extra_scalars<double>();
template <>
std::span<const float> extra_scalars<float>();

// Code for every region of the plan; scalars are of type T.
template <typename T>
Loops generate_loops(const Expression& formula, const Plan& plan, VectorLevel level);

}  // namespace tribench::compile
