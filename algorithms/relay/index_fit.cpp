// SPDX-License-Identifier: MIT
#include "algorithms/relay/index_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "algorithms/expression/build.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "algorithms/fitting/linear_least_squares.hpp"
#include "algorithms/relay/target_forms.hpp"
#include "algorithms/relay/unit_function.hpp"
#include "foundation/elementary.hpp"

namespace tribench::relay {
namespace {

using namespace build;

constexpr int kScales = 160;  // on the logarithmic grid
constexpr int kFrequencies = 1024;
constexpr std::size_t kTried = 3;  // of the grid's minima, a function

using Kind = UnitFunction::Kind;
constexpr UnitFunction kLooked[] = {{Kind::exponential}, {Kind::tanh}, {Kind::atan},
                                    {Kind::logarithm},   {Kind::sine}, {Kind::cosh},
                                    {Kind::sinh}};

struct Trial {
  double scale;
  double left;
};

class FunctionSearch {
 public:
  FunctionSearch(const LogRows& rows, TargetForm form, Budget& budget)
      : rows_(rows),
        form_(form),
        budget_(budget),
        x_(rows.inputs()[0].values),
        z_(formed_target(rows.target().values, form)),
        scale_(relative_scale(z_, form)),
        scaled_target_(z_) {
    for (std::size_t r = 0; r < z_.size(); ++r) scaled_target_[r] *= scale_[r];
  }

  bool is_usable() const {
    return std::ranges::all_of(scaled_target_, [](double v) { return std::isfinite(v); });
  }

  std::optional<Expression> find(const UnitFunction& f) {
    std::vector<Trial> trials;
    for (const double scale : scales_of(f.kind)) {
      if (!budget_.spend(6 * x_.size())) return std::nullopt;
      trials.push_back({scale, left_of(f, scale)});
    }
    for (const double scale : minima_of(trials)) {
      // Two phases a quarter apart: from one of them the fit finds any.
      for (const double phase : {0.8, 0.8 + std::numbers::pi / 2}) {
        if (auto found = polished(f, scale, phase)) return found;
        if (f.kind != Kind::sine) break;
      }
    }
    return std::nullopt;
  }

 private:
  std::vector<double> scales_of(Kind kind) const {
    const auto [low, high] = std::ranges::minmax(x_);
    const double largest = std::max(std::abs(low), std::abs(high));
    std::vector<double> scales;
    if (kind == Kind::sine) {
      for (int k = 1; k <= kFrequencies; ++k) {
        scales.push_back(k * std::numbers::pi / 2 / (high - low));
      }
      return scales;
    }
    if (kind == Kind::exponential) scales.push_back(steepest());
    for (int k = 0; k < kScales; ++k) {
      // From a hundredth to thirty thousand across the range.
      const double decades = -2.0 + 6.5 * k / (kScales - 1);
      const double scale = elementary::exp(decades * std::numbers::ln10) / largest;
      scales.push_back(scale);
      if (kind == Kind::exponential || kind == Kind::logarithm) scales.push_back(-scale);
    }
    return scales;
  }

  // Of an exponential over many decades the largest rows tell the scale.
  double steepest() const {
    std::vector<std::size_t> order(z_.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(
        order, [&](std::size_t a, std::size_t b) { return std::abs(z_[a]) > std::abs(z_[b]); });
    const auto log_at = [&](std::size_t k) { return elementary::log(std::abs(z_[order[k]])); };
    const std::size_t other = order.size() / 20 + 1;
    return (log_at(0) - log_at(other)) / (x_[order[0]] - x_[order[other]]);
  }

  // Of the constant and the function; of a wave with both phases.
  double left_of(const UnitFunction& f, double scale) const {
    const std::size_t n = x_.size();
    std::vector<std::vector<double>> columns = {scale_, std::vector<double>(n)};
    for (std::size_t r = 0; r < n; ++r) columns[1][r] = scale_[r] * f.value(scale * x_[r]);
    if (f.kind == Kind::sine) {
      columns.emplace_back(n);
      for (std::size_t r = 0; r < n; ++r) {
        columns[2][r] = scale_[r] * elementary::cos(scale * x_[r]);
      }
    }
    std::vector<const double*> pointers;
    for (const auto& column : columns) {
      if (!std::ranges::all_of(column, [](double v) { return std::isfinite(v); })) return HUGE_VAL;
      pointers.push_back(column.data());
    }
    return solve_least_squares(pointers, scaled_target_).sum_squares;
  }

  static std::vector<double> minima_of(std::vector<Trial> trials) {
    std::ranges::stable_sort(trials, {}, &Trial::left);
    std::vector<double> scales;
    for (const Trial& trial : trials) {
      if (scales.size() == kTried || !std::isfinite(trial.left)) break;
      scales.push_back(trial.scale);
    }
    return scales;
  }

  // c_0 + c_1 log(b + a x): b says nothing that c_0 does not.
  static void set_inside_to_one(Expression& formed) {
    const std::vector<std::size_t> places = constant_positions(formed);
    const double c1 = formed.node(places[1]).value;
    const double b = formed.node(places[2]).value;
    if (!(b > 0)) return;
    set_constant(formed, places[0], formed.node(places[0]).value + c1 * elementary::log(b));
    set_constant(formed, places[2], 1);
    set_constant(formed, places[3], formed.node(places[3]).value / b);
  }

  std::optional<Expression> polished(const UnitFunction& f, double scale, double phase) const {
    const Expression argument = constant(scale) * input(0);
    const Expression inside = f.kind == Kind::sine ? argument + constant(phase) : argument;
    Expression formed = constant(0) + constant(1) * f.formula(inside);
    std::vector<double> weights = scale_;
    for (double& w : weights) w *= w;
    const double* column = x_.data();
    ConstantFitOptions options;
    options.max_iterations = 60;
    options.function_tolerance = 1e-15;
    const ConstantFitResult fit =
        ConstantFitter().fit(formed, {{&column, 1}, x_.size()}, z_, weights, options);
    budget_.spend(fit.node_rows);
    if (f.kind == Kind::logarithm) set_inside_to_one(formed);
    const double sign = rows_.target().values[0] < 0 ? -1.0 : 1.0;
    Expression formula = solved_for_target(form_, formed, sign);
    if (!explains(formula, rows_)) return std::nullopt;
    return formula;
  }

  const LogRows& rows_;
  TargetForm form_;
  Budget& budget_;
  const std::vector<double>& x_;
  std::vector<double> z_;
  std::vector<double> scale_;
  std::vector<double> scaled_target_;
};

}  // namespace

std::optional<Expression> find_function(const LogRows& rows, const OperatorSet& operators,
                                        Budget& budget) {
  if (rows.rows() < 20 || !operators.allows(Op::mul) || !operators.allows(Op::add)) {
    return std::nullopt;
  }
  for (const TargetForm form : kTargetForms) {
    if (!keeps_sign(form) && (rows.target().changes_sign || !rows.target().has_logs())) continue;
    FunctionSearch search(rows, form, budget);
    if (!search.is_usable()) continue;
    for (const UnitFunction& f : kLooked) {
      if (!f.is_written_with(operators)) continue;
      auto found = search.find(f);
      if (found && operators.admits(*found)) return found;
    }
  }
  return std::nullopt;
}

}  // namespace tribench::relay
