// SPDX-License-Identifier: MIT
//
// The last step of every formula that leaves a method: the shortest form of the same function
// (expression/simplify.hpp), and constants that are a whole number, a small fraction, a multiple of
// pi or a root, or a short decimal (named_values.hpp), where the rows cannot tell them apart; of
// what is known but for a common multiple (common_multiple.hpp) the one with such numbers. Written
// with differences where numbers are negative (expression/differences.hpp).
//
// Guarantees: neither the mean squared nor the mean absolute error on the rows grows (beyond 1e-9
// of itself, and beyond 1e-12 of the target's size, which is rounding); complexity does not grow,
// but by one where that brings a proof that there is no singularity; no such proof is lost;
// deterministic; finish(finish(f)) is finish(f). Under noise that leaves the
// constants alone: at a least-squares optimum every other value errs more.
//
// Cost: a few milliseconds for 30 nodes and 1000 rows (bench/fitting_bench). Formulas of more than
// 150 nodes, which are sums of a table's many terms, are only written with differences.
#pragma once

#include <functional>
#include <span>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/input_box.hpp"
#include "algorithms/fitting/constant_fit.hpp"

namespace tribench {

class FormulaFinisher {
 public:
  // Inputs and target are finite and outlive the finisher. `admits` says which forms may be used;
  // forms of the formula's own operations always may.
  FormulaFinisher(const Inputs& inputs, std::span<const double> target, InputBox box,
                  std::function<bool(const Expression&)> admits);

  Expression finish(const Expression& formula);

 private:
  struct RowErrors {
    double square = 0;  // sums over the rows
    double absolute = 0;
  };

  // In its shortest form, with named numbers.
  Expression with_names(const Expression& formula);
  RowErrors errors_of(const Expression& formula);
  bool is_no_worse(const RowErrors& errors, const RowErrors& than) const;
  bool is_proved(const Expression& formula) const;
  Expression shortest(const Expression& formula);
  // Moves all constants that are close to a name at once, if the rows do not mind.
  void name_together(Expression& formula);
  // Those within `near` of a name, of their value, and those smaller than `nothing`.
  bool name_all(Expression& formula, double near, double nothing);
  // Divides a sum by a number after which more numbers have a name; false where none does.
  bool take_a_multiple_out(Expression& formula);
  // Moves one constant to a number that has a name; false where none will do.
  bool name_a_constant(Expression& formula);
  // All constants but the one at `held`, those with a name and exponents.
  void fit_the_others(Expression& formula, std::size_t held);
  bool try_value(Expression& formula, std::size_t place, double value);

  Inputs inputs_;
  std::span<const double> target_;
  InputBox box_;
  std::function<bool(const Expression&)> admits_;
  Evaluator evaluator_;
  ConstantFitter fitter_;
  std::vector<double> values_;
  double target_square_ = 0;  // sums over the rows
  double target_absolute_ = 0;
};

}  // namespace tribench
