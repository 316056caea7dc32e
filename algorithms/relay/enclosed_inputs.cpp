// SPDX-License-Identifier: MIT
#include "algorithms/relay/enclosed_inputs.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "algorithms/expression/build.hpp"
#include "algorithms/expression/edit.hpp"
#include "algorithms/expression/sum_of_products.hpp"

namespace tribench::relay {
namespace {

using Counts = std::map<std::size_t, std::size_t>;  // of an input: how often it is read

Counts reads_of(const Expression& formula) {
  Counts reads;
  for (const Node& node : formula.nodes()) {
    if (node.is_variable()) ++reads[node.variable];
  }
  return reads;
}

std::optional<std::size_t> input_of(const Expression& formula) {
  if (formula.size() != 1 || !formula.node(0).is_variable()) return std::nullopt;
  return formula.node(0).variable;
}

// The power of an input that a factor of a product is; none where it is something else.
std::optional<std::pair<std::size_t, double>> input_power(const TermFactor& factor) {
  if (const auto input = input_of(factor.base)) return std::pair(*input, double(factor.power));
  const std::size_t root = factor.base.root();
  if (factor.base.node(root).op != Op::pow) return std::nullopt;
  const auto input = input_of(subtree(factor.base, factor.base.left_child(root)));
  const Node& exponent = factor.base.node(factor.base.last_child(root));
  if (!input || !exponent.is_constant() || exponent.value == 0) return std::nullopt;
  return std::pair(*input, exponent.value * factor.power);
}

Expression power(const Expression& base, double exponent) {
  return exponent == 1 ? base : Expression::binary(Op::pow, base, build::constant(exponent));
}

// The same formula with every product's powers of inputs as a power of one product, its first input
// to the power of one: a*b is a part of 2*a*b*exp(a*b), and of a^2*b^2 + c.
Expression with_monomials(const Expression& formula) {
  const std::size_t root = formula.root();
  const Op op = formula.node(root).op;
  if (formula.size() == 1) return formula;
  if (arity(op) == 1 && op != Op::neg) {
    return Expression::unary(op, with_monomials(subtree(formula, formula.last_child(root))));
  }
  if (op == Op::pow) {
    return Expression::binary(op, with_monomials(subtree(formula, formula.left_child(root))),
                              with_monomials(subtree(formula, formula.last_child(root))));
  }
  SumOfProducts sum = sum_of_products(formula, root);
  for (SumTerm& term : sum) {
    std::map<std::size_t, double> powers;
    SumTerm written{term.coefficient, {}};
    for (const TermFactor& factor : term.factors) {
      if (const auto input = input_power(factor)) {
        powers[input->first] += input->second;
      } else if (factor.base.size() == formula.size()) {
        written.factors.push_back(factor);  // no product and no sum: as it is
      } else {
        written.factors.push_back({with_monomials(factor.base), factor.power});
      }
    }
    std::erase_if(powers, [](const auto& one) { return one.second == 0; });
    if (!powers.empty()) {
      const double first = powers.begin()->second;
      Expression product;
      for (const auto& [input, exponent] : powers) {
        const Expression one = power(build::input(input), std::abs(exponent / first));
        product = product.empty()
                      ? one
                      : Expression::binary(exponent / first < 0 ? Op::div : Op::mul, product, one);
      }
      written.factors.insert(written.factors.begin(), {power(product, first), 1});
    }
    term = std::move(written);
  }
  return formula_of(sum);
}

}  // namespace

std::optional<Reduction> enclosed_inputs(const Expression& found, std::size_t inputs) {
  const Expression formula = with_monomials(found);
  std::vector<Expression> parts;  // different ones of two inputs or more
  std::vector<std::size_t> times;
  for (std::size_t i = 0; i < formula.root(); ++i) {
    Expression part = subtree(formula, i);
    if (reads_of(part).size() < 2) continue;
    const auto known = std::ranges::find(parts, part);
    if (known != parts.end()) {
      ++times[static_cast<std::size_t>(known - parts.begin())];
    } else {
      parts.push_back(std::move(part));
      times.push_back(1);
    }
  }
  Counts open = reads_of(formula);
  Reduction reduction;
  reduction.outer = build::constant(1);
  reduction.is_guess = true;
  // A part stands after the parts within it, so that the smallest are seen first.
  for (std::size_t k = 0; k < parts.size(); ++k) {
    std::vector<std::size_t> own;
    for (const auto& [input, count] : reads_of(parts[k])) {
      const auto all = open.find(input);
      if (all != open.end() && count * times[k] == all->second) own.push_back(input);
    }
    if (own.size() < 2) continue;
    for (const std::size_t input : own) open.erase(input);
    reduction.inputs.push_back(parts[k]);
  }
  for (const auto& [input, count] : open) {
    reduction.inputs.push_back(Expression::variable(input));
  }
  if (reduction.inputs.empty() || reduction.inputs.size() >= inputs) return std::nullopt;
  return reduction;
}

}  // namespace tribench::relay
