// SPDX-License-Identifier: MIT
#include "algorithms/expression/power_rewrites.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "algorithms/expression/apply.hpp"
#include "algorithms/expression/build.hpp"
#include "algorithms/expression/edit.hpp"
#include "foundation/elementary.hpp"

namespace tribench {
namespace {

using build::operator*;

Op op_of(const Expression& formula) { return formula.node(formula.root()).op; }
bool is_a_sum(const Expression& formula) { return is_sum(op_of(formula)); }
bool is_exp(const TermFactor& factor) { return op_of(factor.base) == Op::exp; }
Expression inside_of(const Expression& formula) {
  return subtree(formula, formula.last_child(formula.root()));
}

std::ptrdiff_t index_of(std::size_t i) { return static_cast<std::ptrdiff_t>(i); }

SumTerm without(const SumTerm& term, std::size_t i) {
  SumTerm rest = term;
  rest.factors.erase(rest.factors.begin() + index_of(i));
  return rest;
}

// The root of a term without its coefficient; none where a power is odd.
std::optional<SumTerm> root_of(const SumTerm& term) {
  SumTerm root{1, {}};
  for (const TermFactor& factor : term.factors) {
    if (factor.power % 2 != 0) return std::nullopt;
    root.factors.push_back({factor.base, factor.power / 2});
  }
  return root;
}

// The power of a base above the bar less that below it.
int net_power(const SumTerm& term, const Expression& base) {
  int power = 0;
  for (const TermFactor& factor : term.factors) power += factor.base == base ? factor.power : 0;
  return power;
}

// In any order, where no base is 0.
bool same_factors(const SumTerm& a, const SumTerm& b) {
  const auto agree = [&](const TermFactor& factor) {
    return net_power(a, factor.base) == net_power(b, factor.base);
  };
  return std::ranges::all_of(a.factors, agree) && std::ranges::all_of(b.factors, agree);
}

// What stands below a bar in one of two sums, with the highest power that it has there.
std::vector<TermFactor> bases_below(const SumOfProducts& a, const SumOfProducts& b) {
  std::vector<TermFactor> bases;
  for (const SumOfProducts* sum : {&a, &b}) {
    for (const SumTerm& term : *sum) {
      for (const TermFactor& factor : term.factors) {
        if (factor.power >= 0) continue;
        const auto same = std::ranges::find(bases, factor.base, &TermFactor::base);
        if (same == bases.end()) {
          bases.push_back({factor.base, -factor.power});
        } else {
          same->power = std::max(same->power, -factor.power);
        }
      }
    }
  }
  return bases;
}

SumOfProducts multiplied(SumOfProducts sum, const TermFactor& by) {
  for (SumTerm& term : sum) {
    int left = by.power;
    for (TermFactor& factor : term.factors) {
      if (factor.base != by.base || factor.power >= 0) continue;
      const int cancelled = std::min(left, -factor.power);
      factor.power += cancelled;
      left -= cancelled;
    }
    std::erase_if(term.factors, [](const TermFactor& factor) { return factor.power == 0; });
    if (left > 0) multiply_by(term, {by.base, left});
  }
  return sum;
}

// The factors that stand together above the bar where all of the term stands below it.
std::optional<SumTerm> turned(const SumTerm& term) {
  SumTerm out{1, {}};
  for (const TermFactor& factor : term.factors) {
    if (factor.power >= 0) return std::nullopt;
    out.factors.push_back({factor.base, -factor.power});
  }
  if (out.factors.empty()) return std::nullopt;
  return out;
}

constexpr std::size_t kMostMultipliedOut = 16;  // terms

// Products with sums above the bar as sums; what has more terms than kMostMultipliedOut stays.
SumOfProducts multiplied_out(const SumTerm& term) {
  const auto sum = std::ranges::find_if(term.factors, [](const TermFactor& factor) {
    return factor.power == 1 && is_a_sum(factor.base);
  });
  if (sum == term.factors.end()) return {term};
  const SumTerm rest = without(term, static_cast<std::size_t>(sum - term.factors.begin()));
  SumOfProducts out;
  for (const SumTerm& each : sum_of_products(sum->base, sum->base.root())) {
    for (SumTerm& product : multiplied_out(product_of(rest, each))) {
      out.push_back(std::move(product));
    }
    if (out.size() > kMostMultipliedOut) return {term};
  }
  return out;
}

// sum - share * other, without the terms that only rounding leaves.
SumOfProducts less_multiple(SumOfProducts sum, double share, const SumOfProducts& other) {
  for (const SumTerm& each : other) {
    const double taken = share * each.coefficient;
    const auto same =
        std::ranges::find_if(sum, [&](const SumTerm& term) { return same_factors(term, each); });
    if (same == sum.end()) {
      sum.push_back({-taken, each.factors});
      continue;
    }
    const double size = std::abs(same->coefficient);
    same->coefficient -= taken;
    if (std::abs(same->coefficient) <= kNegligible * size) sum.erase(same);
  }
  return sum;
}

}  // namespace

// (a/c + b) / (d/c + e) = (a + b c) / (d + e c), for every c below a bar.
void clear_fractions(const SumTerm& term, std::vector<Expression>& out) {
  const auto is_sum_factor = [&](const TermFactor& factor, int power) {
    return factor.power == power && is_a_sum(factor.base);
  };
  for (std::size_t i = 0; i < term.factors.size(); ++i) {
    for (std::size_t j = 0; j < term.factors.size(); ++j) {
      if (!is_sum_factor(term.factors[i], 1) || !is_sum_factor(term.factors[j], -1)) continue;
      const SumOfProducts above =
          sum_of_products(term.factors[i].base, term.factors[i].base.root());
      const SumOfProducts below =
          sum_of_products(term.factors[j].base, term.factors[j].base.root());
      for (const TermFactor& cleared : bases_below(above, below)) {
        SumTerm result = term;
        result.factors[i].base = formula_of(multiplied(above, cleared));
        result.factors[j].base = formula_of(multiplied(below, cleared));
        out.push_back(formula_of(result));
      }
    }
  }
}

// (a + k b + k c) / (b + c) = k + a / (b + c), products of sums above the bar multiplied out.
void take_whole_part_out(const SumTerm& term, std::vector<Expression>& out) {
  for (std::size_t i = 0; i < term.factors.size(); ++i) {
    for (std::size_t j = 0; j < term.factors.size(); ++j) {
      const TermFactor& above = term.factors[i];
      const TermFactor& below = term.factors[j];
      if (above.power != 1 || below.power != -1 || !is_a_sum(above.base) || !is_a_sum(below.base)) {
        continue;
      }
      const SumOfProducts whole = multiplied_out({1, {above}});
      const SumOfProducts divisor = sum_of_products(below.base, below.base.root());
      for (const SumTerm& first : divisor) {
        const auto same = std::ranges::find_if(
            whole, [&](const SumTerm& each) { return same_factors(each, first); });
        if (same == whole.end() || first.coefficient == 0) continue;
        const double share = same->coefficient / first.coefficient;
        const SumOfProducts rest = less_multiple(whole, share, divisor);
        if (rest.empty() || rest.size() >= whole.size()) continue;
        SumTerm part = without(without(term, std::max(i, j)), std::min(i, j));
        part.coefficient *= share;
        SumTerm left = term;
        left.factors[i].base = formula_of(rest);
        out.push_back(formula_of(SumOfProducts{part, left}));
      }
    }
  }
}

void complete_squares(const SumOfProducts& sum, std::vector<Expression>& out) {
  constexpr double kSameNumber = 1e-14;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const std::optional<SumTerm> first = root_of(sum[i]);
    for (std::size_t j = i + 1; first && j < sum.size(); ++j) {
      const std::optional<SumTerm> second = root_of(sum[j]);
      if (!second || !(sum[i].coefficient * sum[j].coefficient > 0)) continue;
      const double ratio = std::sqrt(sum[j].coefficient / sum[i].coefficient);
      const double twice = 2 * ratio * std::abs(sum[i].coefficient);
      const SumTerm both = product_of(*first, *second);
      for (std::size_t k = 0; k < sum.size(); ++k) {
        const double size = std::abs(sum[k].coefficient);
        if (k == i || k == j || !(std::abs(size - twice) <= kSameNumber * twice)) continue;
        if (!same_factors(sum[k], both)) continue;
        SumTerm other = *second;
        other.coefficient = sum[k].coefficient * sum[i].coefficient > 0 ? ratio : -ratio;
        SumOfProducts rest;
        for (std::size_t m = 0; m < sum.size(); ++m) {
          if (m != i && m != j && m != k) rest.push_back(sum[m]);
        }
        rest.push_back({sum[i].coefficient, {{formula_of(SumOfProducts{*first, other}), 2}}});
        out.push_back(formula_of(rest));
      }
    }
  }
}

