// SPDX-License-Identifier: MIT
#include "algorithms/relay/product_search.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "algorithms/expression/build.hpp"
#include "algorithms/expression/column_kernels.hpp"
#include "algorithms/fitting/linear_least_squares.hpp"
#include "algorithms/relay/factors.hpp"
#include "algorithms/relay/power_law.hpp"
#include "algorithms/relay/subset_fits.hpp"
#include "foundation/elementary.hpp"

namespace tribench::relay {
namespace {

using namespace build;

// Root mean square of what is left of log |y|: rounding, not noise.
constexpr double kExact = 1e-8;

constexpr double kNoPart = 1e-6;  // of log |y| that a column explains
constexpr double kOffRational = 1e-5;
constexpr double kOffRationalInNoise = 0.1;
constexpr std::size_t kLikelyOfASize = 3;
constexpr double kPromising = 1e-5;  // in the Gram matrix, whose rounding is larger
constexpr std::size_t kMostFactors = 7;

// A column of the regression: the logarithm of a factor, or what stands in an exponential.
struct Column {
  Expression formula;
  std::vector<double> values;
  bool is_exponent = false;
  bool is_divisor = false;  // in the exponential; the values are one over the formula's
};

std::vector<Column> columns_of(const LogRows& rows, const OperatorSet& operators, int stage) {
  std::vector<Column> columns;
  if (rows.inputs().size() > kMostColumns) return columns;
  const auto factors =
      stage == 0 ? known_factors(rows, operators, {})
                 : known_factors(rows, operators,
                                 {FactorKind::wave, FactorKind::difference, FactorKind::sum,
                                  FactorKind::power, FactorKind::logarithm, FactorKind::other});
  for (const KnownFactor& known : factors) {
    if (!known.factor.has_logs() || (stage == 1 && known.inputs.size() > 1)) continue;
    columns.push_back({known.factor.formula, known.factor.logs, false});
  }
  const auto add_exponent = [&](const Expression& formula) {
    if (!operators.admits(function(Op::exp, formula))) return false;
    Factor factor = factor_of(formula, rows);
    const auto is_finite = [](double x) { return std::isfinite(x); };
    if (!std::ranges::all_of(factor.values, is_finite)) return false;
    columns.push_back({formula, std::move(factor.values), true});
    return true;
  };
  const std::size_t n = rows.inputs().size();
  for (std::size_t i = 0; i < n && stage > 0; ++i) {
    add_exponent(input(i));
    add_exponent(power(input(i), 2));
    if (rows.inputs()[i].has_logs() && add_exponent(constant(1) / input(i))) {
      columns.back().formula = input(i);
      columns.back().is_divisor = true;
    }
    for (std::size_t j = i + 1; j < n && stage > 1 && n <= kMostPaired; ++j) {
      add_exponent(input(i) * input(j));
      add_exponent(input(i) / input(j));
      add_exponent(input(j) / input(i));
    }
  }
  return columns;
}

struct Regression {
  std::vector<std::size_t> places;  // among the columns
  std::vector<double> coefficients;
  double offset = 0;
  double rms = HUGE_VAL;
};

Regression regress(const std::vector<Column>& columns, std::vector<std::size_t> places,
                   const std::vector<double>& target, Budget& budget) {
  Regression result;
  const std::size_t rows = target.size();
  const std::size_t p = places.size() + 1;
  if (2 * p > rows || !budget.spend(p * p / 4 * rows)) return result;
  const std::vector<double> ones(rows, 1.0);
  std::vector<const double*> pointers = {ones.data()};
  for (const std::size_t k : places) pointers.push_back(columns[k].values.data());
  const LinearFit fit = solve_least_squares(pointers, target);
  result.places = std::move(places);
  result.offset = fit.coefficients[0];
  result.coefficients.assign(fit.coefficients.begin() + 1, fit.coefficients.end());
  result.rms = std::sqrt(fit.sum_squares / static_cast<double>(rows));
  return result;
}

double spread_of(const std::vector<double>& values) {
  double mean = 0;
  for (const double x : values) mean += x / static_cast<double>(values.size());
  double square = 0;
  for (const double x : values) square += (x - mean) * (x - mean);
  return std::sqrt(square / static_cast<double>(values.size()));
}

// Leaves out what explains nothing, then whatever can go.
Regression sparse(const std::vector<Column>& columns, Regression full,
                  const std::vector<double>& target, Budget& budget) {
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < full.places.size(); ++k) {
    const double part = std::abs(full.coefficients[k]) * spread_of(columns[full.places[k]].values);
    if (part > kNoPart) kept.push_back(full.places[k]);
  }
  Regression best = regress(columns, kept, target, budget);
  if (!(best.rms <= kExact)) return full;
  for (std::size_t i = best.places.size(); i-- > 0;) {
    std::vector<std::size_t> fewer = best.places;
    fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
    Regression without = regress(columns, std::move(fewer), target, budget);
    if (without.rms <= kExact) best = std::move(without);
  }
  return best;
}

// Of more columns than the rows determine: the shortest sum that is exact, grown from the best
// pairs. The first column is the constant.
std::optional<Regression> grown(const std::vector<Column>& columns,
                                const std::vector<double>& target, Budget& budget) {
  const std::size_t n = target.size();
  const std::vector<double> ones(n, 1.0);
  std::vector<const double*> pointers = {ones.data()};
  for (const Column& column : columns) pointers.push_back(column.values.data());
  pointers.push_back(target.data());
  const std::size_t count = pointers.size();
  if (count > kMostColumns || !budget.spend(count * count / 16 * n)) return std::nullopt;
  std::vector<double> gram(count * count);
  columns::gram(pointers.data(), count, n, gram.data());
  const SubsetFits fits(std::move(gram), std::vector<char>(count - 1, 0));
  std::vector<SparseSum> sums = fits.best_pairs();
  for (std::size_t terms = 2; !sums.empty(); ++terms) {
    for (const SparseSum& sum : sums) {
      if (sum.left > kPromising * kPromising) break;
      std::vector<std::size_t> places;
      for (const std::size_t term : sum.terms) {
        if (term > 0) places.push_back(term - 1);
      }
      Regression found = regress(columns, std::move(places), target, budget);
      if (found.rms <= kExact) return found;
    }
    if (terms == kMostFactors || !budget.spend(sums.size() * count * terms * terms)) break;
    sums = fits.grown(sums, budget);
  }
  return std::nullopt;
}

Expression formula_of(const std::vector<Column>& columns, const Regression& found, double sign,
                      double off_rational = kOffRational) {
  std::vector<Expression> factors;
  std::vector<double> exponents;
  Expression exponent;
  for (std::size_t k = 0; k < found.places.size(); ++k) {
    const Column& column = columns[found.places[k]];
    const double c = found.coefficients[k];
    if (column.is_exponent) {
      exponent = sum_of(exponent, column.is_divisor ? constant(c) / column.formula
                                                    : constant(c) * column.formula);
      continue;
    }
    factors.push_back(column.formula);
    exponents.push_back(std::abs(c - nearest_half(c)) <= off_rational ? nearest_half(c) : c);
  }
  if (!exponent.empty()) {
    factors.push_back(function(Op::exp, exponent));
    exponents.push_back(1);
  }
  return product_of(sign * elementary::exp(found.offset), factors, exponents);
}

// The signs of the target are the formula's or the opposite, whichever most rows have.
Expression with_likely_sign(const std::vector<Column>& columns, const Regression& found,
                            const LogRows& rows) {
  Expression formula = formula_of(columns, found, 1, kOffRationalInNoise);
  const Factor values = factor_of(formula, rows);
  std::size_t opposite = 0;
  for (std::size_t r = 0; r < rows.rows(); ++r) {
    if (values.values[r] * rows.target().values[r] < 0) ++opposite;
  }
  return 2 * opposite > rows.rows() ? formula_of(columns, found, -1, kOffRationalInNoise) : formula;
}

// The best products of every number of factors.
void add_likely(const std::vector<Column>& columns, const LinkedRows& linked, const LogRows& rows,
                const OperatorSet& operators, Budget& budget, std::vector<Expression>& likely) {
  const std::size_t n = rows.rows();
  std::vector<std::vector<double>> weighted = {linked.weights};
  for (const Column& column : columns) {
    weighted.push_back(column.values);
    for (std::size_t r = 0; r < n; ++r) weighted.back()[r] *= linked.weights[r];
  }
  weighted.push_back(linked.response);
  const std::size_t count = weighted.size();
  std::vector<const double*> pointers;
  for (const auto& column : weighted) pointers.push_back(column.data());
  if (count > kMostColumns || !budget.spend(count * count / 16 * n)) return;
  std::vector<double> gram(count * count);
  columns::gram(pointers.data(), count, n, gram.data());
  const SubsetFits fits(std::move(gram), std::vector<char>(count - 1, 0));
  std::vector<SparseSum> sums = fits.best_pairs();
  for (std::size_t terms = 2; !sums.empty(); ++terms) {
    for (std::size_t s = 0; s < std::min(kLikelyOfASize, sums.size()); ++s) {
      Regression found;
      std::vector<const double*> chosen;
      for (const std::size_t term : sums[s].terms) chosen.push_back(pointers[term]);
      const LinearFit fit = solve_least_squares(chosen, weighted.back());
      for (std::size_t k = 0; k < chosen.size(); ++k) {
        if (sums[s].terms[k] == 0) {
          found.offset = fit.coefficients[k];
          continue;
        }
        found.places.push_back(sums[s].terms[k] - 1);
        found.coefficients.push_back(fit.coefficients[k]);
      }
      Expression formula = with_likely_sign(columns, found, rows);
      if (operators.admits(formula)) likely.push_back(std::move(formula));
    }
    if (terms == kMostFactors || !budget.spend(sums.size() * count * terms * terms)) break;
    sums = fits.grown(sums, budget);
  }
}

}  // namespace

