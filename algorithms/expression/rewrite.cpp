// SPDX-License-Identifier: MIT
#include "algorithms/expression/rewrite.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "algorithms/expression/apply.hpp"
#include "algorithms/expression/bounds.hpp"
#include "algorithms/expression/build.hpp"
#include "algorithms/expression/edit.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/power_rewrites.hpp"
#include "algorithms/expression/singularity.hpp"
#include "algorithms/expression/sum_of_products.hpp"

namespace tribench {
namespace {

bool is_product(Op op) { return op == Op::mul || op == Op::div; }

bool is_function(const Expression& formula, Op op) { return formula.node(formula.root()).op == op; }
Expression argument_of(const Expression& formula) {
  return subtree(formula, formula.last_child(formula.root()));
}

// For every base on either side of the bar: the terms that have it, divided by the power that all
// of them hold.
void take_out_factors(const SumOfProducts& sum, std::vector<Expression>& out) {
  std::vector<TermFactor> seen;
  for (const SumTerm& term : sum) {
    for (const TermFactor& factor : term.factors) {
      const bool is_above = factor.power > 0;
      const auto same = [&](const TermFactor& other) {
        return other.base == factor.base && (other.power > 0) == is_above;
      };
      if (std::ranges::any_of(seen, same)) continue;
      seen.push_back(factor);
      SumOfProducts inside;
      SumOfProducts outside;
      int power = factor.power;
      for (const SumTerm& each : sum) {
        const auto found = std::ranges::find_if(each.factors, same);
        if (found == each.factors.end()) {
          outside.push_back(each);
          continue;
        }
        power = is_above ? std::min(power, found->power) : std::max(power, found->power);
        inside.push_back(each);
      }
      if (inside.size() < 2) continue;
      for (SumTerm& each : inside) {
        std::ranges::find_if(each.factors, same)->power -= power;
        std::erase_if(each.factors, [](const TermFactor& f) { return f.power == 0; });
      }
      SumTerm product;
      multiply_by(product, {formula_of(inside), 1});
      multiply_by(product, {factor.base, power});
      outside.push_back(std::move(product));
      out.push_back(formula_of(outside));
    }
  }
}

void take_out_numbers(const SumOfProducts& sum, std::vector<Expression>& out) {
  for (std::size_t first = 0; first < sum.size(); ++first) {
    const double size = std::abs(sum[first].coefficient);
    if (size == 1 || size == 0) continue;
    SumOfProducts inside;
    SumOfProducts outside;
    for (const SumTerm& term : sum) {
      (std::abs(term.coefficient) == size ? inside : outside).push_back(term);
    }
    if (inside.size() < 2 || std::abs(sum[first].coefficient) != size) continue;
    for (SumTerm& term : inside) term.coefficient = term.coefficient < 0 ? -1 : 1;
    outside.push_back({size, {{formula_of(inside), 1}}});
    out.push_back(formula_of(outside));
  }
}

void multiply_out(const SumTerm& term, std::vector<Expression>& out) {
  for (std::size_t i = 0; i < term.factors.size(); ++i) {
    const TermFactor& factor = term.factors[i];
    if (factor.power != 1 || !is_sum(factor.base.node(factor.base.root()).op)) continue;
    SumTerm rest = term;
    rest.factors.erase(rest.factors.begin() + static_cast<std::ptrdiff_t>(i));
    SumOfProducts sum = sum_of_products(factor.base, factor.base.root());
    for (SumTerm& each : sum) {
      each.coefficient *= rest.coefficient;
      for (const TermFactor& other : rest.factors) multiply_by(each, other);
    }
    out.push_back(formula_of(sum));
  }
}

// k exp(a + c) (d x + f y) = exp(a) (k e^c d x + k e^c f y): numbers of any size that only undo
// each other become one a term.
void absorb_numbers(const SumTerm& term, std::vector<Expression>& out) {
  SumTerm rest{1, {}};
  double log_scale = 0;
  for (const TermFactor& factor : term.factors) {
    TermFactor kept = factor;
    if (is_function(factor.base, Op::exp)) {
      const Expression argument = argument_of(factor.base);
      SumOfProducts exponent = sum_of_products(argument, argument.root());
      double constant = 0;
      for (const SumTerm& each : exponent) {
        if (each.factors.empty()) constant += factor.power * each.coefficient;
      }
      std::erase_if(exponent, [](const SumTerm& each) { return each.factors.empty(); });
      if (!exponent.empty()) {
        kept.base = Expression::unary(Op::exp, formula_of(exponent));
        log_scale += constant;
      }
    }
    rest.factors.push_back(std::move(kept));
  }
  if (log_scale == 0 && term.coefficient == 1) return;
  for (std::size_t i = 0; i < rest.factors.size(); ++i) {
    const TermFactor& factor = rest.factors[i];
    if (factor.power != 1 || !is_sum(factor.base.node(factor.base.root()).op)) continue;
    SumOfProducts sum = sum_of_products(factor.base, factor.base.root());
    bool is_finite = true;
    for (SumTerm& each : sum) {
      // By logarithms: neither e^c nor k need be a number by itself.
      const double size = std::abs(each.coefficient * term.coefficient);
      const double scaled =
          size > 0 && log_scale != 0 ? apply(Op::exp, apply(Op::log, size) + log_scale) : size;
      each.coefficient = std::copysign(scaled, each.coefficient * term.coefficient);
      is_finite = is_finite && scaled < 1e300 && (scaled > 1e-300 || size == 0);
    }
    SumTerm result = rest;
    result.factors[i].base = formula_of(sum);
    if (is_finite) out.push_back(formula_of(result));
  }
}

// The terms of `sum` with products of a sum and the sign `s` multiplied out, each with s at most
// once: s^2 is 1 where s is not 0.
SumOfProducts with_sign_once(const SumOfProducts& sum, const Expression& s) {
  SumOfProducts out;
  for (const SumTerm& term : sum) {
    const auto is_s = [&](const TermFactor& factor) { return factor.base == s; };
    const auto is_open = [&](const TermFactor& factor) {
      return factor.power == 1 && is_sum(factor.base.node(factor.base.root()).op);
    };
    const auto sign = std::ranges::find_if(term.factors, is_s);
    const auto open = std::ranges::find_if(term.factors, is_open);
    if (sign == term.factors.end()) {
      out.push_back(term);
    } else if (open != term.factors.end()) {
      SumTerm rest = term;
      rest.factors.erase(rest.factors.begin() + (open - term.factors.begin()));
      SumOfProducts inside = sum_of_products(open->base, open->base.root());
      for (SumTerm& each : inside) each = product_of(each, rest);
      for (SumTerm& each : with_sign_once(inside, s)) out.push_back(std::move(each));
    } else {
      SumTerm once = term;
      const bool is_odd = sign->power % 2 != 0;
      std::erase_if(once.factors, is_s);
      if (is_odd) multiply_by(once, {s, 1});
      out.push_back(std::move(once));
    }
  }
  return out;
}

// A product with a sum that has a logarithm in it is multiplied out: what stands beside the
// logarithm is its power.
SumOfProducts with_logarithms_apart(const SumOfProducts& sum) {
  const auto is_log = [](const TermFactor& factor) { return is_function(factor.base, Op::log); };
  SumOfProducts out;
  for (const SumTerm& term : sum) {
    SumOfProducts parts = {term};
    for (std::size_t i = 0; i < term.factors.size(); ++i) {
      const TermFactor& factor = term.factors[i];
      if (factor.power != 1 || !is_sum(factor.base.node(factor.base.root()).op)) continue;
      const SumOfProducts inside = sum_of_products(factor.base, factor.base.root());
      const bool has_log = std::ranges::any_of(
          inside, [&](const SumTerm& each) { return std::ranges::any_of(each.factors, is_log); });
      if (!has_log) continue;
      SumTerm rest = term;
      rest.factors.erase(rest.factors.begin() + static_cast<std::ptrdiff_t>(i));
      parts.clear();
      for (const SumTerm& each : inside) parts.push_back(product_of(rest, each));
      break;
    }
    out.insert(out.end(), parts.begin(), parts.end());
  }
  return out;
}

// s a + s^2 b as s a + b, with s written once.
Expression parted_by_sign(const Expression& sum, const Expression& s) {
  SumOfProducts odd;
  SumOfProducts even;
  for (SumTerm& term : with_sign_once(sum_of_products(sum, sum.root()), s)) {
    const auto sign = std::ranges::find(term.factors, s, &TermFactor::base);
    if (sign == term.factors.end()) {
      even.push_back(std::move(term));
      continue;
    }
    term.factors.erase(sign);
    odd.push_back(std::move(term));
  }
  if (!odd.empty()) even.push_back({1, {{s, 1}, {formula_of(odd), 1}}});
  return formula_of(even);
}

// sin(x + k pi/2) and cos(x + k pi/2) are sin x and cos x, one for the other where k is odd.
void take_quarter_turns_out(Op op, const Expression& argument, std::vector<Expression>& out) {
  constexpr double kQuarter = std::numbers::pi / 2;
  constexpr int kMostQuarters = 400;  // a multiple of 4
  SumOfProducts sum = sum_of_products(argument, argument.root());
  const auto turned = std::ranges::find_if(sum, [](const SumTerm& t) { return t.factors.empty(); });
  if (sum.size() < 2 || turned == sum.end()) return;
  const double quarters = std::round(turned->coefficient / kQuarter);
  const bool is_exact = std::abs(turned->coefficient - quarters * kQuarter) <= kNegligible;
  if (quarters == 0 || std::abs(quarters) > kMostQuarters || !is_exact) return;
  sum.erase(turned);
  // A cosine is a sine that is a quarter ahead.
  const int ahead = (static_cast<int>(quarters) + (op == Op::cos ? 1 : 0) + kMostQuarters) % 4;
  Expression wave = Expression::unary(ahead % 2 == 0 ? Op::sin : Op::cos, formula_of(sum));
  out.push_back(ahead < 2 ? std::move(wave) : Expression::unary(Op::neg, wave));
}

}  // namespace

// ---- sums

void Rewriter::drop_negligible(const SumOfProducts& sum, std::vector<Expression>& out) const {
  for (std::size_t i = 0; i < sum.size(); ++i) {
    SumOfProducts rest = sum;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
    const double largest = range(formula_of(sum[i])).magnitude();
    const Expression others = formula_of(rest);
    if (largest <= kNegligible * range(others).mignitude()) out.push_back(others);
  }
}

void Rewriter::rewrite_sum(const SumOfProducts& sum, std::vector<Expression>& out) const {
  take_out_factors(sum, out);
  take_out_numbers(sum, out);
  drop_negligible(sum, out);
  complete_squares(sum, out);
}

// ---- products

bool Rewriter::is_sign_of(const Expression& sign, const Expression& whole) const {
  if (is_function(sign, Op::sgn)) return argument_of(sign) == whole;
  if (sign.size() != 1 || !sign.node(0).is_variable() || whole.size() != 1) return false;
  const auto& base = box_[sign.node(0).variable].sign_of;
  return base && whole.node(0).is_variable() && whole.node(0).variable == *base;
}

// Two factors as one, or one as what it is the root or the magnitude of.
void Rewriter::merge_pairs(const SumTerm& term, std::vector<Expression>& out) const {
  const auto with = [&](std::size_t i, std::size_t j, const std::vector<TermFactor>& merged) {
    SumTerm result{term.coefficient, {}};
    for (std::size_t k = 0; k < term.factors.size(); ++k) {
      if (k != i && k != j) multiply_by(result, term.factors[k]);
    }
    for (const TermFactor& each : merged) {
      if (each.power != 0) multiply_by(result, each);
    }
    out.push_back(formula_of(result));
  };
  using build::operator*;
  for (std::size_t i = 0; i < term.factors.size(); ++i) {
    const auto& [a, m] = term.factors[i];
    const bool has_bounded_root = is_function(a, Op::sqrt) && range(a).is_bounded();
    if (is_function(a, Op::exp) && m != 1) {
      with(i, i, {{Expression::unary(Op::exp, build::constant(m) * argument_of(a)), 1}});
    }
    if (has_bounded_root && m % 2 == 0) with(i, i, {{argument_of(a), m / 2}});
    if (is_function(a, Op::abs) && m % 2 == 0) with(i, i, {{argument_of(a), m}});
    for (std::size_t j = 0; j < term.factors.size(); ++j) {
      const auto& [b, n] = term.factors[j];
      if (i < j && is_function(a, Op::exp) && is_function(b, Op::exp)) {
        const Expression both =
            build::sum_of(build::constant(m) * argument_of(a), build::constant(n) * argument_of(b));
        with(i, j, {{Expression::unary(Op::exp, both), 1}});
      }
      if (i < j && has_bounded_root && is_function(b, Op::sqrt) && m == n &&
          range(b).is_bounded()) {
        with(i, j, {{Expression::unary(Op::sqrt, argument_of(a) * argument_of(b)), m}});
      }
      if (i == j || m != 1 || n < 1) continue;
      if (is_sign_of(a, b)) with(i, j, {{Expression::unary(Op::abs, b), 1}, {b, n - 1}});
      if (is_function(b, Op::abs) && is_sign_of(a, argument_of(b))) {
        with(i, j, {{argument_of(b), 1}, {b, n - 1}});
      }
    }
  }
}

// Beside a sign s, which makes 0 of all where it is 0, every other s^2 is 1: s f(s (a - s b)) is
// s f(s a - b).
void Rewriter::use_sign(const SumTerm& term, std::vector<Expression>& out) const {
  for (const TermFactor& sign : term.factors) {
    const Expression& s = sign.base;
    const bool is_input = s.size() == 1 && s.node(0).is_variable() &&
                          s.node(0).variable < box_.size() && box_[s.node(0).variable].sign_of;
    if (sign.power < 1 || !(is_input || is_function(s, Op::sgn))) continue;
    for (std::size_t i = 0; i < term.factors.size(); ++i) {
      const Expression& base = term.factors[i].base;
      const Op op = base.node(base.root()).op;
      SumTerm result = term;
      if (is_sum(op)) {
        result.factors[i].base = parted_by_sign(base, s);
      } else if (arity(op) == 1 && op != Op::neg) {
        result.factors[i].base = Expression::unary(op, parted_by_sign(argument_of(base), s));
      } else {
        continue;
      }
      out.push_back(formula_of(result));
    }
  }
}

void Rewriter::rewrite_product(const SumTerm& term, std::vector<Expression>& out) const {
  out.push_back(formula_of(term));
  multiply_out(term, out);
  clear_fractions(term, out);
  take_whole_part_out(term, out);
  open_denominators(term, out);
  spread_exponentials(term, out);
  merge_powers(term, range_, out);
  merge_whole_powers(term, out);
  merge_powers_of_one_base(term, range_, out);
  take_below_root(term, range_, out);
  absorb_numbers(term, out);
  use_sign(term, out);
  merge_pairs(term, out);
}

// ---- functions

// exp(a + c) = e^c exp(a), exp(log x) = x, exp(a log x) = x^a, exp(a (log x + b)) = e^(a b) x^a.
void Rewriter::rewrite_exp(const Expression& argument, std::vector<Expression>& out) const {
  const SumOfProducts sum = with_logarithms_apart(sum_of_products(argument, argument.root()));
  for (std::size_t i = 0; i < sum.size(); ++i) {
    SumOfProducts rest = sum;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
    SumTerm product;
    if (!rest.empty()) multiply_by(product, {Expression::unary(Op::exp, formula_of(rest)), 1});
    const SumTerm& term = sum[i];
    if (term.factors.empty()) {
      const double scale = apply(Op::exp, term.coefficient);
      if (!(scale > 1e-300 && scale < 1e300)) continue;
      product.coefficient = scale;
    } else if (term.factors.size() == 1 && term.factors[0].power == 1 &&
               is_function(term.factors[0].base, Op::log) && is_product_power(term.coefficient)) {
      multiply_by(product, {argument_of(term.factors[0].base), static_cast<int>(term.coefficient)});
    } else {
      const auto log = std::ranges::find_if(term.factors, [&](const TermFactor& factor) {
        return factor.power == 1 && is_function(factor.base, Op::log);
      });
      if (log == term.factors.end() || !(range(argument_of(log->base)).low > 0)) continue;
      SumTerm exponent = term;
      exponent.factors.erase(exponent.factors.begin() + (log - term.factors.begin()));
      multiply_by(product,
                  {Expression::binary(Op::pow, argument_of(log->base), formula_of(exponent)), 1});
    }
    out.push_back(formula_of(product));
  }
}

// log exp x = x; log sqrt x = log(x) / 2, log x^a = a log x where x is positive.
void Rewriter::rewrite_log(const Expression& argument, std::vector<Expression>& out) const {
  using build::operator*;
  if (is_function(argument, Op::exp)) out.push_back(argument_of(argument));
  if (is_function(argument, Op::sqrt)) {
    out.push_back(build::constant(0.5) * Expression::unary(Op::log, argument_of(argument)));
  }
  if (!is_function(argument, Op::pow)) return;
  const Expression base = subtree(argument, argument.left_child(argument.root()));
  const Expression exponent = subtree(argument, argument.last_child(argument.root()));
  if (range(base).low > 0) out.push_back(exponent * Expression::unary(Op::log, base));
}

// sqrt(c x^2 y) = sqrt(c) |x| sqrt(y), sqrt(exp x) = exp(x / 2).
void Rewriter::rewrite_sqrt(const Expression& argument, std::vector<Expression>& out) const {
  using build::operator*;
  if (is_function(argument, Op::exp)) {
    out.push_back(Expression::unary(Op::exp, build::constant(0.5) * argument_of(argument)));
  }
  const SumOfProducts sum = sum_of_products(argument, argument.root());
  if (sum.size() != 1) return;
  turn_root(argument, range_, out);
  const SumTerm& inside = sum[0];
  if (inside.coefficient > 0 && inside.coefficient != 1 && !inside.factors.empty()) {
    SumTerm rest = inside;
    rest.coefficient = 1;
    out.push_back(formula_of(SumTerm{std::sqrt(inside.coefficient),
                                     {{Expression::unary(Op::sqrt, formula_of(rest)), 1}}}));
  }
  for (std::size_t i = 0; i < inside.factors.size(); ++i) {
    const TermFactor& factor = inside.factors[i];
    if (factor.power < 2 || factor.power % 2 != 0) continue;
    SumTerm rest = inside;
    rest.factors.erase(rest.factors.begin() + static_cast<std::ptrdiff_t>(i));
    SumTerm product;
    const Expression root = power_of(factor.base, factor.power / 2);
    multiply_by(product, {Expression::unary(Op::abs, root), 1});
    if (range(factor.base).low >= 0) product.factors[0] = {root, 1};
    if (!rest.factors.empty() || rest.coefficient != 1) {
      multiply_by(product, {Expression::unary(Op::sqrt, formula_of(rest)), 1});
    }
    out.push_back(formula_of(product));
  }
}

// By the first term that is left out: x^3 / 3 of tanh and atan, x^3 / 6 of sin, x^2 / 2 of exp and
// cos.
void Rewriter::replace_small(Op op, const Expression& argument,
                             std::vector<Expression>& out) const {
  const Interval x = range(argument);
  const double largest = x.magnitude();
  const double square = largest * largest;
  const bool is_linear = ((op == Op::tanh || op == Op::atan) && square / 3 <= kNegligible) ||
                         (op == Op::sin && square / 6 <= kNegligible);
  if (is_linear) out.push_back(argument);
  if (op == Op::exp && square <= kNegligible) {
    out.push_back(Expression::binary(Op::add, argument, Expression::constant(1)));
  }
  if (op == Op::exp && 2 * largest <= kNegligible) out.push_back(Expression::constant(1));
  if (op == Op::cos && square / 2 <= kNegligible) out.push_back(Expression::constant(1));
  constexpr double kSaturated = 14.2;  // 1 - tanh is below 1e-12 from here on
  if (op == Op::tanh && x.mignitude() >= kSaturated) {
    out.push_back(Expression::constant(x.low > 0 ? 1 : -1));
  }
}

void Rewriter::rewrite_function(Op op, const Expression& argument,
                                std::vector<Expression>& out) const {
  if (op == Op::exp) rewrite_exp(argument, out);
  if (op == Op::sqrt) rewrite_sqrt(argument, out);
  if (op == Op::log) rewrite_log(argument, out);
  if (op == Op::sin || op == Op::cos) take_quarter_turns_out(op, argument, out);
  if (op == Op::abs) {
    const Interval x = range(argument);
    if (x.low >= 0) out.push_back(argument);
    if (x.high <= 0) out.push_back(Expression::unary(Op::neg, argument));
  }
  replace_small(op, argument, out);
}

// ---- facts

Interval Rewriter::range(const Expression& formula) const {
  if (columns_used(formula) > box_.size()) return Interval::entire();
  std::optional<Interval> all;
  FormulaBounds bounds(formula);
  for (const std::vector<Interval>& cell : sign_cells(formula, box_)) {
    if (!bounds.sharpen(cell)) return Interval::entire();
    all = all ? hull(*all, bounds.root().range) : bounds.root().range;
  }
  return all.value_or(Interval::entire());
}

std::vector<Expression> Rewriter::rewrites(const Expression& formula) const {
  std::vector<Expression> all;
  std::vector<Expression> here;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const Op op = formula.node(i).op;
    here.clear();
    if (is_sum(op)) {
      const std::size_t parent = parent_of(formula, i);
      const bool is_inner = parent < formula.size() && is_sum(formula.node(parent).op);
      if (!is_inner) rewrite_sum(sum_of_products(formula, i), here);
    } else if (is_product(op) || op == Op::pow) {
      const std::size_t parent = parent_of(formula, i);
      const bool is_inner = parent < formula.size() && is_product(formula.node(parent).op);
      if (!is_inner) rewrite_product(sum_of_products(formula, i)[0], here);
      if (op == Op::pow) {
        rewrite_power(subtree(formula, formula.left_child(i)),
                      subtree(formula, formula.last_child(i)), range_, here);
      }
    } else if (arity(op) == 1 && op != Op::neg) {
      rewrite_function(op, subtree(formula, formula.last_child(i)), here);
    }
    for (const Expression& piece : here) {
      if (piece.empty()) continue;
      Expression whole;
      splice(formula, i, piece.nodes(), whole);
      all.push_back(std::move(whole));
    }
  }
  return all;
}

}  // namespace tribench
