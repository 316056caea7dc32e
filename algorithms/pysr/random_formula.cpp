// SPDX-License-Identifier: MIT
#include "algorithms/pysr/random_formula.hpp"

#include <algorithm>

#include "algorithms/pysr/tape_edit.hpp"

namespace tribench::pysr {
namespace {

std::size_t random_leaf_place(const Expression& formula, RandomStream& random) {
  std::vector<std::size_t> leaves;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (arity(formula.node(i).op) == 0 && !is_exponent(formula, i)) leaves.push_back(i);
  }
  return leaves[random.below(leaves.size())];
}

Expression append_operator(const Expression& formula, Op op, const Alphabet& alphabet,
                           RandomStream& random) {
  const std::size_t place = random_leaf_place(formula, random);
  const Node a = random_leaf(alphabet, random);
  if (arity(op) == 1) return with_replaced(formula, place, join(op, {&a, 1}));
  const Node b = random_leaf(alphabet, random);
  return with_replaced(formula, place, join(op, {&a, 1}, {&b, 1}));
}

}  // namespace

Node random_leaf(const Alphabet& alphabet, RandomStream& random) {
  if (alphabet.inputs == 0 || random.chance(0.5)) return Node::constant(random.normal());
  return Node::input(random.below(alphabet.inputs));
}

Op random_operator(const Alphabet& alphabet, RandomStream& random) {
  const std::vector<Op>& operators = alphabet.operators.operators();
  return operators[random.below(operators.size())];
}

Expression append_random_operator(const Expression& formula, const Alphabet& alphabet,
                                  RandomStream& random) {
  return append_operator(formula, random_operator(alphabet, random), alphabet, random);
}

Expression random_formula(int operators, const Alphabet& alphabet, RandomStream& random) {
  Expression formula = Expression::constant(0);
  for (int i = 0; i < operators; ++i) formula = append_random_operator(formula, alphabet, random);
  return formula;
}

Expression random_part(const Form& form, std::size_t part, int operators,
                       const OperatorSet& operator_set, RandomStream& random) {
  const std::size_t arguments = form.arguments(part).size();
  // A form of the whole may have no inputs to offer; a part without arguments has none by intent.
  if (arguments == 0 && !form.is_whole()) operators = 0;
  return random_formula(operators, {operator_set, arguments}, random);
}

Expression random_formula_of_size(int nodes, const Alphabet& alphabet, RandomStream& random) {
  Expression formula({random_leaf(alphabet, random)});
  std::vector<Op> fitting;
  while (static_cast<int>(formula.size()) < nodes) {
    fitting.clear();
    const int room = nodes - static_cast<int>(formula.size());
    for (const Op op : alphabet.operators.operators()) {
      if (arity(op) <= room) fitting.push_back(op);
    }
    if (fitting.empty()) break;
    formula = append_operator(formula, fitting[random.below(fitting.size())], alphabet, random);
  }
  return formula;
}

}  // namespace tribench::pysr
