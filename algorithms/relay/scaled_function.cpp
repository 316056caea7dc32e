// SPDX-License-Identifier: MIT
#include "algorithms/relay/scaled_function.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>
#include <numeric>
#include <vector>

#include "algorithms/expression/build.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "algorithms/relay/golden_section.hpp"
#include "algorithms/relay/target_forms.hpp"
#include "algorithms/relay/unit_function.hpp"
#include "foundation/elementary.hpp"

namespace tribench::relay {
namespace {

using namespace build;

constexpr std::size_t kFewestScaledRows = 20;
constexpr std::size_t kCoarseRows = 64;
constexpr int kCoarseScales = 60;       // of a, from a hundredth to three thousand over the range
constexpr double kScaleStep = 1.3;      // from one of them to the next, at most
constexpr int kLimitScales = 20;        // of a below 0, by how near the last row is to the limit
constexpr double kNearestLimit = 1e-6;  // of the limit
// Of a function the combinations that are best on the grid of scales, and of these with a finer
// scale.
constexpr std::size_t kRefined = 40;
constexpr std::size_t kPolished = 6;
constexpr int kNarrowings = 20;            // of the scale, from a step of the grid to 1e-4 of it
constexpr double kPromisingSquare = 0.02;  // of the rows' relative square, on the coarse grid
constexpr std::array kForms = {TargetForm::plain, TargetForm::inverse, TargetForm::square,
                               TargetForm::inverse_square};
constexpr std::array kOuterPowers = {0.0, 0.5, -0.5, 1.0, -1.0, 1.5, -1.5, 2.0, -2.0, 3.0, -3.0};
constexpr std::array kInnerPowers = {1.0, -1.0, 0.5, -0.5, 2.0, -2.0};
using Kind = UnitFunction::Kind;
// From one of the powers a fit finds others.
constexpr std::array kFunctions = {UnitFunction{Kind::exponential}, UnitFunction{Kind::tanh},
                                   UnitFunction{Kind::atan},        UnitFunction{Kind::logarithm},
                                   UnitFunction{Kind::power, 0.5},  UnitFunction{Kind::power, -0.5},
                                   UnitFunction{Kind::power, 1.5},  UnitFunction{Kind::power, -1.5},
                                   UnitFunction{Kind::power, 2.5},  UnitFunction{Kind::power, -2.5},
                                   UnitFunction{Kind::cosh},        UnitFunction{Kind::sinh}};

struct Combination {
  std::size_t outer;  // T and p: their place among the outers
  double inner;       // q
  UnitFunction function;
  double scale;  // a
  double left;
};

// |p| is one of kOuterPowers or kInnerPowers. Whole powers as products: a fit that moves exponents
// leaves them alone.
Expression power_of_input(double p) {
  const Expression x = input(0);
  switch (static_cast<int>(2 * std::abs(p))) {
    case 1:
      return function(Op::sqrt, x);
    case 2:
      return x;
    case 3:
      return x * function(Op::sqrt, x);
    case 4:
      return x * x;
    default:
      return x * x * x;
  }
}

Expression scaled_by_power(const Expression& inside, double p) {
  if (p == 0) return inside;
  return p > 0 ? power_of_input(p) * inside : inside / power_of_input(p);
}

Expression inner_argument(double scale, double q) {
  return q > 0 ? constant(scale) * power_of_input(q) : constant(scale) / power_of_input(q);
}

class ScaledFunctionSearch {
 public:
  ScaledFunctionSearch(const LogRows& rows, const OperatorSet& operators)
      : rows_(rows),
        operators_(operators),
        x_(rows.inputs()[0].values),
        is_positive_(std::ranges::all_of(x_, [](double x) { return x > 0; })) {
    const std::size_t count = std::min(kCoarseRows, rows.rows());
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t r = i * rows.rows() / count;
      coarse_x_.push_back(x_[r]);
      coarse_y_.push_back(rows.target().values[r]);
    }
    for (const TargetForm form : kForms) {
      if (!keeps_sign(form) && rows.target().changes_sign) continue;
      const std::vector<double> z = formed_target(coarse_y_, form);
      for (const double p : kOuterPowers) {
        if (!is_possible(p)) continue;
        Outer outer{form, p, {}};
        for (std::size_t r = 0; r < count; ++r) {
          outer.relative.push_back(elementary::pow(coarse_x_[r], p) / z[r]);
        }
        outers_.push_back(std::move(outer));
      }
    }
  }

