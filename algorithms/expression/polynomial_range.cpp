// SPDX-License-Identifier: MIT
#include "algorithms/expression/polynomial_range.hpp"

#include <algorithm>
#include <cmath>

namespace tribench {
namespace {

using Coefficients = std::vector<Interval>;

constexpr std::size_t kNoVariable = static_cast<std::size_t>(-1);
constexpr double kTolerance = 1e-9;
constexpr int kSubdivisions = 64;

bool is_constant(const Polynomial& p) { return p.variable == kNoVariable; }

// The variable of a combination of both, or nothing where they differ.
std::optional<std::size_t> common_variable(const Polynomial& a, const Polynomial& b) {
  if (is_constant(a)) return b.variable;
  if (is_constant(b) || a.variable == b.variable) return a.variable;
  return std::nullopt;
}

Coefficients sum(const Coefficients& a, const Coefficients& b) {
  Coefficients result(std::max(a.size(), b.size()));
  for (std::size_t k = 0; k < result.size(); ++k) {
    if (k < a.size()) result[k] = a[k];
    if (k < b.size()) result[k] = add(result[k], b[k]);
  }
  return result;
}

Coefficients negated(Coefficients a) {
  for (Interval& c : a) c = negate(c);
  return a;
}

std::optional<Coefficients> product(const Coefficients& a, const Coefficients& b) {
  if (a.size() + b.size() - 2 > kMaxPolynomialDegree) return std::nullopt;
  Coefficients result(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      result[i + j] = add(result[i + j], multiply(a[i], b[j]));
    }
  }
  return result;
}

std::optional<Coefficients> power(const Coefficients& base, const Polynomial& exponent) {
  if (!is_constant(exponent) || !exponent.coefficients[0].is_point()) return std::nullopt;
  const double n = exponent.coefficients[0].low;
  if (!(n >= 1 && n <= kMaxPolynomialDegree && n == std::floor(n))) return std::nullopt;
  std::optional<Coefficients> result = base;
  for (int k = 1; k < static_cast<int>(n) && result; ++k) result = product(*result, base);
  return result;
}

std::optional<Polynomial> combined(Op op, const Polynomial& a, const Polynomial& b) {
  const std::optional<std::size_t> variable = common_variable(a, b);
  if (!variable) return std::nullopt;
  std::optional<Coefficients> result;
  switch (op) {
    case Op::add:
      result = sum(a.coefficients, b.coefficients);
      break;
    case Op::sub:
      result = sum(a.coefficients, negated(b.coefficients));
      break;
    case Op::mul:
      result = product(a.coefficients, b.coefficients);
      break;
    case Op::div:
      if (!is_constant(b) || b.coefficients[0].contains(0)) return std::nullopt;
      result = product(a.coefficients, {divide({1, 1}, b.coefficients[0])});
      break;
    default:
      result = power(a.coefficients, b);
  }
  if (!result || !std::ranges::all_of(*result, &Interval::is_bounded)) return std::nullopt;
  return Polynomial{*variable, *std::move(result)};
}

std::optional<Polynomial> polynomial_at(const Expression& formula, std::size_t i,
                                        std::span<const std::optional<Polynomial>> below) {
  const Node& node = formula.node(i);
  if (node.is_variable()) return Polynomial{node.variable, {{0, 0}, {1, 1}}};
  if (node.is_constant()) {
    if (!std::isfinite(node.value)) return std::nullopt;
    return Polynomial{kNoVariable, {Interval::point(node.value)}};
  }
  const std::optional<Polynomial>& right = below[i - 1];
  if (!right) return std::nullopt;
  if (node.op == Op::neg) return Polynomial{right->variable, negated(right->coefficients)};
  if (arity(node.op) == 1) return std::nullopt;
  const std::optional<Polynomial>& left = below[formula.left_child(i)];
  return left ? combined(node.op, *left, *right) : std::nullopt;
}

std::size_t variables_below(const Expression& formula, std::size_t i) {
  std::size_t count = 0;
  for (std::size_t k = formula.begin(i); k <= i; ++k) count += formula.node(k).is_variable();
  return count;
}

// b_i = sum_j C(i, j) / C(n, j) c_j, where c are the coefficients of p(low + width t).
Coefficients bernstein(std::span<const Interval> powers, const Interval& x) {
  Coefficients c(powers.begin(), powers.end());
  const std::size_t n = c.size() - 1;
  const Interval low = Interval::point(x.low);
  const Interval width = subtract(Interval::point(x.high), low);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = n; j-- > i;) c[j] = add(c[j], multiply(low, c[j + 1]));
  }
  Interval scale{1, 1};
  double binomial = 1;  // C(n, j), exact up to the largest degree
  for (std::size_t j = 0; j <= n; ++j) {
    c[j] = divide(multiply(c[j], scale), Interval::point(binomial));
    scale = multiply(scale, width);
    binomial = binomial * static_cast<double>(n - j) / static_cast<double>(j + 1);
  }
  for (std::size_t k = 1; k <= n; ++k) {
    for (std::size_t j = n; j >= k; --j) c[j] = add(c[j], c[j - 1]);
  }
  return c;
}

