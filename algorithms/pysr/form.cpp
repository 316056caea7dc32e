// SPDX-License-Identifier: MIT
#include "algorithms/pysr/form.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"
#include "algorithms/pysr/simplify.hpp"
#include "algorithms/pysr/tape_edit.hpp"
#include "foundation/error.hpp"

namespace tribench::pysr {
namespace {

// Variables from here on are parts, in an outer form alone.
constexpr std::size_t kFirstPart = 0x8000;

bool is_part(const Node& node) { return node.is_variable() && node.variable >= kFirstPart; }

bool is_same(const Node& a, const Node& b) {
  return a.op == b.op && a.variable == b.variable && a.value == b.value;
}

std::vector<std::size_t> first_columns(std::size_t count) {
  std::vector<std::size_t> columns(count);
  std::iota(columns.begin(), columns.end(), std::size_t{0});
  return columns;
}

}  // namespace

Form::Form(std::size_t inputs) : Form(inputs, first_columns(inputs)) {}

Form::Form(std::size_t inputs, std::vector<std::size_t> arguments)
    : inputs_(inputs),
      outer_(Expression::variable(kFirstPart)),
      columns_(inputs),
      drawn_{0},
      takes_all_(arguments == first_columns(inputs)) {
  parts_.push_back({"f", std::move(arguments)});
}

Form::Form(std::string_view text, std::span<const std::string> names)
    : inputs_(names.size()), columns_(names.size()) {
  std::vector<Hole> holes;
  Expression formula = parse_with_holes(text, names, holes);
  if (holes.empty()) {
    throw_bad_input(fmt::format("the template '{}' leaves nothing to be found", text), "template",
                    "name a part with its arguments, as in \"sgn_v*f(abs(v))\"");
  }
  for (const Hole& hole : holes) {
    Part part{hole.name, {}};
    for (const Expression& argument : hole.arguments) {
      if (columns_used(argument) == 0) {
        throw_bad_input(fmt::format("an argument of the part '{}' holds no input", hole.name),
                        "template", "name inputs, or nothing for a number to be fitted");
      }
      const std::size_t column = columns_.leaf_of(argument).variable;
      if (std::ranges::count(part.arguments, column) == 0) part.arguments.push_back(column);
    }
    if (!part.arguments.empty()) drawn_.push_back(parts_.size());
    parts_.push_back(std::move(part));
  }
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const Node& node = formula.node(i);
    if (!node.is_variable() || node.variable < inputs_) continue;
    formula.set_leaf(i, Node::input(node.variable - inputs_ + kFirstPart));
  }
  std::vector<Node> outer;
  build(formula, formula.root(), outer);
  outer_ = Expression(std::move(outer));
}

// Appends the outer form of the subtree that ends at `node`: what holds no part becomes a column.
void Form::build(const Expression& text, std::size_t node, std::vector<Node>& outer) {
  if (std::ranges::none_of(subtree_nodes(text, node), is_part) && !is_exponent(text, node)) {
    outer.push_back(columns_.leaf_of(subtree(text, node)));
    return;
  }
  const Children children = children_of(text, node);
  for (std::size_t c = 0; c < children.count; ++c) build(text, children.place[c], outer);
  outer.push_back(text.node(node));
}

bool Form::has_fixed_exponent() const {
  for (std::size_t i = 0; i < outer_.size(); ++i) {
    if (is_exponent(outer_, i)) return true;
  }
  return false;
}

std::size_t Form::place(const Expression& formula, std::size_t part) const {
  // Back from the root: the length of what stands in a part's place is known at its last node.
  std::size_t last = formula.root();
  for (std::size_t i = outer_.root();; --i) {
    if (outer_.node(i).variable == kFirstPart + part) return last;
    last -= is_part(outer_.node(i)) ? formula.node(last).length : 1;
  }
}

Expression Form::part(const Expression& formula, std::size_t part) const {
  if (takes_all_) return formula;
  Expression own = subtree(formula, place(formula, part));
  const std::vector<std::size_t>& arguments = parts_[part].arguments;
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (!own.node(i).is_variable()) continue;
    const auto argument = std::ranges::find(arguments, own.node(i).variable);
    own.set_leaf(i, Node::input(static_cast<std::size_t>(argument - arguments.begin())));
  }
  return own;
}

