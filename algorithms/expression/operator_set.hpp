// SPDX-License-Identifier: MIT
//
// The functions and operations a method may use. `paper` is + - * exp sqrt; `paper+div` adds
// division; `paper+safe_div` allows division but admits only formulas proved free of
// singularities; `full` has everything. Integer powers count as products wherever * is allowed;
// abs and sgn of an input are available wherever the problem offers the sign as an input.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/expression/expression.hpp"

namespace tribench {

class OperatorSet {
 public:
  OperatorSet() = default;
  OperatorSet(std::string name, std::string summary, std::vector<Op> operators,
              bool proved_free_only = false);

  const std::string& name() const { return name_; }
  const std::string& summary() const { return summary_; }
  bool allows(Op op) const { return ((mask_ >> static_cast<int>(op)) & 1U) != 0; }
  // Binary operators and functions in the order declared; leaves are always allowed.
  const std::vector<Op>& operators() const { return operators_; }
  // Only formulas proved to have no singularity on the input box may enter the front.
  bool proved_free_only() const { return proved_free_only_; }

  // Whether a formula keeps to the set: every operation is allowed, unary minus counts as part of
  // subtraction, and an integer constant power (2 to 64) as part of multiplication.
  bool admits(const Expression& formula) const;

 private:
  std::string name_;
  std::string summary_;
  std::vector<Op> operators_;
  std::uint32_t mask_ = 0;
  bool proved_free_only_ = false;
};

// The built-in sets, in the order in which they are listed.
const std::vector<OperatorSet>& operator_sets();

// Throws Error (bad_input) with the nearest name.
const OperatorSet& find_operator_set(std::string_view name);

}  // namespace tribench
