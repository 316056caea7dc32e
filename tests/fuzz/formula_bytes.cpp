// SPDX-License-Identifier: MIT
#include "tests/fuzz/formula_bytes.hpp"

#include <vector>

namespace tribench::fuzz {

Expression formula_from(Decisions& decisions) {
  std::vector<Node> tape;
  std::size_t operands = 0;
  const std::size_t wanted = 1 + decisions.below(kMaxFormulaNodes);
  while (tape.size() < wanted) {
    const Op op = static_cast<Op>(decisions.below(kOpCount));
    if (op == Op::constant) {
      tape.push_back(Node::constant(decisions.finite_number()));
      ++operands;
    } else if (arity(op) == 0 || operands < static_cast<std::size_t>(arity(op))) {
      tape.push_back(Node::input(decisions.below(kFormulaInputs)));
      ++operands;
    } else {
      Node node;
      node.op = op;
      tape.push_back(node);
      operands -= static_cast<std::size_t>(arity(op)) - 1;
    }
  }
  for (; operands > 1; --operands) {
    Node node;
    node.op = Op::add;
    tape.push_back(node);
  }
  return Expression(std::move(tape));
}

}  // namespace tribench::fuzz
