// SPDX-License-Identifier: MIT
#include "algorithms/relay/scaled_function.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <vector>

#include "algorithms/expression/build.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "algorithms/relay/target_forms.hpp"
#include "foundation/elementary.hpp"

namespace tribench::relay {
namespace {

using namespace build;

constexpr std::size_t kFewestScaledRows = 20;
constexpr std::size_t kCoarseRows = 64;
constexpr int kCoarseScales = 60;      // of a, from a hundredth to three thousand over the range
constexpr std::size_t kPolished = 60;  // of the best combinations
constexpr double kPromisingSquare = 0.02;  // of the rows' relative square, on the coarse grid
constexpr std::array kForms = {TargetForm::plain, TargetForm::inverse, TargetForm::square,
                               TargetForm::inverse_square};
constexpr std::array kOuterPowers = {0.0, 0.5, -0.5, 1.0, -1.0, 1.5, -1.5, 2.0, -2.0, 3.0, -3.0};
constexpr std::array kInnerPowers = {1.0, -1.0, 0.5, -0.5, 2.0, -2.0};
constexpr std::array kFunctions = {Op::exp, Op::tanh, Op::log, Op::sqrt};

struct Combination {
  TargetForm form;
  double outer;  // p
  double inner;  // q
  Op function;
  double scale;  // a
  double left;
};

double function_at(Op op, double x) {
  switch (op) {
    case Op::exp:
      return elementary::exp(x);
    case Op::tanh:
      return elementary::tanh(x);
    case Op::log:
      return elementary::log(1 + x);
    default:
      return std::sqrt(1 + x);
  }
}

Expression function_of(Op op, const Expression& x) {
  if (op == Op::log || op == Op::sqrt) return function(op, constant(1) + x);
  return function(op, x);
}

Expression scaled_by_power(const Expression& inside, double p) {
  if (p == 0) return inside;
  const Expression x = input(0);
  const double size = std::abs(p);
  const Expression power_of_x = size == 1     ? x
                                : size == 0.5 ? function(Op::sqrt, x)
                                              : power(x, size);
  return p > 0 ? power_of_x * inside : inside / power_of_x;
}

Expression inner_argument(double scale, double q) {
  const Expression x = input(0);
  if (q == 1) return constant(scale) * x;
  if (q == -1) return constant(scale) / x;
  const Expression root = std::abs(q) == 0.5 ? function(Op::sqrt, x) : power(x, 2);
  return q > 0 ? constant(scale) * root : constant(scale) / root;
}

class ScaledFunctionSearch {
 public:
  ScaledFunctionSearch(const LogRows& rows, const OperatorSet& operators)
      : rows_(rows), operators_(operators), x_(rows.inputs()[0].values) {
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
        Outer outer{form, p, {}};
        for (std::size_t r = 0; r < count; ++r) {
          outer.relative.push_back(elementary::pow(coarse_x_[r], p) / z[r]);
        }
        outers_.push_back(std::move(outer));
      }
    }
  }

  std::optional<Expression> run(Budget& budget) {
    for (const Op op : kFunctions) {
      if (!operators_.allows(op)) continue;
      for (const double q : kInnerPowers) {
        const std::uint64_t products = kCoarseScales * outers_.size() * coarse_x_.size();
        if (!budget.spend(products / 2)) return std::nullopt;
        look_at(op, q);
      }
    }
    std::ranges::stable_sort(best_, {}, &Combination::left);
    std::optional<Expression> shortest;
    for (std::size_t k = 0; k < std::min(kPolished, best_.size()); ++k) {
      if (best_[k].left > kPromisingSquare || budget.exhausted()) break;
      auto found = polished(best_[k], budget);
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

  std::vector<double> scales(double q) const {
    double largest = 0;
    for (const double x : x_) largest = std::max(largest, elementary::pow(x, q));
    std::vector<double> result;
    for (int k = 0; k < kCoarseScales; ++k) {
      const double decades = -2.0 + 5.5 * k / (kCoarseScales - 1);
      result.push_back(elementary::exp(decades * std::numbers::ln10) / largest);
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
  void look_at(Op op, double q) {
    std::vector<Combination> best;
    for (const Outer& outer : outers_)
      best.push_back({outer.form, outer.power, q, op, 0, HUGE_VAL});
    std::vector<double> f(coarse_x_.size());
    const auto try_scale = [&](double scale, std::size_t from, std::size_t to) {
      for (std::size_t r = 0; r < f.size(); ++r) {
        f[r] = function_at(op, scale * elementary::pow(coarse_x_[r], q));
      }
      for (std::size_t k = from; k < to; ++k) {
        const double left = left_of(outers_[k].relative, f);
        if (!(left < best[k].left)) continue;
        best[k].left = left;
        best[k].scale = scale;
      }
    };
    for (const double size : scales(q)) {
      try_scale(size, 0, outers_.size());
      if (op == Op::exp) try_scale(-size, 0, outers_.size());
    }
    for (std::size_t k = 0; op == Op::exp && k < outers_.size(); ++k) {
      try_scale(steepest(outers_[k], q), k, k + 1);
    }
    best_.insert(best_.end(), best.begin(), best.end());
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
    Expression formed = scaled_by_power(
        constant(1) +
            constant(1) * function_of(tried.function, inner_argument(tried.scale, tried.inner)),
        tried.outer);
    const std::vector<double> z = formed_target(rows_.target().values, tried.form);
    std::vector<double> weights = relative_scale(z, tried.form);
    for (double& w : weights) w *= w;
    const double* column = x_.data();
    ConstantFitOptions options;
    options.function_tolerance = 1e-15;
    options.max_iterations = 40;
    const ConstantFitResult fit =
        ConstantFitter().fit(formed, {{&column, 1}, x_.size()}, z, weights, options);
    budget.spend(fit.node_rows);
    const double sign = rows_.target().values[0] < 0 ? -1.0 : 1.0;
    Expression formula = solved_for_target(tried.form, formed, sign);
    if (!operators_.admits(formula) || !explains(formula, rows_)) return std::nullopt;
    return formula;
  }

  const LogRows& rows_;
  const OperatorSet& operators_;
  const std::vector<double>& x_;
  std::vector<double> coarse_x_;
  std::vector<double> coarse_y_;
  std::vector<Outer> outers_;
  std::vector<Combination> best_;
};

}  // namespace

std::optional<Expression> find_scaled_function(const LogRows& rows, const OperatorSet& operators,
                                               Budget& budget) {
  const Factor& x = rows.inputs()[0];
  if (rows.rows() < kFewestScaledRows || !x.has_logs() || x.changes_sign || x.values[0] < 0) {
    return std::nullopt;
  }
  if (!operators.allows(Op::mul) || !operators.allows(Op::div) || !operators.allows(Op::add)) {
    return std::nullopt;
  }
  return ScaledFunctionSearch(rows, operators).run(budget);
}

}  // namespace tribench::relay
