// SPDX-License-Identifier: MIT
//
// A formula as a flat postfix tape: children stand before their parent, the root is the last
// node. This is the one representation that search, evaluation, proofs and export share. No
// pointers, no allocation per node: a copy is one memcpy, a subtree is a contiguous range.
//
//   (v + 2) * sgn_v   ->   v  2  +  sgn_v  *
//   length                 1  1  3    1    5
//
// Variables are numbers; their names belong to whoever owns the data (parse and print take them).
// The tape means exactly what it says: nothing is folded, protected or reordered here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace tribench {

enum class Op : std::uint8_t {
  constant,
  variable,
  // binary
  add,
  sub,
  mul,
  div,
  pow,
  // unary
  neg,
  exp,
  log,
  sqrt,
  abs,
  sgn,  // -1, 0, 1; NaN of NaN
  sin,
  cos,
  tanh,
  atan,
};
inline constexpr int kOpCount = 17;

// 0 for leaves, 1 for functions, 2 for + - * / ^.
constexpr int arity(Op op) {
  if (op <= Op::variable) return 0;
  return op <= Op::pow ? 2 : 1;
}

// As written in a formula: "+", "exp", ...; "constant" and "variable" for leaves.
std::string_view op_name(Op op);

// Columns that a tape can name. More are refused, never folded onto others.
inline constexpr std::size_t kMaxInputs = 65'536;
[[noreturn]] void throw_too_many_inputs();

struct Node {
  double value = 0;            // of a constant
  std::uint32_t length = 1;    // nodes of the subtree that ends here, this one included
  std::uint16_t variable = 0;  // column of a variable
  Op op = Op::constant;

  static Node constant(double value) { return {value, 1, 0, Op::constant}; }
  // Throws Error (bad_input) where column >= kMaxInputs.
  static Node input(std::size_t column) {
    if (column >= kMaxInputs) throw_too_many_inputs();
    return {0, 1, static_cast<std::uint16_t>(column), Op::variable};
  }
  bool is_constant() const { return op == Op::constant; }
  bool is_variable() const { return op == Op::variable; }
  bool operator==(const Node&) const = default;
};
static_assert(sizeof(Node) == 16);

class Expression {
 public:
  Expression() = default;
  // From nodes in postfix order; the lengths are computed. Throws Error on a malformed tape.
  explicit Expression(std::vector<Node> postfix);

  static Expression constant(double value) { return Expression({Node::constant(value)}); }
  static Expression variable(std::size_t column) { return Expression({Node::input(column)}); }
  static Expression unary(Op op, const Expression& a);
  static Expression binary(Op op, const Expression& a, const Expression& b);

  // Refused of a temporary: the nodes would be gone before they are looked at.
  std::span<const Node> nodes() const& { return nodes_; }
  std::span<const Node> nodes() const&& = delete;
  std::size_t size() const { return nodes_.size(); }
  bool empty() const { return nodes_.empty(); }
  const Node& node(std::size_t i) const { return nodes_[i]; }
  std::size_t root() const { return nodes_.size() - 1; }

  // First node of the subtree that ends at i; a subtree is [begin(i), i].
  std::size_t begin(std::size_t i) const { return i + 1 - nodes_[i].length; }
  // The argument of a function, the right-hand side of + - * / ^; the left-hand side of these.
  std::size_t last_child(std::size_t i) const { return i - 1; }
  std::size_t left_child(std::size_t i) const { return i - 1 - nodes_[i - 1].length; }

  // Replaces the subtree that ends at i. O(size), one reallocation at most.
  void replace(std::size_t i, std::span<const Node> postfix);
  // Another leaf in place of the leaf i.
  void set_leaf(std::size_t i, const Node& leaf) { nodes_[i] = leaf; }
  // Makes room for a tape of this size and hands it out to be overwritten, lengths included; the
  // memory is kept. For edits (edit.hpp), which know the lengths.
  std::span<Node> reset(std::size_t size) {
    nodes_.resize(size);
    return nodes_;
  }

  // The same formula and the same bits in every constant.
  bool operator==(const Expression&) const = default;

 private:
  std::vector<Node> nodes_;
};

// The formula that ends at node i of another.
Expression subtree(const Expression& formula, std::size_t i);

// Levels of nesting; 1 for a leaf. O(size).
std::size_t depth(const Expression& formula);

// One more than the largest column used; 0 without variables.
std::size_t columns_used(const Expression& formula);

// Positions of the constants, in the order of the tape, and a new value for one of them: what a fit
// changes. An exponent counts like any other constant here.
std::vector<std::size_t> constant_positions(const Expression& formula);
inline void set_constant(Expression& formula, std::size_t position, double value) {
  formula.set_leaf(position, Node::constant(value));
}

// Writes the subtree lengths into a postfix tape; false where the tape is malformed.
bool assign_lengths(std::span<Node> postfix);

}  // namespace tribench
