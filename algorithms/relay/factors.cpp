// SPDX-License-Identifier: MIT
#include "algorithms/relay/factors.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "algorithms/expression/build.hpp"

namespace tribench::relay {
namespace {

using namespace build;

constexpr std::size_t kMostWavesTogether = 3;  // inputs: 20 products

class List {
 public:
  List(const LogRows& rows, const OperatorSet& operators, std::initializer_list<FactorKind> kinds)
      : rows_(rows), operators_(operators), kinds_(kinds) {}

  void add(FactorKind kind, const Expression& formula, std::vector<std::size_t> inputs) {
    const bool is_wanted = kind == FactorKind::input || std::ranges::count(kinds_, kind) > 0;
    if (!is_wanted || !operators_.admits(formula)) return;
    Factor factor = factor_of(formula, rows_);
    if (!std::ranges::all_of(factor.values, [](double x) { return std::isfinite(x); })) return;
    list_.push_back({std::move(factor), kind, std::move(inputs)});
  }
  void add_functions_of(std::size_t j) {
    const Expression x = input(j);
    add(FactorKind::wave, function(Op::cos, x), {j});
    add(FactorKind::wave, function(Op::sin, x), {j});
    add(FactorKind::other, function(Op::sin, constant(0.5) * x), {j});
    add(FactorKind::other, constant(1) + x, {j});
    add(FactorKind::other, constant(1) - x, {j});
    add(FactorKind::other, constant(1) + power(x, 2), {j});
    add(FactorKind::other, function(Op::tanh, x), {j});
    add(FactorKind::other, function(Op::exp, x) - constant(1), {j});
    add(FactorKind::exponential, function(Op::exp, x), {j});
  }
  void add_root_products(std::size_t i) {
    for (std::size_t j = i + 1; j < rows_.inputs().size(); ++j) {
      add(FactorKind::root_product, function(Op::sqrt, input(i) * input(j)), {i, j});
    }
  }
  void add_slow(std::size_t j) {
    add(FactorKind::root, function(Op::sqrt, input(j)), {j});
    add(FactorKind::logarithm, function(Op::log, input(j)), {j});
    if (!rows_.is_share(j)) return;
    add(FactorKind::logarithm, function(Op::log, constant(1) - input(j)), {j});
  }
  void add_powers(std::size_t i, std::size_t j) {
    add(FactorKind::power, Expression::binary(Op::pow, input(i), input(j)), {i, j});
    if (!rows_.is_share(i)) return;
    // What is left, or has grown, after j times a share of i.
    add(FactorKind::power, Expression::binary(Op::pow, constant(1) - input(i), input(j)), {i, j});
    add(FactorKind::power, Expression::binary(Op::pow, constant(1) + input(i), input(j)), {i, j});
  }
  // Of inputs j and later ones, `product` times a wave of each of one more.
  void add_wave_products(std::size_t next, const Expression& product,
                         const std::vector<std::size_t>& inputs) {
    for (std::size_t j = next; j < rows_.inputs().size(); ++j) {
      if (!rows_.is_of_order_one(j)) continue;
      std::vector<std::size_t> longer = inputs;
      longer.push_back(j);
      for (const Op op : {Op::cos, Op::sin}) {
        const Expression wave = function(op, input(j));
        const Expression both = product.empty() ? wave : product * wave;
        if (longer.size() > 1) add(FactorKind::wave_product, both, longer);
        add_wave_products(j + 1, both, longer);
      }
    }
  }
  void add_pair(std::size_t i, std::size_t j) {
    const Expression a = input(i);
    const Expression b = input(j);
    add(FactorKind::difference, a - b, {i, j});
    add(FactorKind::sum, a + b, {i, j});
    add(FactorKind::other, power(a, 2) + power(b, 2), {i, j});
    add(FactorKind::other, function(Op::log, a / b), {i, j});
    if (!rows_.is_of_order_one(i) || !rows_.is_of_order_one(j)) return;
    add(FactorKind::wave, function(Op::cos, a - b), {i, j});
    add(FactorKind::other, function(Op::sin, a - b), {i, j});
    add(FactorKind::decay, function(Op::exp, -(a * b)), {i, j});
    add(FactorKind::angle_sum, function(Op::cos, a + b), {i, j});
    add(FactorKind::angle_sum, function(Op::sin, a + b), {i, j});
    add(FactorKind::angle_sum, function(Op::sin, a - b), {i, j});
    add(FactorKind::other, function(Op::sin, a * b), {i, j});
    add(FactorKind::other, function(Op::cos, a * b), {i, j});
    add(FactorKind::other, constant(1) + a * b, {i, j});
    add(FactorKind::other, constant(1) - a * b, {i, j});
  }
  std::vector<KnownFactor> taken() && { return std::move(list_); }

 private:
  const LogRows& rows_;
  const OperatorSet& operators_;
  std::vector<FactorKind> kinds_;
  std::vector<KnownFactor> list_;
};

}  // namespace

std::vector<KnownFactor> known_factors(const LogRows& rows, const OperatorSet& operators,
                                       std::initializer_list<FactorKind> kinds) {
  List list(rows, operators, kinds);
  const std::size_t n = rows.inputs().size();
  for (std::size_t j = 0; j < n; ++j) list.add(FactorKind::input, input(j), {j});
  for (std::size_t j = 0; j < n; ++j) {
    if (rows.is_of_order_one(j)) list.add_functions_of(j);
  }

  for (std::size_t j = 0; j < n; ++j) list.add_slow(j);
  for (std::size_t j = 0; j < n && n <= kMostPaired; ++j) list.add_root_products(j);
  if (n <= kMostWavesTogether) list.add_wave_products(0, {}, {});
  for (std::size_t i = 0; i < n && n <= kMostPaired; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      if (i != j && rows.is_of_order_one(j)) list.add_powers(i, j);
    }
    for (std::size_t j = i + 1; j < n; ++j) {
      if (rows.are_alike(i, j)) list.add_pair(i, j);
    }
  }
  return std::move(list).taken();
}

}  // namespace tribench::relay
