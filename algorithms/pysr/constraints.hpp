// SPDX-License-Identifier: MIT
//
// The one validator: every formula that enters a population, the hall of fame or the front has
// passed `Validator::admits`. It also owns the measure of size.
//
// Texts of the constraints:
//   argument limits   "^:-1,3; exp:9"          size of each argument, -1 for none
//   nested limits     "exp>exp=0; exp>sqrt=1"  most of the inner on a path below an outer
//   operator sizes    "exp=2; ^=3"             what an operator counts; 1 where not named
//   part sizes        "f=9; g=15"              the largest size of a part of the template
//
// Source: SymbolicRegression.jl, CheckConstraints.jl and Complexity.jl.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/operator_set.hpp"
#include "algorithms/pysr/form.hpp"
#include "algorithms/pysr/options.hpp"
#include "algorithms/pysr/units.hpp"

namespace tribench::pysr {

class Validator {
 public:
  // Throws Error (bad_input) where a text of the options is not understood or a unit is unknown.
  Validator(const Options& options, const OperatorSet& operators, std::span<const Input> inputs)
      : Validator(options, operators, inputs, Form(inputs.size())) {}
  // Formulas of this form alone; what an operator may do holds inside the parts.
  Validator(const Options& options, const OperatorSet& operators, std::span<const Input> inputs,
            Form form);

  const Form& form() const { return form_; }

  // Rounded sum of the weights of its nodes; the number of nodes with the default weights.
  int size(const Expression& formula) const;

  // Form, priors, size up to `max_size` (that of the columns' tape), depth, operators, arguments,
  // nesting, sizes of parts, and units where they are hard. O(size * nested limits).
  bool admits(const Expression& formula, int max_size) const;

  // What the loss of a formula grows by where units are soft and it breaks them, else 0.
  double unit_penalty(const Expression& formula) const;

 private:
  struct NestedLimit {
    Op outer;
    Op inner;
    int most;
  };
  void read_part_sizes(const std::string& text);
  void read_units(const Options& options, std::span<const Input> inputs);
  // What holds inside each part: operators, arguments, nesting.
  bool keeps_limits(const Expression& part) const;
  bool parts_fit(const Expression& formula) const;
  bool arguments_fit(const Expression& formula) const;
  bool nesting_fits(const Expression& formula, const NestedLimit& limit) const;
  double node_size(const Node& node) const;

  const OperatorSet* operators_;
  Form form_;
  std::vector<Input> inputs_;
  bool has_priors_ = false;     // of the inputs: the highest power of one
  std::vector<int> part_size_;  // the largest allowed; empty for none
  int max_depth_;
  std::array<double, kOpCount> op_size_{};
  double constant_size_;
  double variable_size_;
  bool plain_sizes_ = true;
  std::array<std::array<int, 2>, kOpCount> argument_limit_{};  // -1 for none
  bool has_argument_limits_ = false;
  std::vector<NestedLimit> nested_limits_;
  Units units_;
  double unit_penalty_;
  std::vector<Dimension> input_dimensions_;
  std::optional<Dimension> target_dimension_;
};

}  // namespace tribench::pysr
