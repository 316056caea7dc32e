// SPDX-License-Identifier: MIT
#include "algorithms/expression/random_formula.hpp"

#include <utility>

#include "foundation/error.hpp"

namespace tribench {
namespace {

Op pick(const std::vector<Op>& operators, RandomStream& random) {
  return operators[random.below(operators.size())];
}

// A node of a tree laid out level by level: its children are neighbours.
struct LevelNode {
  Node node;
  std::size_t first_child = 0;
};

void append_postfix(const std::vector<LevelNode>& levels, std::size_t at, std::vector<Node>& tape) {
  const LevelNode& here = levels[at];
  for (int c = 0; c < arity(here.node.op); ++c) {
    append_postfix(levels, here.first_child + static_cast<std::size_t>(c), tape);
  }
  tape.push_back(here.node);
}

}  // namespace

RandomFormulas::RandomFormulas(std::vector<Op> operators, std::size_t variables, LeafOptions leaves)
    : all_(std::move(operators)), variables_(variables), leaves_(leaves) {
  if (variables == 0 && leaves.constant_probability < 1) {
    throw Error(ErrorKind::failed, "random formulas need a variable or constants alone");
  }
  for (const Op op : all_) (arity(op) == 1 ? unary_ : binary_).push_back(op);
}

Node RandomFormulas::leaf(RandomStream& random) const {
  if (random.chance(leaves_.constant_probability)) {
    return Node::constant(leaves_.constant_scale * random.normal());
  }
  return Node::input(random.below(variables_));
}

Op RandomFormulas::operation(int arity, RandomStream& random) const {
  const std::vector<Op>& operators = arity == 1 ? unary_ : binary_;
  if (operators.empty()) {
    throw Error(ErrorKind::failed, "the operator set has no operator of the wanted arity");
  }
  return pick(operators, random);
}

std::size_t RandomFormulas::reachable(std::size_t size) const {
  if (size <= 1 || all_.empty()) return 1;
  if (unary_.empty() && size % 2 == 0) return size - 1;
  return size;
}

// What may stand at the root of a formula of this reachable size, at least 2.
const std::vector<Op>& RandomFormulas::operators_of(std::size_t size) const {
  return size == 2 || binary_.empty() ? unary_ : all_;
}

Expression RandomFormulas::balanced(std::size_t size, RandomStream& random) const {
  const std::size_t target = reachable(size);
  std::vector<LevelNode> levels;
  levels.reserve(target);
  std::size_t promised = 1;  // nodes written and children still to be written
  for (std::size_t at = 0; at < promised; ++at) {
    const std::size_t left = target - promised;  // nodes that children here may add
    LevelNode next;
    if (left == 0) {
      next.node = leaf(random);
    } else {
      // With one node left only a unary operator fits; without one the size was lowered.
      next.node.op = pick(operators_of(left + 1), random);
      next.first_child = promised;
      promised += static_cast<std::size_t>(arity(next.node.op));
    }
    levels.push_back(next);
  }
  std::vector<Node> tape;
  tape.reserve(levels.size());
  append_postfix(levels, 0, tape);
  return Expression(std::move(tape));
}

void RandomFormulas::append_grown(std::size_t size, RandomStream& random,
                                  std::vector<Node>& tape) const {
  const std::size_t target = reachable(size);
  if (target == 1) {
    tape.push_back(leaf(random));
    return;
  }
  const std::size_t first = tape.size();
  Node node;
  node.op = pick(operators_of(target), random);
  if (arity(node.op) == 1) {
    append_grown(target - 1, random, tape);
  } else {
    std::size_t left = 1 + random.below(target - 2);
    if (unary_.empty() && left % 2 == 0) --left;
    append_grown(left, random, tape);
    append_grown(target - 1 - left, random, tape);
  }
  node.length = static_cast<std::uint32_t>(tape.size() - first + 1);
  tape.push_back(node);
}

Expression RandomFormulas::grown(std::size_t size, RandomStream& random) const {
  std::vector<Node> tape;
  tape.reserve(size);
  append_grown(size, random, tape);
  return Expression(std::move(tape));
}

}  // namespace tribench
