// SPDX-License-Identifier: MIT
//
// The outer form of the formulas that a search may find. Without a template the whole formula is
// one part, a function of the inputs. With one,
//
//   sgn_v*f(abs(v)) + g(load)
//
// f and g are parts: each is searched for as a formula of its own arguments, all else stands still.
//
// The genome stays one tape, in which a part's arguments (and whatever else of the template is no
// operation upon parts) are variables: columns of the rows, computed once. So constants of the
// template are never fitted, evaluation, fits and simplification see an ordinary formula, and the
// parts are found by walking the outer form back from the root. `written_out` turns such a tape
// into a formula of the inputs alone.
//
// Source: template expressions of SymbolicRegression.jl (TemplateExpression.jl). Ours differs in
// that a part stands in one place only, and has no vectors of parameters by category: p() is a
// number to be fitted. There is no operator for derivatives.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/expression/expression.hpp"
#include "algorithms/pysr/computed_columns.hpp"
#include "foundation/random.hpp"

namespace tribench::pysr {

class Form {
 public:
  // One part: any formula of the inputs.
  explicit Form(std::size_t inputs);
  // One part: any formula of the inputs named by their columns.
  Form(std::size_t inputs, std::vector<std::size_t> arguments);
  // As the template says; names[i] is input i. Throws Error (bad_input) where it cannot be read,
  // names no part, or a name is unknown.
  Form(std::string_view text, std::span<const std::string> names);

  // Whether the one part is the whole formula.
  bool is_whole() const { return outer_.size() == 1; }
  // Whether the outer form raises a part to a constant power.
  bool has_fixed_exponent() const;

  std::size_t parts() const { return parts_.size(); }
  const std::string& name(std::size_t part) const { return parts_[part].name; }
  // The columns of the rows that are its arguments.
  std::span<const std::size_t> arguments(std::size_t part) const { return parts_[part].arguments; }

  // What the form computes from inputs alone, as columns beside them.
  const ComputedColumns& columns() const { return columns_; }

  // Where the part ends in a formula of this form. O(size of the outer form).
  std::size_t place(const Expression& formula, std::size_t part) const;
  // The part as a formula of its arguments: variable i is argument i.
  Expression part(const Expression& formula, std::size_t part) const;
  Expression with_part(const Expression& formula, std::size_t part, Expression replacement) const;
  // The form with these parts put in.
  Expression assembled(const std::function<Expression(std::size_t)>& part) const;
  // A formula of arguments as one of columns.
  Expression over_columns(Expression formula, std::size_t part) const;

  // A part drawn for a change, among those with arguments; no draw where there is no choice.
  std::size_t draw_part(RandomStream& random) const;
  // Whether a tape has this form, each part with no variables but its arguments.
  bool fits(const Expression& formula) const;
  // A formula of the inputs, written out, read as one of this form; none where it has another.
  std::optional<Expression> read(const Expression& formula) const;

 private:
  struct Part {
    std::string name;
    std::vector<std::size_t> arguments;
  };
  void build(const Expression& text, std::size_t node, std::vector<Node>& outer);

  std::size_t inputs_;
  Expression outer_;         // part k is the variable kFirstPart + k
  std::vector<Part> parts_;  // in the order of the tape
  ComputedColumns columns_;
  std::vector<std::size_t> drawn_;  // parts with arguments
  bool takes_all_ = false;          // one part, argument i is column i: nothing to rename
};

// Each part simplified.
Expression simplified(const Form& form, const Expression& formula);

// What a formula of the inputs, written out, puts in for the parts: "f = 2*abs(v); p = 0.3". Empty
// for a formula of another form.
std::string parts_text(const Form& form, std::span<const std::string> names,
                       const Expression& formula);

}  // namespace tribench::pysr
