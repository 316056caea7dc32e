// SPDX-License-Identifier: MIT
//
// Formulas with states in a problem: each state becomes an input more, with its column in every
// table and along every trail, its range as its box and its law (Input::law), so that whatever
// evaluates, judges and proves formulas of one row goes on doing so.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "algorithms/expression/expression.hpp"
#include "algorithms/states/state_law.hpp"
#include "problems/problem.hpp"

namespace tribench {

// The problem with such inputs behind its own, in the order given; drives are places among its
// inputs. A name that is taken gets a number. Throws Error (bad_input) where the problem has no
// time, and what check_state throws. Cost: a column a state along the trail.
Problem with_states(const Problem& problem, std::span<const StateDeclaration> states);

// A formula over the problem's inputs as text: the states that it reads are declared before it.
std::string formula_text(const Problem& problem, const Expression& formula);

// The reverse: a formula of a record of this problem, whatever states the problem had then.
// `extended` has the states' columns. Copies the problem.
struct ProblemFormula {
  Expression formula;
  std::optional<Problem> extended;  // where the formula has states

  const Problem& over(const Problem& problem) const { return extended ? *extended : problem; }
};
ProblemFormula read_problem_formula(const std::string& text, const Problem& problem);

}  // namespace tribench
