// SPDX-License-Identifier: MIT
//
// Formulas from bytes: every input is one, so that no mutation is lost to a parser.
#pragma once

#include "algorithms/expression/expression.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace tribench::fuzz {

inline constexpr std::size_t kFormulaInputs = 3;
inline constexpr std::size_t kMaxFormulaNodes = 40;

// Postfix: a byte is an operation where its operands are there, a leaf where not; what is left on
// the stack is added up.
Expression formula_from(Decisions& decisions);

}  // namespace tribench::fuzz