  std::optional<Expression> run(Budget& budget) {
    for (const UnitFunction& function : kFunctions) {
      if (!function.is_written_with(operators_)) continue;
      std::vector<Combination> best;
      for (const double q : kInnerPowers) {
        if (!is_possible(q)) continue;
        const std::uint64_t products = kCoarseScales * outers_.size() * coarse_x_.size();
        if (!budget.spend(products / 2)) return std::nullopt;
        look_at(function, q, best);
      }
      keep_best(best, kRefined);
      for (Combination& each : best) refine(each);
      keep_best(best, kPolished);
      std::ranges::move(best, std::back_inserter(best_));
    }
    std::ranges::stable_sort(best_, {}, &Combination::left);
    std::optional<Expression> shortest;
    for (const Combination& tried : best_) {
      if (tried.left > kPromisingSquare || budget.exhausted()) break;
      auto found = polished(tried, budget);
      if (found && (!shortest || found->size() < shortest->size())) shortest = std::move(found);
    }
    return shortest;
  }

 private:
  // T(y) and x^p on the coarse rows: x^p / T(y), so that 1 is what is to be explained.
  struct Outer {
    TargetForm form;
    double power;
    std::vector<double> relative;
  };

  // Roots are of positive inputs.
  bool is_possible(double power) const { return is_positive_ || power == std::trunc(power); }

  std::vector<double> scales(double q) const {
    double largest = 0;
    for (const double x : x_) largest = std::max(largest, std::abs(elementary::pow(x, q)));
    std::vector<double> result;
    for (int k = 0; k < kCoarseScales; ++k) {
      const double decades = -2.0 + 5.5 * k / (kCoarseScales - 1);
      result.push_back(elementary::exp(decades * std::numbers::ln10) / largest);
    }
    return result;
  }

  // Powers and logarithms of 1 + a x^q have a limit, which x stays below.
  static bool has_limit(const UnitFunction& function) {
    return function.kind == Kind::power || function.kind == Kind::logarithm;
  }

  double limit(double q) const {
    double largest = 0;
    for (const double x : x_) largest = std::max(largest, elementary::pow(x, q));
    return -1 / largest;
  }

  std::vector<double> scales_before_limit(double q) const {
    std::vector<double> result;
    for (int k = 1; k <= kLimitScales; ++k) {
      const double apart = elementary::pow(kNearestLimit, static_cast<double>(k) / kLimitScales);
      result.push_back(limit(q) * (1 - apart));
    }
    return result;
  }

  // Of c_0 + c_1 exp(a x^q) over many decades the largest rows tell a; no grid is as fine.
  double steepest(const Outer& outer, double q) const {
    const std::vector<double> z = formed_target(rows_.target().values, outer.form);
    std::vector<double> size(z.size());
    for (std::size_t r = 0; r < z.size(); ++r) {
      size[r] = std::abs(z[r]) / elementary::pow(x_[r], outer.power);
    }
    std::vector<std::size_t> order(z.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t r) { return size[r]; });
    const std::size_t first = order[0];
    const std::size_t other = order[order.size() / 20 + 1];
    return elementary::log(size[first] / size[other]) /
           (elementary::pow(x_[first], q) - elementary::pow(x_[other], q));
  }

  // Of one function all scales and what stands before it; the best scale of each.
  void look_at(const UnitFunction& function, double q, std::vector<Combination>& of_all) {
    std::vector<Combination> best;
    for (std::size_t k = 0; k < outers_.size(); ++k) best.push_back({k, q, function, 0, HUGE_VAL});
    std::vector<double> power(coarse_x_.size());
    for (std::size_t r = 0; r < power.size(); ++r) power[r] = elementary::pow(coarse_x_[r], q);
    std::vector<double> f(coarse_x_.size());
    const auto try_scale = [&](double scale, std::size_t from, std::size_t to) {
      for (std::size_t r = 0; r < f.size(); ++r) {
        f[r] = function.value(scale * power[r]);
      }
      for (std::size_t k = from; k < to; ++k) {
        const double left = left_of(outers_[k].relative, f);
        if (!(left < best[k].left)) continue;
        best[k].left = left;
        best[k].scale = scale;
      }
    };
    const bool is_exponential = function.kind == Kind::exponential;
    for (const double size : scales(q)) {
      try_scale(size, 0, outers_.size());
      if (is_exponential) try_scale(-size, 0, outers_.size());
    }
    if (has_limit(function)) {
      for (const double scale : scales_before_limit(q)) try_scale(scale, 0, outers_.size());
    }
    for (std::size_t k = 0; is_exponential && k < outers_.size(); ++k) {
      try_scale(steepest(outers_[k], q), k, k + 1);
    }
    of_all.insert(of_all.end(), best.begin(), best.end());
  }