void merge_powers(const SumTerm& term, const RangeOf& range, std::vector<Expression>& out) {
  const auto base_of = [](const TermFactor& factor) {
    return subtree(factor.base, factor.base.left_child(factor.base.root()));
  };
  const auto is_power = [](const TermFactor& factor) {
    return op_of(factor.base) == Op::pow && std::abs(factor.power) == 1;
  };
  for (std::size_t i = 0; i < term.factors.size(); ++i) {
    if (!is_power(term.factors[i])) continue;
    Expression exponent = inside_of(term.factors[i].base);
    // 1 with this exponent, -1 with that of the other sign, 0 where it is another power or none.
    const auto side_of = [&](const TermFactor& factor) {
      if (!is_power(factor) || !(range(base_of(factor)).low > 0)) return 0;
      const Expression other = inside_of(factor.base);
      if (other == exponent) return 1;
      const Node& a = exponent.node(exponent.root());
      const Node& b = other.node(other.root());
      return a.is_constant() && b.is_constant() && a.value == -b.value ? -1 : 0;
    };
    const auto belongs = [&](const TermFactor& factor) { return side_of(factor) != 0; };
    // Once for every exponent: by its first.
    const auto first = std::ranges::find_if(term.factors, belongs);
    if (first != term.factors.begin() + index_of(i)) continue;
    if (std::ranges::count_if(term.factors, belongs) < 2) continue;
    // Of the two ways to write a ratio the one with the positive exponent.
    const bool has_both_signs =
        std::ranges::any_of(term.factors, [&](const auto& factor) { return side_of(factor) < 0; });
    const double c = exponent.node(exponent.root()).value;
    const int turn = has_both_signs && c < 0 ? -1 : 1;
    SumTerm base;
    SumTerm result{term.coefficient, {}};
    for (const TermFactor& factor : term.factors) {
      const int side = side_of(factor);
      if (side != 0) {
        multiply_by(base, {base_of(factor), turn * side * factor.power});
      } else {
        result.factors.push_back(factor);
      }
    }
    if (turn < 0) exponent = build::constant(-c);
    multiply_by(result, {Expression::binary(Op::pow, formula_of(base), exponent), 1});
    out.push_back(formula_of(result));
  }
}