// A part of the interval by its Bernstein coefficients, and the smallest of them.
struct Segment {
  explicit Segment(Coefficients coefficients) : b(std::move(coefficients)) {
    for (std::size_t k = 1; k < b.size(); ++k) {
      if (b[k].low < b[least].low) least = k;
    }
  }
  double bound() const { return b[least].low; }
  bool is_attained() const { return least == 0 || least + 1 == b.size(); }
  double reached() const { return std::min(b.front().high, b.back().high); }

  Coefficients b;
  std::size_t least = 0;
};

// De Casteljau at the middle: the left half's coefficients; `b` becomes the right half's.
Coefficients halve(Coefficients& b) {
  Coefficients left(b.size());
  for (std::size_t k = 0; k < left.size(); ++k) {
    left[k] = b.front();
    for (std::size_t j = 0; j + 1 < b.size() - k; ++j) {
      b[j] = multiply({0.5, 0.5}, add(b[j], b[j + 1]));
    }
  }
  return left;
}

// Not above the least value.
double least_value(Coefficients b) {
  double size = 0;
  for (const Interval& c : b) size = std::max(size, c.magnitude());
  std::vector<Segment> segments = {Segment(std::move(b))};
  double reached = segments.front().reached();
  for (int k = 0; k < kSubdivisions; ++k) {
    const auto lowest = std::ranges::min_element(segments, {}, &Segment::bound);
    if (lowest->is_attained() || reached - lowest->bound() <= kTolerance * size) break;
    Coefficients right = std::move(lowest->b);
    Segment left(halve(right));
    reached = std::min(reached, left.b.back().high);
    *lowest = std::move(left);
    segments.emplace_back(std::move(right));
  }
  return std::ranges::min_element(segments, {}, &Segment::bound)->bound();
}

}  // namespace

std::vector<std::optional<Polynomial>> polynomials_of(const Expression& formula) {
  std::vector<std::optional<Polynomial>> found(formula.size());
  for (std::size_t i = 0; i < formula.size(); ++i) found[i] = polynomial_at(formula, i, found);
  for (std::size_t i = formula.size(); i-- > 0;) {
    if (!found[i]) continue;
    const bool matters =
        !is_constant(*found[i]) && found[i]->degree() >= 2 && variables_below(formula, i) > 1;
    const std::size_t first = formula.begin(i);
    for (std::size_t k = first; k < i; ++k) found[k].reset();
    if (!matters) found[i].reset();
    i = first;
  }
  return found;
}

Interval polynomial_range(std::span<const Interval> coefficients, const Interval& x) {
  const Coefficients b = bernstein(coefficients, x);
  if (!std::ranges::all_of(b, &Interval::is_bounded)) return Interval::entire();
  return {least_value(b), -least_value(negated(b))};
}

}  // namespace tribench