  static void keep_best(std::vector<Combination>& combinations, std::size_t most) {
    std::ranges::stable_sort(combinations, {}, &Combination::left);
    combinations.resize(std::min(most, combinations.size()));
  }

  // The scale between those of the grid, by golden sections.
  void refine(Combination& combination) const {
    const std::vector<double>& relative = outers_[combination.outer].relative;
    std::vector<double> power(coarse_x_.size());
    for (std::size_t r = 0; r < power.size(); ++r) {
      power[r] = elementary::pow(coarse_x_[r], combination.inner);
    }
    std::vector<double> f(power.size());
    const auto left_at = [&](double scale) {
      for (std::size_t r = 0; r < f.size(); ++r) {
        f[r] = combination.function.value(scale * power[r]);
      }
      return left_of(relative, f);
    };
    double steepest = combination.scale * kScaleStep;
    if (has_limit(combination.function) && steepest < 0) {
      steepest = std::max(steepest, limit(combination.inner) * (1 - kNearestLimit));
    }
    const double scale =
        least_by_golden_sections(left_at, combination.scale / kScaleStep, steepest, kNarrowings);
    const double left = left_at(scale);
    if (left < combination.left) {
      combination.scale = scale;
      combination.left = left;
    }
  }

  // The mean square of 1 - s (c_0 + c_1 f) at the best c_0 and c_1.
  static double left_of(const std::vector<double>& s, const std::vector<double>& f) {
    double aa = 0, ab = 0, bb = 0, a = 0, b = 0;
    for (std::size_t r = 0; r < s.size(); ++r) {
      const double sf = s[r] * f[r];
      aa += s[r] * s[r];
      ab += s[r] * sf;
      bb += sf * sf;
      a += s[r];
      b += sf;
    }
    const double determinant = aa * bb - ab * ab;
    if (!(determinant > 1e-12 * aa * bb)) return HUGE_VAL;
    const double explained = (bb * a * a - 2 * ab * a * b + aa * b * b) / determinant;
    const double left = 1 - explained / static_cast<double>(s.size());
    return std::isfinite(left) ? std::max(left, 0.0) : HUGE_VAL;
  }

  std::optional<Expression> polished(const Combination& tried, Budget& budget) const {
    const Outer& outer = outers_[tried.outer];
    Expression formed = scaled_by_power(
        constant(1) +
            constant(1) * tried.function.formula(inner_argument(tried.scale, tried.inner)),
        outer.power);
    const std::vector<double> z = formed_target(rows_.target().values, outer.form);
    std::vector<double> weights = relative_scale(z, outer.form);
    for (double& w : weights) w *= w;
    const double* column = x_.data();
    ConstantFitOptions options;
    options.function_tolerance = 1e-15;
    options.max_iterations = 40;
    if (tried.function.kind == Kind::power) options.exponents = FitExponents::all;
    const ConstantFitResult fit =
        ConstantFitter().fit(formed, {{&column, 1}, x_.size()}, z, weights, options);
    budget.spend(fit.node_rows);
    const double sign = rows_.target().values[0] < 0 ? -1.0 : 1.0;
    Expression formula = solved_for_target(outer.form, formed, sign);
    if (!operators_.admits(formula) || !explains(formula, rows_)) return std::nullopt;
    return formula;
  }

  const LogRows& rows_;
  const OperatorSet& operators_;
  const std::vector<double>& x_;
  const bool is_positive_;
  std::vector<double> coarse_x_;
  std::vector<double> coarse_y_;
  std::vector<Outer> outers_;
  std::vector<Combination> best_;
};

}  // namespace

std::optional<Expression> find_scaled_function(const LogRows& rows, const OperatorSet& operators,
                                               Budget& budget) {
  const Factor& x = rows.inputs()[0];
  if (rows.rows() < kFewestScaledRows || !x.has_logs()) return std::nullopt;
  if (!operators.allows(Op::mul) || !operators.allows(Op::div) || !operators.allows(Op::add)) {
    return std::nullopt;
  }
  return ScaledFunctionSearch(rows, operators).run(budget);
}

}  // namespace tribench::relay