namespace {

struct PowerOfBase {
  Expression base;
  double exponent = 1;
};

// What a factor is a power of: roots and constant exponents are looked through.
PowerOfBase power_of(const TermFactor& factor) {
  const double power = factor.power;
  if (op_of(factor.base) == Op::sqrt) return {inside_of(factor.base), 0.5 * power};
  if (op_of(factor.base) == Op::pow) {
    const Node& exponent = factor.base.node(factor.base.last_child(factor.base.root()));
    const Expression base = subtree(factor.base, factor.base.left_child(factor.base.root()));
    if (exponent.is_constant()) return {base, exponent.value * power};
  }
  return {factor.base, power};
}

}  // namespace

void merge_powers_of_one_base(const SumTerm& term, const RangeOf& range,
                              std::vector<Expression>& out) {
  for (std::size_t i = 0; i < term.factors.size(); ++i) {
    const PowerOfBase first = power_of(term.factors[i]);
    for (std::size_t j = i + 1; j < term.factors.size(); ++j) {
      const PowerOfBase second = power_of(term.factors[j]);
      if (!(second.base == first.base)) continue;
      const double exponent = first.exponent + second.exponent;
      // At 0 the product may have no value where the power has one, never the other way round.
      const double low = range(first.base).low;
      if (!(low > 0) && !(low >= 0 && exponent > 0)) continue;
      SumTerm merged = without(without(term, j), i);
      const Expression power =
          exponent == 0.5 ? Expression::unary(Op::sqrt, first.base)
                          : Expression::binary(Op::pow, first.base, build::constant(exponent));
      multiply_by(merged, {power, 1});
      out.push_back(formula_of(merged));
    }
  }
}

void take_below_root(const SumTerm& term, const RangeOf& range, std::vector<Expression>& out) {
  for (std::size_t i = 0; i < term.factors.size(); ++i) {
    const TermFactor& root = term.factors[i];
    if (root.power != 1 || op_of(root.base) != Op::sqrt) continue;
    const Expression inside = inside_of(root.base);
    if (!is_a_sum(inside)) continue;
    const SumOfProducts sum = sum_of_products(inside, inside.root());
    for (const TermFactor& below : bases_below(sum, {})) {
      const auto taken = std::ranges::find_if(term.factors, [&](const TermFactor& factor) {
        return factor.base == below.base && factor.power == 1;
      });
      if (taken == term.factors.end() || !(range(below.base).low > 0)) continue;
      SumTerm result = term;
      result.factors[i].base =
          Expression::unary(Op::sqrt, formula_of(multiplied(sum, {below.base, 2})));
      out.push_back(
          formula_of(without(result, static_cast<std::size_t>(taken - term.factors.begin()))));
    }
  }
}

void merge_whole_powers(const SumTerm& term, std::vector<Expression>& out) {
  for (std::size_t i = 0; i < term.factors.size(); ++i) {
    const int power = std::abs(term.factors[i].power);
    const auto belongs = [&](const TermFactor& factor) { return std::abs(factor.power) == power; };
    // Once for every power: by its first.
    if (power < 2 ||
        std::any_of(term.factors.begin(), term.factors.begin() + index_of(i), belongs)) {
      continue;
    }
    SumTerm result{term.coefficient, {}};
    SumTerm merged;
    int above = 0;
    for (const TermFactor& factor : term.factors) {
      if (belongs(factor)) {
        merged.factors.push_back({factor.base, factor.power / power});
        above += factor.power > 0 ? 1 : 0;
      } else {
        result.factors.push_back(factor);
      }
    }
    if (merged.factors.size() < 2) continue;
    // Below the bar alone: the bar stays outside.
    if (above == 0) {
      for (TermFactor& factor : merged.factors) factor.power = 1;
    }
    multiply_by(result, {formula_of(merged), above == 0 ? -power : power});
    out.push_back(formula_of(result));
  }
}

