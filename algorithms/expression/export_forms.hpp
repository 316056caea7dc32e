// SPDX-License-Identifier: MIT
//
// What the writers of single languages share; only export.cpp calls them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

// Integer powers become the evaluator's products of squares (evaluate.hpp).
Statements write_statements(const CodeSource& source, const Dialect& dialect);

// Shortest text that reads back, always with a point or an exponent: 2.0, 1e-05.
std::string float_literal(double value);

std::string c_code(const CodeSource& source);
std::string python_code(const CodeSource& source);
std::string sympy_code(const CodeSource& source);
std::string matlab_code(const CodeSource& source);
std::string latex_code(const CodeSource& source);

}  // namespace tribench
