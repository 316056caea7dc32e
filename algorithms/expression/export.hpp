// SPDX-License-Identifier: MIT
//
// A formula as code for a controller (C), a notebook (Python with NumPy, SymPy), MATLAB, or as
// LaTeX for a paper. What is exported is exactly what was judged: the same operations in the same
// order, integer powers as the same products, every constant to its last bit, nothing simplified.
//
// C, Python and MATLAB compute one operation a statement, so that no compiler and no operator
// precedence can reorder them: with + - * / and integer powers the values are the evaluator's to
// the last bit; exp, log, sin, cos, tanh, atan and other powers are those of the target's library
// (a few units in the last place apart). SymPy reorders sums as it likes. MATLAB's square root and
// logarithm of a negative number are NaN here, not complex.
//
// An input named sgn_X is no argument of the code: it is computed from X as the judge does. Beside
// a box that has sgn_X and no X it is an argument like any other.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/input_box.hpp"

namespace tribench {

enum class CodeForm { c, python, latex, sympy, matlab };

// "c", "python", ...; throws Error (bad_input) with the nearest name.
CodeForm find_code_form(std::string_view name);
const std::vector<std::string>& code_form_names();

struct ExportOptions {
  std::string function = "friction";
  // Where the formula was judged; its names come first among the arguments, in its order.
  std::optional<NamedBox> box;
  int digits = 0;  // of constants in LaTeX; 0: all
};

// The code's arguments in their order, each as it is called in the code.
std::vector<std::string> export_arguments(const Expression& formula,
                                          std::span<const std::string> names,
                                          const ExportOptions& options = {});

// names[i] is column i. A name that a language reserves gets a trailing underscore
// (reserved_words.hpp). Throws Error (bad_input) where a name is no formula's
// (foundation/formula_name.hpp) or the function's name no identifier.
std::string export_code(const Expression& formula, std::span<const std::string> names,
                        CodeForm form, const ExportOptions& options = {});

}  // namespace tribench
