// SPDX-License-Identifier: MIT
#include "algorithms/relay/power_law.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

#include "algorithms/fitting/linear_least_squares.hpp"
#include "foundation/elementary.hpp"

namespace tribench::relay {
namespace {

constexpr std::size_t kMostInputs = 15;
constexpr std::size_t kRowsPerNumber = 4;
constexpr int kMostSteps = 30;
constexpr int kMostHalvings = 8;
constexpr double kSettled = 1e-9;  // of the sum of squares, won by a step
// Standard errors that an exponent may be off a multiple of a half.
constexpr double kOffHalf = 3;

// log f = offset + sum of coefficients[k] * logs of input places[k]
struct PowerLaw {
  std::vector<std::size_t> places;
  std::vector<double> exponents;
  double log_factor = 0;
  double sum_squares = HUGE_VAL;
};

double sum_squares_between(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t r = 0; r < a.size(); ++r) sum += (a[r] - b[r]) * (a[r] - b[r]);
  return sum;
}

// Fits power laws to the target's rows by Gauss-Newton steps, each a weighted regression.
class LogLink {
 public:
  LogLink(const LogRows& rows, Budget& budget)
      : rows_(rows), budget_(budget), target_(rows.target().values) {
    const auto changes_sign = [](const Factor& input) { return input.changes_sign; };
    const bool sign_varies = std::ranges::any_of(rows.inputs(), changes_sign);
    const auto negative = std::ranges::count_if(target_, [](double y) { return y < 0; });
    sign_ = 2 * static_cast<std::size_t>(negative) > target_.size() ? -1 : 1;
    for (double& y : target_) y = sign_varies ? std::abs(y) : sign_ * y;
  }

  double sign() const { return sign_; }

  // The logarithm is `fixed` and a power law of these inputs; none where the budget is spent or the
  // numbers leave their range.
  std::optional<PowerLaw> fit(const std::vector<std::size_t>& places,
                              const std::vector<double>& fixed) const {
    LinkedRows start = rows_by_size(rows_);
    for (std::size_t r = 0; r < target_.size(); ++r) {
      start.response[r] -= start.weights[r] * fixed[r];
    }
    std::optional<PowerLaw> law = regressed(places, start);
    if (!law) return std::nullopt;
    std::vector<double> values = values_of(*law, fixed);
    law->sum_squares = sum_squares_between(target_, values);
    for (int step = 0; step < kMostSteps; ++step) {
      const std::optional<PowerLaw> full = regressed(places, linearised(*law, values));
      if (!full) return std::nullopt;
      const double before = law->sum_squares;
      if (!take_step(*law, *full, fixed, values) || before - law->sum_squares < kSettled * before) {
        break;
      }
    }
    if (!std::isfinite(law->sum_squares)) return std::nullopt;
    return law;
  }

  LinkedRows linearised(const PowerLaw& law) const {
    return linearised(law, values_of(law, std::vector<double>(target_.size(), 0.0)));
  }

  // By how much the sum of squares would grow without each input, in the linearised model.
  std::vector<double> worth_of_inputs(const PowerLaw& law) const {
    const LinkedRows linear = linearised(law);
    std::vector<double> worth;
    for (std::size_t k = 0; k < law.places.size(); ++k) {
      std::vector<std::size_t> others = law.places;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
      const std::optional<PowerLaw> without = regressed(others, linear);
      worth.push_back(without ? std::max(without->sum_squares - law.sum_squares, 0.0) : HUGE_VAL);
    }
    return worth;
  }

 private:
  double logarithm(const PowerLaw& law, std::size_t row) const {
    double sum = law.log_factor;
    for (std::size_t k = 0; k < law.places.size(); ++k) {
      sum += law.exponents[k] * rows_.inputs()[law.places[k]].logs[row];
    }
    return sum;
  }

  std::vector<double> values_of(const PowerLaw& law, const std::vector<double>& fixed) const {
    std::vector<double> values;
    for (std::size_t r = 0; r < target_.size(); ++r) {
      values.push_back(elementary::exp(fixed[r] + logarithm(law, r)));
    }
    return values;
  }

  // `values` are the law's, what is fixed among them; the response is without that.
  LinkedRows linearised(const PowerLaw& law, const std::vector<double>& values) const {
    LinkedRows linear{values, {}};
    for (std::size_t r = 0; r < target_.size(); ++r) {
      linear.response.push_back(values[r] * logarithm(law, r) + target_[r] - values[r]);
    }
    return linear;
  }

  // Its sum of squares is that of the regression.
  std::optional<PowerLaw> regressed(const std::vector<std::size_t>& places,
                                    const LinkedRows& linked) const {
    const auto& [weights, response] = linked;
    const std::size_t n = target_.size();
    const std::size_t p = places.size() + 1;
    const auto is_finite = [](double x) { return std::isfinite(x); };
    if (!std::ranges::all_of(weights, is_finite) || !std::ranges::all_of(response, is_finite) ||
        !budget_.spend(p * p / 4 * n)) {
      return std::nullopt;
    }
    std::vector<std::vector<double>> columns = {weights};
    for (const std::size_t place : places) {
      columns.push_back(rows_.inputs()[place].logs);
      for (std::size_t r = 0; r < n; ++r) columns.back()[r] *= weights[r];
    }
    std::vector<const double*> pointers;
    for (const std::vector<double>& column : columns) pointers.push_back(column.data());
    const LinearFit found = solve_least_squares(pointers, response);
    return PowerLaw{places,
                    {found.coefficients.begin() + 1, found.coefficients.end()},
                    found.coefficients[0],
                    found.sum_squares};
  }

