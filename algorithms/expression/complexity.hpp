// SPDX-License-Identifier: MIT
//
// How large a formula is, by the two counts that every record carries.
//
// Source of `paper_complexity`: Scholl et al. 2025, section 5.1: operations (+ - * /), functions
// (exp, sqrt, abs, sgn, a power) and variable accesses count one each; constants and unary minus
// count nothing. Two of the paper's own figures are not this count of what it prints: its uDSR
// formula for joint 2 counts 35 (printed: 36; one term more or less survived the typesetting) and
// its symmetric model counts 13 (printed: 20, which is 13 plus the six parameters and one).
#pragma once

#include "algorithms/expression/expression.hpp"

namespace tribench {

int paper_complexity(const Expression& formula);

// Every node, constants and unary minus too.
inline int node_count(const Expression& formula) { return static_cast<int>(formula.size()); }

}  // namespace tribench
