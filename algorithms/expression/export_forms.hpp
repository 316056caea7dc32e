// SPDX-License-Identifier: MIT
//
// What the writers of single languages share: export.cpp calls them, and who writes code with more
// in it than a formula (algorithms/states).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/expression/export.hpp"
#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/input_box.hpp"

namespace tribench {

// The arguments of the code, and where each column of the formula comes from.
struct CodeInputs {
  struct Argument {
    std::string name;       // in the formula
    std::string code_name;  // in the code
    std::optional<InputRange> range;
  };
  struct Column {
    std::string name;  // of the variable in the code
    std::size_t argument = 0;
    bool is_sign = false;  // the sign of its argument
    bool is_used = false;
  };
  std::vector<Argument> arguments;
  std::vector<Column> columns;  // by the formula's column

  std::string argument_list(std::string_view before_each = {}) const;  // "v, g"
};

struct CodeSource {
  const Expression& formula;
  std::string text;  // the formula, print form
  std::string function;
  const CodeInputs& inputs;
  int digits = 0;
};

// How a language writes one operation on operands that are names or literals.
struct Dialect {
  std::function<std::string(double)> literal;
  std::function<std::string(Op, std::string_view)> unary;
  std::function<std::string(Op, std::string_view, std::string_view)> binary;
  std::string declare;    // before a new name: "const double "
  std::string terminate;  // ";"
  std::string indent = "  ";
};

struct Statements {
  std::string text;    // one operation a line
  std::string result;  // the name or literal that holds the value
  std::size_t operations = 0;
};

// How C, Python and MATLAB write them; indented by two blanks.
Dialect c_dialect();
Dialect python_dialect();
Dialect matlab_dialect();

// The arguments of the code that a formula needs (export.hpp). Throws Error (bad_input) on a name
// that no formula can hold.
CodeInputs code_inputs(const Expression& formula, std::span<const std::string> names,
                       const ExportOptions& options);

// Throws Error (bad_input) where the name is no identifier or is reserved.
void require_function_name(const std::string& function);

// The lines that make the signs which the formula reads, in front of its statements.
std::string sign_lines(const CodeSource& source, const Dialect& dialect);
bool uses_sign(const CodeSource& source);

// "... Input box in which the formula was judged: ..." behind a comment's mark.
std::string ranges_comment(const CodeSource& source, std::string_view mark);

// Integer powers become the evaluator's products of squares (evaluate.hpp).
Statements write_statements(const CodeSource& source, const Dialect& dialect);

// Shortest text that reads back, always with a point or an exponent: 2.0, 1e-05.
std::string float_literal(double value);

// The functions that MATLAB's statements call, to stand behind them.
std::string matlab_helpers(const CodeSource& source, const Statements& body);

std::string c_code(const CodeSource& source);
std::string python_code(const CodeSource& source);
std::string sympy_code(const CodeSource& source);
std::string matlab_code(const CodeSource& source);
std::string latex_code(const CodeSource& source);

}  // namespace tribench