void open_denominators(const SumTerm& term, std::vector<Expression>& out) {
  for (std::size_t i = 0; i < term.factors.size(); ++i) {
    const TermFactor& factor = term.factors[i];
    if (factor.power != -1 || !is_a_sum(factor.base)) continue;
    const SumOfProducts below = sum_of_products(factor.base, factor.base.root());
    for (const TermFactor& cleared : bases_below(below, {})) {
      SumTerm result = without(term, i);
      multiply_by(result, cleared);
      multiply_by(result, {formula_of(multiplied(below, cleared)), -1});
      out.push_back(formula_of(result));
    }
  }
}

void spread_exponentials(const SumTerm& term, std::vector<Expression>& out) {
  for (std::size_t i = 0; i < term.factors.size(); ++i) {
    if (!is_exp(term.factors[i])) continue;
    for (std::size_t j = 0; j < term.factors.size(); ++j) {
      const TermFactor& power = term.factors[j];
      if (power.power < 2 || !is_a_sum(power.base)) continue;
      const Expression part =
          build::constant(static_cast<double>(term.factors[i].power) / power.power) *
          inside_of(term.factors[i].base);
      SumOfProducts sum = sum_of_products(power.base, power.base.root());
      if (std::ranges::none_of(
              sum, [](const SumTerm& each) { return std::ranges::any_of(each.factors, is_exp); })) {
        continue;
      }
      for (SumTerm& each : sum) {
        const auto own = std::ranges::find_if(each.factors, is_exp);
        Expression argument = part;
        if (own != each.factors.end()) {
          argument = build::sum_of(build::constant(own->power) * inside_of(own->base), part);
          each.factors.erase(own);
        }
        multiply_by(each, {Expression::unary(Op::exp, argument), 1});
      }
      SumTerm result = term;
      result.factors[j].base = formula_of(sum);
      out.push_back(formula_of(without(result, i)));
    }
  }
}

void turn_root(const Expression& argument, const RangeOf& range, std::vector<Expression>& out) {
  const SumOfProducts sum = sum_of_products(argument, argument.root());
  if (sum.size() != 1 || !(sum[0].coefficient > 0)) return;
  const std::optional<SumTerm> below = turned(sum[0]);
  if (!below || !(range(formula_of(*below)).low > 0)) return;
  SumTerm result{std::sqrt(sum[0].coefficient), {}};
  multiply_by(result, {Expression::unary(Op::sqrt, formula_of(*below)), -1});
  out.push_back(formula_of(result));
}

void rewrite_power(const Expression& base, const Expression& exponent, const RangeOf& range,
                   std::vector<Expression>& out) {
  const Node& power = exponent.node(exponent.root());
  if (power.is_constant() && power.value == 0.5) {
    out.push_back(Expression::unary(Op::sqrt, base));
  }
  if (power.is_constant() && op_of(base) == Op::sqrt) {
    out.push_back(Expression::binary(Op::pow, inside_of(base), build::constant(0.5 * power.value)));
  }
  const Interval x = range(base);
  if (!(x.low > 0) || !x.is_bounded()) return;
  const double largest_log =
      std::max(std::abs(elementary::log(x.low)), std::abs(elementary::log(x.high)));
  if (range(exponent).magnitude() * largest_log <= kNegligible) {
    out.push_back(build::constant(1));
  }
  const SumOfProducts sum = sum_of_products(base, base.root());
  if (sum.size() != 1 || !power.is_constant() || !(sum[0].coefficient > 0)) return;
  const std::optional<SumTerm> below = turned(sum[0]);
  const double scale = apply(Op::pow, sum[0].coefficient, power.value);
  if (!(scale > 1e-300 && scale < 1e300)) return;
  if (sum[0].coefficient != 1 && !sum[0].factors.empty()) {
    const SumTerm plain{1, sum[0].factors};
    SumTerm scaled{scale, {}};
    multiply_by(scaled, {Expression::binary(Op::pow, formula_of(plain), exponent), 1});
    out.push_back(formula_of(scaled));
  }
  if (!below) return;
  SumTerm result{scale, {}};
  multiply_by(result,
              {Expression::binary(Op::pow, formula_of(*below), build::constant(-power.value)), 1});
  out.push_back(formula_of(result));
}

}  // namespace tribench
