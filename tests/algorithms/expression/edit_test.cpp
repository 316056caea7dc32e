// SPDX-License-Identifier: MIT
#include "algorithms/expression/edit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/expression/random_formula.hpp"
#include "algorithms/expression/text.hpp"

namespace tribench::edit_test {
namespace {

const std::vector<std::string> kNames = {"a", "b", "c", "d"};

Expression formula(const char* text) { return parse(text, kNames); }
std::string text(const Expression& f) { return print(f, kNames); }

const RandomFormulas kFormulas({Op::add, Op::sub, Op::mul, Op::div, Op::exp, Op::sin}, 4);

bool lengths_are_right(const Expression& f) {
  std::vector<Node> nodes(f.nodes().begin(), f.nodes().end());
  return assign_lengths(nodes) && std::equal(nodes.begin(), nodes.end(), f.nodes().begin());
}

std::map<int, int> operations(const Expression& f) {
  std::map<int, int> count;
  for (const Node& node : f.nodes()) ++count[static_cast<int>(node.op)];
  return count;
}

// A loop over the nodes of a temporary would read memory that is gone: it does not compile.
template <typename E>
concept HasNodes = requires {
  std::declval<E>().nodes();
};

TEST(Expression, LendsItsNodesOnlyWhileItLives) {
  EXPECT_TRUE(HasNodes<const Expression&>);
  EXPECT_FALSE(HasNodes<Expression>);
  EXPECT_FALSE(HasNodes<const Expression>);
}

TEST(Edit, DoesWhatItSays) {
  const Expression f = formula("(a + b)*c");
  const std::size_t sum = f.left_child(f.root());
  Expression out;
  const Expression wave = formula("sin(d)");
  splice(f, sum, wave.nodes(), out);
  EXPECT_EQ(text(out), text(formula("sin(d)*c")));
  swap_operands(f, f.root(), out);
  EXPECT_EQ(text(out), text(formula("c*(a + b)")));
}

TEST(Edit, RotatesLeftRightAndThroughFunctions) {
  Expression out;
  const Expression left = formula("(a + b)*c");
  rotate(left, left.root(), 0, 1, out);
  EXPECT_EQ(text(out), text(formula("a + b*c")));
  const Expression right = formula("a*(b + c)");
  rotate(right, right.root(), 1, 0, out);
  EXPECT_EQ(text(out), text(formula("a*b + c")));
  const Expression nested = formula("d - exp(a + b)");
  rotate(nested, nested.last_child(nested.root()), 0, 0, out);
  EXPECT_EQ(text(out), text(formula("d - (exp(a) + b)")));
  const Expression function = formula("a*exp(b)");
  rotate(function, function.root(), 1, 0, out);
  EXPECT_EQ(text(out), text(formula("exp(a*b)")));
}

TEST(Edit, KeepsEveryTapeWellFormed) {
  RandomStream random(key_of("edit"));
  Expression out;
  Expression back;
  for (int trial = 0; trial < 20000; ++trial) {
    const Expression f = kFormulas.grown(1 + random.below(30), random);
    const Expression g = kFormulas.balanced(1 + random.below(30), random);
    const std::size_t i = random.below(f.size());
    const std::size_t j = random.below(g.size());
    splice(f, i, subtree_nodes(g, j), out);
    ASSERT_TRUE(lengths_are_right(out));
    ASSERT_EQ(out.size(), f.size() - f.node(i).length + g.node(j).length);
    const std::size_t where = f.begin(i) + g.node(j).length - 1;
    ASSERT_EQ(subtree(out, where), subtree(g, j));
    splice(out, where, subtree_nodes(f, i), back);  // undoes it
    ASSERT_EQ(back, f);
    if (arity(f.node(i).op) != 2) continue;
    swap_operands(f, i, out);
    ASSERT_TRUE(lengths_are_right(out));
    swap_operands(out, i, back);
    ASSERT_EQ(back, f);
  }
}

TEST(Edit, RotationKeepsTheNodesAndIsUndoneByItsMirror) {
  RandomStream random(key_of("rotate"));
  Expression out;
  Expression back;
  int rotated = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const Expression f = kFormulas.grown(3 + random.below(30), random);
    const std::size_t i = random.below(f.size());
    if (arity(f.node(i).op) == 0) continue;
    const int pivot =
        static_cast<int>(random.below(static_cast<std::uint64_t>(arity(f.node(i).op))));
    const Op riser = f.node(child_of(f, i, pivot)).op;
    if (arity(riser) == 0) continue;
    const int grandchild = static_cast<int>(random.below(static_cast<std::uint64_t>(arity(riser))));
    rotate(f, i, pivot, grandchild, out);
    ASSERT_TRUE(lengths_are_right(out));
    EXPECT_EQ(operations(out), operations(f));
    rotate(out, i, grandchild, pivot, back);
    ASSERT_EQ(back, f);
    ++rotated;
  }
  EXPECT_GT(rotated, 5000);
}

TEST(Edit, AllocatesNothingOnceTheResultHasGrown) {
  RandomStream random(key_of("allocation"));
  Expression out = kFormulas.grown(200, random);
  const Node* const memory = out.nodes().data();
  for (int trial = 0; trial < 1000; ++trial) {
    const Expression f = kFormulas.grown(40, random);
    splice(f, random.below(f.size()), f.nodes(), out);
    ASSERT_EQ(out.nodes().data(), memory);
  }
}

TEST(RandomFormula, HasTheSizeAskedFor) {
  RandomStream random(1);
  const RandomFormulas binary_only({Op::add, Op::mul}, 2);
  for (std::size_t size = 1; size <= 64; ++size) {
    EXPECT_EQ(kFormulas.balanced(size, random).size(), size);
    EXPECT_EQ(kFormulas.grown(size, random).size(), size);
    const std::size_t odd = size % 2 == 1 ? size : size - 1;
    EXPECT_EQ(binary_only.balanced(size, random).size(), odd);
    EXPECT_EQ(binary_only.grown(size, random).size(), odd);
  }
}

TEST(RandomFormula, IsShallowWhereBalanced) {
  RandomStream random(2);
  const RandomFormulas binary_only({Op::add, Op::mul}, 2);
  EXPECT_EQ(depth(binary_only.balanced(63, random)), 6U);
  EXPECT_EQ(depth(binary_only.balanced(65, random)), 7U);
}

TEST(RandomFormula, UsesEveryOperatorVariableAndSign) {
  RandomStream random(3);
  std::map<int, int> seen;
  std::map<int, int> variables;
  for (int trial = 0; trial < 300; ++trial) {
    const Expression f = kFormulas.grown(20, random);
    for (const Node& node : f.nodes()) {
      ++seen[static_cast<int>(node.op)];
      if (node.is_variable()) ++variables[node.variable];
    }
  }
  EXPECT_EQ(seen.size(), 8U);
  EXPECT_EQ(variables.size(), 4U);
}

TEST(RandomFormula, RepeatsForTheSameStream) {
  RandomStream first(5);
  RandomStream second(5);
  EXPECT_EQ(kFormulas.grown(50, first), kFormulas.grown(50, second));
}

}  // namespace
}  // namespace tribench::edit_test