std::vector<Expression> likely_products(const LogRows& rows, const OperatorSet& operators,
                                        Budget& budget) {
  std::vector<Expression> likely;
  if (!rows.target().has_logs() || !operators.allows(Op::mul) || rows.rows() < 20) return likely;
  const std::vector<Column> columns = columns_of(rows, operators, 2);
  add_likely(columns, rows_by_size(rows), rows, operators, budget, likely);
  if (const auto linked = rows_by_power_law(rows, budget)) {
    add_likely(columns, *linked, rows, operators, budget, likely);
  }
  return likely;
}

std::optional<Expression> find_product(const LogRows& rows, const OperatorSet& operators,
                                       Budget& budget) {
  if (!rows.target().has_logs() || !operators.allows(Op::mul)) return std::nullopt;
  // Inputs, then functions of one, then of two.
  for (int stage = 0; stage < 3; ++stage) {
    const std::vector<Column> columns = columns_of(rows, operators, stage);
    std::vector<std::size_t> all(columns.size());
    std::iota(all.begin(), all.end(), 0);
    const std::vector<double>& target = rows.target().logs;
    const bool is_determined = 2 * (all.size() + 1) <= target.size();
    std::optional<Regression> full =
        is_determined ? regress(columns, all, target, budget) : grown(columns, target, budget);
    if (!full || !(full->rms <= kExact)) continue;
    const Regression found = sparse(columns, std::move(*full), target, budget);
    Expression formula = formula_of(columns, found, 1);
    // The sign follows from the factors' where the exponents are whole; a constant one is set here.
    const Factor values = factor_of(formula, rows);
    if (values.values[0] * rows.target().values[0] < 0) {
      formula = formula_of(columns, found, -1);
    }
    return formula;
  }
  return std::nullopt;
}

}  // namespace tribench::relay
