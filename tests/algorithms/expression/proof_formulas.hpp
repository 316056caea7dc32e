// SPDX-License-Identifier: MIT
//
// Random formulas for the tests of bounds, proofs and canonical forms.
#pragma once

#include <span>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/expression.hpp"
#include "foundation/random.hpp"

namespace tribench::testing {

struct FormulaKind {
  std::size_t inputs = 2;
  std::size_t max_operations = 12;
  bool whole_constants = false;  // small whole numbers, else N(0, 3) rounded to three digits
};

// Every operation of the grammar occurs; operands repeat often enough for cancellations.
Expression random_formula(RandomStream& random, const FormulaKind& kind);

// Whether the formula and all its subformulas evaluate to finite numbers.
bool is_finite_throughout(Evaluator& evaluator, const Expression& formula,
                          std::span<const double> point);
// Whether some subformula exceeds 1e60 in size or is not finite where its operands are ordinary:
// then the order of products matters.
bool overflows(Evaluator& evaluator, const Expression& formula, std::span<const double> point);

}  // namespace tribench::testing