  // As far towards `full` as the sum of squares falls; whether it does.
  bool take_step(PowerLaw& law, const PowerLaw& full, const std::vector<double>& fixed,
                 std::vector<double>& values) const {
    double share = 1;
    for (int halving = 0; halving <= kMostHalvings; ++halving, share /= 2) {
      PowerLaw next = law;
      next.log_factor += share * (full.log_factor - law.log_factor);
      for (std::size_t k = 0; k < next.exponents.size(); ++k) {
        next.exponents[k] += share * (full.exponents[k] - law.exponents[k]);
      }
      std::vector<double> reached = values_of(next, fixed);
      next.sum_squares = sum_squares_between(target_, reached);
      if (!(next.sum_squares < law.sum_squares)) continue;
      law = std::move(next);
      values = std::move(reached);
      return true;
    }
    return false;
  }

  const LogRows& rows_;
  Budget& budget_;
  std::vector<double> target_;  // positive but for noise
  double sign_ = 1;
};

// The same law with every exponent at a multiple of a half that the rows cannot tell from it, the
// others fitted again; none where there is no such exponent.
std::optional<PowerLaw> with_halves(const LogLink& link, const LogRows& rows, const PowerLaw& law,
                                    const std::vector<double>& worth) {
  const std::size_t n = rows.rows();
  const double freedom = static_cast<double>(n) - static_cast<double>(law.places.size()) - 1;
  const double variance = law.sum_squares / freedom;
  PowerLaw halves;
  std::vector<std::size_t> free;
  std::vector<double> fixed(n, 0.0);
  for (std::size_t k = 0; k < law.places.size(); ++k) {
    const double half = nearest_half(law.exponents[k]);
    // Wald: exponent / standard error = sqrt(worth / variance)
    const double error = std::abs(law.exponents[k]) * std::sqrt(variance / worth[k]);
    if (half == 0 || !(std::abs(law.exponents[k] - half) <= kOffHalf * error)) {
      free.push_back(law.places[k]);
      continue;
    }
    halves.places.push_back(law.places[k]);
    halves.exponents.push_back(half);
    const std::vector<double>& logs = rows.inputs()[law.places[k]].logs;
    for (std::size_t r = 0; r < n; ++r) fixed[r] += half * logs[r];
  }
  if (halves.places.empty()) return std::nullopt;
  const std::optional<PowerLaw> others = link.fit(free, fixed);
  if (!others) return std::nullopt;
  halves.places.insert(halves.places.end(), others->places.begin(), others->places.end());
  halves.exponents.insert(halves.exponents.end(), others->exponents.begin(),
                          others->exponents.end());
  halves.log_factor = others->log_factor;
  return halves;
}

// Of the inputs; none where there are more than rows can tell of.
std::vector<std::size_t> places_with_logs(const LogRows& rows) {
  std::vector<std::size_t> places;
  for (std::size_t j = 0; j < rows.inputs().size(); ++j) {
    if (rows.inputs()[j].has_logs()) places.push_back(j);
  }
  const bool is_possible = rows.target().has_logs() && places.size() <= kMostInputs &&
                           kRowsPerNumber * (places.size() + 1) <= rows.rows();
  return is_possible ? places : std::vector<std::size_t>();
}

Expression formula_of(const PowerLaw& law, double sign) {
  std::vector<Expression> factors;
  for (const std::size_t place : law.places) factors.push_back(Expression::variable(place));
  return product_of(sign * elementary::exp(law.log_factor), factors, law.exponents);
}

}  // namespace

LinkedRows rows_by_size(const LogRows& rows) {
  LinkedRows linked;
  for (std::size_t r = 0; r < rows.rows(); ++r) {
    linked.weights.push_back(std::abs(rows.target().values[r]));
    linked.response.push_back(linked.weights[r] * rows.target().logs[r]);
  }
  return linked;
}

std::optional<LinkedRows> rows_by_power_law(const LogRows& rows, Budget& budget) {
  const std::vector<std::size_t> places = places_with_logs(rows);
  if (places.empty()) return std::nullopt;
  const LogLink link(rows, budget);
  const auto law = link.fit(places, std::vector<double>(rows.rows(), 0.0));
  if (!law) return std::nullopt;
  return link.linearised(*law);
}

std::vector<Expression> likely_power_laws(const LogRows& rows, const OperatorSet& operators,
                                          Budget& budget) {
  std::vector<Expression> likely;
  std::vector<std::size_t> places = places_with_logs(rows);
  const LogLink link(rows, budget);
  const std::vector<double> nothing(rows.rows(), 0.0);
  const auto propose = [&](const PowerLaw& law) {
    Expression formula = formula_of(law, link.sign());
    if (operators.admits(formula)) likely.push_back(std::move(formula));
  };
  while (!places.empty()) {
    const std::optional<PowerLaw> law = link.fit(places, nothing);
    if (!law) break;
    const std::vector<double> worth = link.worth_of_inputs(*law);
    propose(*law);
    if (const auto halves = with_halves(link, rows, *law, worth)) propose(*halves);
    const auto least = std::ranges::min_element(worth) - worth.begin();
    places.erase(places.begin() + least);
  }
  return likely;
}

}  // namespace tribench::relay
