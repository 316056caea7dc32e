// SPDX-License-Identifier: MIT
//
// Random leaves, operators and formulas.
// Source: SymbolicRegression.jl, MutationFunctions.jl: a leaf is a constant N(0, 1) or an input
// with even chances; an operator's arity is drawn in proportion to the operators of that arity.
// Formulas grow at random leaves: neither the balanced nor the divided shapes of
// expression/random_formula.hpp, which benches and tests use.
#pragma once

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/operator_set.hpp"
#include "algorithms/pysr/form.hpp"
#include "foundation/random.hpp"

namespace tribench::pysr {

struct Alphabet {
  const OperatorSet& operators;
  std::size_t inputs = 0;
};

Node random_leaf(const Alphabet& alphabet, RandomStream& random);

Op random_operator(const Alphabet& alphabet, RandomStream& random);

// A random leaf becomes an operator over random leaves.
Expression append_random_operator(const Expression& formula, const Alphabet& alphabet,
                                  RandomStream& random);

// Grown from a zero constant by `operators` appended operators.
Expression random_formula(int operators, const Alphabet& alphabet, RandomStream& random);

// A formula of `nodes` nodes, or one less where only binary operators would fit.
Expression random_formula_of_size(int nodes, const Alphabet& alphabet, RandomStream& random);

// As random_formula, of the arguments of a part; a number where it has none.
Expression random_part(const Form& form, std::size_t part, int operators,
                       const OperatorSet& operator_set, RandomStream& random);

}  // namespace tribench::pysr
