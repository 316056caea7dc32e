// SPDX-License-Identifier: MIT
#include "algorithms/relay/log_rows.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "algorithms/expression/build.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "foundation/elementary.hpp"

namespace tribench::relay {
namespace {

double largest_of(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

double mean_size_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += std::abs(value);
  return sum / static_cast<double>(values.size());
}

// x, x^2, x^3 ...: the shortest way to write a power with a positive exponent.
Expression power_of(const Expression& factor, double exponent) {
  return exponent == 1 ? factor : build::power(factor, exponent);
}

Expression times(const Expression& a, const Expression& b) {
  using build::operator*;
  if (a.empty()) return b;
  return b.empty() ? a : a * b;
}

}  // namespace

Factor make_factor(Expression formula, std::vector<double> values) {
  Factor factor{std::move(formula), std::move(values), {}, false};
  bool has_zero = false;
  bool is_positive = false;
  bool is_negative = false;
  for (const double value : factor.values) {
    has_zero = has_zero || value == 0 || !std::isfinite(value);
    is_positive = is_positive || value > 0;
    is_negative = is_negative || value < 0;
  }
  factor.changes_sign = is_positive && is_negative;
  if (has_zero) return factor;
  for (const double value : factor.values) {
    factor.logs.push_back(elementary::log(std::abs(value)));
  }
  return factor;
}

LogRows::LogRows(const FiniteRows& all, std::size_t most) {
  std::vector<std::size_t> kept;
  for (std::size_t r = 0; r < all.rows(); ++r) {
    if (all.target[r] != 0) kept.push_back(r);
  }
  const std::size_t count = std::min(most, kept.size());
  std::vector<double> target;
  std::vector<std::vector<double>> columns(all.columns.size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t r = kept[i * kept.size() / count];
    target.push_back(all.target[r]);
    for (std::size_t j = 0; j < columns.size(); ++j) columns[j].push_back(all.columns[j][r]);
  }
  target_ = make_factor({}, std::move(target));
  for (std::size_t j = 0; j < columns.size(); ++j) {
    inputs_.push_back(make_factor(Expression::variable(j), std::move(columns[j])));
  }
}

bool LogRows::is_of_order_one(std::size_t j) const {
  const double largest = largest_of(inputs_[j].values);
  return largest >= 0.2 && largest <= 50;
}

bool LogRows::is_share(std::size_t j) const {
  return std::ranges::all_of(inputs_[j].values, [](double x) { return x > 0 && x < 1; });
}

bool LogRows::are_alike(std::size_t i, std::size_t j) const {
  constexpr double kApart = 30;
  const double a = mean_size_of(inputs_[i].values);
  const double b = mean_size_of(inputs_[j].values);
  return a <= kApart * b && b <= kApart * a;
}

Factor factor_of(const Expression& formula, const LogRows& rows) {
  std::vector<const double*> columns;
  for (const Factor& input : rows.inputs()) columns.push_back(input.values.data());
  std::vector<double> values(rows.rows());
  Evaluator().evaluate(formula, {columns, rows.rows()}, values);
  return make_factor(formula, std::move(values));
}

double nearest_half(double exponent) { return std::nearbyint(2 * exponent) / 2; }

Expression product_of(double constant, std::span<const Expression> factors,
                      std::span<const double> exponents) {
  Expression above;
  Expression below;
  Expression rooted_above;
  Expression rooted_below;
  for (std::size_t k = 0; k < factors.size(); ++k) {
    const double exponent = exponents[k];
    if (exponent == 0) continue;
    const double size = std::abs(exponent);
    const bool is_root = size == 0.5;
    Expression& side =
        exponent > 0 ? (is_root ? rooted_above : above) : (is_root ? rooted_below : below);
    side = times(side, is_root ? factors[k] : power_of(factors[k], size));
  }
  if (!rooted_above.empty() || !rooted_below.empty()) {
    const Expression over = rooted_above.empty() ? build::constant(1) : rooted_above;
    const Expression inside =
        rooted_below.empty() ? over : Expression::binary(Op::div, over, rooted_below);
    above = times(above, Expression::unary(Op::sqrt, inside));
  }
  Expression product = times(constant == 1 ? Expression() : build::constant(constant), above);
  if (product.empty()) product = build::constant(1);
  return below.empty() ? product : Expression::binary(Op::div, product, below);
}

}  // namespace tribench::relay