Expression Form::over_columns(Expression formula, std::size_t part) const {
  if (takes_all_) return formula;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const Node& node = formula.node(i);
    if (node.is_variable()) {
      formula.set_leaf(i, Node::input(parts_[part].arguments[node.variable]));
    }
  }
  return formula;
}

Expression Form::with_part(const Expression& formula, std::size_t part,
                           Expression replacement) const {
  if (takes_all_) return replacement;
  const Expression own = over_columns(std::move(replacement), part);
  return with_replaced(formula, place(formula, part), own.nodes());
}

Expression Form::assembled(const std::function<Expression(std::size_t)>& part) const {
  if (takes_all_) return part(0);
  std::vector<Node> tape;
  for (const Node& node : outer_.nodes()) {
    if (is_part(node)) {
      const std::size_t k = node.variable - kFirstPart;
      const Expression own = over_columns(part(k), k);
      tape.insert(tape.end(), own.nodes().begin(), own.nodes().end());
    } else {
      tape.push_back(node);
    }
  }
  return Expression(std::move(tape));
}

std::size_t Form::draw_part(RandomStream& random) const {
  if (drawn_.empty()) return 0;
  return drawn_.size() == 1 ? drawn_[0] : drawn_[random.below(drawn_.size())];
}

bool Form::fits(const Expression& formula) const {
  if (takes_all_) return true;
  std::size_t left = formula.size();  // nodes not yet compared
  for (std::size_t i = outer_.size(); i-- > 0;) {
    if (left == 0) return false;
    const Node& wanted = outer_.node(i);
    if (!is_part(wanted)) {
      if (!is_same(formula.node(--left), wanted)) return false;
      continue;
    }
    const bool known = std::ranges::all_of(subtree_nodes(formula, left - 1), [&](const Node& node) {
      return !node.is_variable() ||
             std::ranges::count(parts_[wanted.variable - kFirstPart].arguments, node.variable) > 0;
    });
    if (!known) return false;
    left -= formula.node(left - 1).length;
  }
  return left == 0;
}

std::optional<Expression> Form::read(const Expression& formula) const {
  if (takes_all_) return formula;
  std::vector<Node> reversed;  // postfix from its end
  std::size_t left = formula.size();
  // Takes a whole column where it stands next; false where it does not.
  const auto take_column = [&](std::size_t column) {
    const Node leaf = Node::input(column);
    const Expression* text = columns_.formula_of(column);
    const std::span<const Node> wanted = text == nullptr ? std::span(&leaf, 1) : text->nodes();
    if (left < wanted.size() ||
        !std::ranges::equal(wanted, formula.nodes().subspan(left - wanted.size(), wanted.size()),
                            is_same)) {
      return false;
    }
    left -= wanted.size();
    reversed.push_back(leaf);
    return true;
  };
  for (std::size_t i = outer_.size(); i-- > 0;) {
    if (left == 0) return std::nullopt;
    const Node& wanted = outer_.node(i);
    if (wanted.is_variable() && !is_part(wanted)) {
      if (!take_column(wanted.variable)) return std::nullopt;
    } else if (!is_part(wanted)) {
      if (!is_same(formula.node(left - 1), wanted)) return std::nullopt;
      reversed.push_back(formula.node(--left));
    } else {
      const std::vector<std::size_t>& arguments = parts_[wanted.variable - kFirstPart].arguments;
      const std::size_t begin = formula.begin(left - 1);
      while (left > begin) {
        if (std::ranges::any_of(arguments, take_column)) continue;
        if (formula.node(left - 1).is_variable()) return std::nullopt;
        reversed.push_back(formula.node(--left));
      }
    }
  }
  if (left != 0) return std::nullopt;
  std::ranges::reverse(reversed);
  return Expression(std::move(reversed));
}

Expression simplified(const Form& form, const Expression& formula) {
  if (form.is_whole()) return simplified(formula);
  return form.assembled([&](std::size_t k) { return simplified(form.part(formula, k)); });
}

std::string parts_text(const Form& form, std::span<const std::string> names,
                       const Expression& formula) {
  const std::optional<Expression> own = form.read(formula);
  std::string text;
  for (std::size_t k = 0; own && k < form.parts(); ++k) {
    const Expression part = form.columns().written_out(subtree(*own, form.place(*own, k)));
    text += fmt::format("{}{} = {}", k == 0 ? "" : "; ", form.name(k), print(part, names));
  }
  return text;
}

}  // namespace tribench::pysr
