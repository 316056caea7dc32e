// SPDX-License-Identifier: MIT
#include "algorithms/relay/collapse.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "algorithms/fitting/linear_least_squares.hpp"
#include "algorithms/relay/factors.hpp"

namespace tribench::relay {
namespace {

constexpr double kSmooth = 0.05;
constexpr std::size_t kMostOuter = 14;
constexpr double kHardlySmooth = 0.5;
constexpr double kOffRationalOuter = 0.03;
constexpr double kRational = 3e-4;
constexpr int kMostLooks = 6;
constexpr double kMuchSmoother = 0.6;  // than the look before
constexpr double kOutliers = 0.85;  // the share of the rows that is kept by size of the difference

double root_mean_square(const std::vector<double>& values) {
  double sum = 0;
  for (const double x : values) sum += x * x;
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(values.size(), 1)));
}

using Factors = std::vector<KnownFactor>;

bool share_an_input(const KnownFactor& a, const KnownFactor& b) {
  return std::ranges::any_of(a.inputs,
                             [&](std::size_t j) { return std::ranges::count(b.inputs, j) > 0; });
}

// Exponents of one to four factors that share no input, the first of them positive, small ones
// first; of the first `inputs` factors alone before those with others.
std::vector<std::vector<double>> inner_exponents(const Factors& factors, std::size_t most) {
  std::vector<std::vector<double>> all;
  std::vector<std::size_t> chosen;
  std::vector<double> b(factors.size(), 0.0);
  const std::size_t inputs =
      static_cast<std::size_t>(std::ranges::count(factors, FactorKind::input, &KnownFactor::kind));
  bool with_others = false;
  const auto is_new = [&] {
    // (2, -2) says what (1, -1) says.
    return std::ranges::any_of(b, [](double x) { return std::abs(x) == 1; }) &&
           (!with_others || chosen.back() >= inputs);
  };
  const auto extend = [&](auto&& self, std::size_t next, int left) -> void {
    if (left == 0) {
      if (is_new()) all.push_back(b);
      return;
    }
    if (chosen.size() == 4) return;
    const std::size_t end = with_others ? factors.size() : inputs;
    for (std::size_t k = next; k < end && all.size() < most; ++k) {
      if (std::ranges::any_of(chosen, [&](std::size_t other) {
            return share_an_input(factors[k], factors[other]);
          })) {
        continue;
      }
      for (const int exponent : {1, -1, 2, -2}) {
        if ((chosen.empty() && exponent < 0) || std::abs(exponent) > left) continue;
        b[k] = exponent;
        chosen.push_back(k);
        self(self, k + 1, left - std::abs(exponent));
        chosen.pop_back();
        b[k] = 0;
      }
    }
  };
  for (const bool others : {false, true}) {
    with_others = others;
    // The inputs alone leave half of the orders to the others.
    const std::size_t quota = most;
    if (!others) most = (most + 1) / 2;
    for (int degree = 1; degree <= 8 && all.size() < most; ++degree) extend(extend, 0, degree);
    most = quota;
  }
  return all;
}

// Differences of values from the interpolation between neighbours, rows in an order by `place`.
// Neighbours across a change of the inner product's sign are none.
class Differences {
 public:
  Differences(const Factors& factors, std::size_t n, const std::vector<double>& inner) {
    std::vector<double> place(n, 0.0);
    std::vector<int> side(n, 0);
    for (std::size_t j = 0; j < inner.size(); ++j) {
      if (inner[j] == 0) continue;
      const Factor& input = factors[j].factor;
      const bool is_odd = std::abs(inner[j]) == 1;
      for (std::size_t r = 0; r < n; ++r) {
        place[r] += inner[j] * input.logs[r];
        if (is_odd && input.values[r] < 0) side[r] ^= 1;
      }
    }
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
      if (side[a] != side[b]) return side[a] < side[b];
      return place[a] != place[b] ? place[a] < place[b] : a < b;
    });
    for (std::size_t i = 1; i + 1 < n; ++i) {
      const std::size_t before = order[i - 1];
      const std::size_t here = order[i];
      const std::size_t after = order[i + 1];
      if (side[before] != side[after]) continue;
      const double gap = place[after] - place[before];
      const double share = gap > 0 ? (place[after] - place[here]) / gap : 0.5;
      triples_.push_back({before, here, after, share});
    }
  }

  std::vector<double> of(const std::vector<double>& values) const {
    std::vector<double> out;
    out.reserve(triples_.size());
    for (const Triple& t : triples_) {
      out.push_back(values[t.here] - t.share * values[t.before] - (1 - t.share) * values[t.after]);
    }
    return out;
  }

 private:
  struct Triple {
    std::size_t before, here, after;
    double share;
  };
  std::vector<Triple> triples_;
};

struct OuterFit {
  std::vector<double> outer;
  double rms = HUGE_VAL;
};

// a from the differences; one input of the inner product has none, since g can take its power.
OuterFit fit_outer(const LogRows& rows, const Factors& factors, const Differences& differences,
                   std::size_t without, Budget& budget) {
  OuterFit fit;
  std::vector<std::size_t> places;
  std::vector<std::vector<double>> columns;
  for (std::size_t j = 0; j < std::min(factors.size(), kMostOuter); ++j) {
    if (j == without) continue;
    places.push_back(j);
    columns.push_back(differences.of(factors[j].factor.logs));
  }
  std::vector<double> target = differences.of(rows.target().logs);
  const std::size_t p = places.size() + 1;
  if (!budget.spend((p * p + 20) * target.size())) return fit;
  fit.outer.assign(factors.size(), 0.0);
  // Twice: where y passes through 0 its logarithm is not smooth, and the few rows there are left
  // out of the second look. Of a wave there are many, and each look sees more of the rest.
  double before = HUGE_VAL;
  for (int look = 0; look < 2 || (look < kMostLooks && fit.rms < kMuchSmoother * before); ++look) {
    if (target.size() < 4 * p) return {};
    before = fit.rms;
    std::vector<const double*> pointers;
    for (const auto& column : columns) pointers.push_back(column.data());
    const LinearFit linear = solve_least_squares(pointers, target);
    std::vector<double> left = target;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      fit.outer[places[k]] = linear.coefficients[k];
      for (std::size_t i = 0; i < left.size(); ++i) {
        left[i] -= linear.coefficients[k] * columns[k][i];
      }
    }
    std::vector<double> sizes = left;
    for (double& x : sizes) x = std::abs(x);
    const auto rank = static_cast<std::ptrdiff_t>(kOutliers * static_cast<double>(sizes.size()));
    std::ranges::nth_element(sizes, sizes.begin() + rank);
    const double bound = sizes[static_cast<std::size_t>(rank)];
    const auto keep = [&](std::vector<double>& values) {
      std::vector<double> kept;
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::abs(left[i]) <= bound) kept.push_back(values[i]);
      }
      values = std::move(kept);
    };
    for (auto& column : columns) keep(column);
    keep(target);
    keep(left);
    fit.rms = root_mean_square(left);
  }
  return fit;
}

bool is_rational(const std::vector<double>& outer, double tolerance) {
  return std::ranges::all_of(outer,
                             [=](double a) { return std::abs(a - nearest_half(a)) <= tolerance; });
}

// Smooth, with exponents near to halves; or hardly smooth, with exponents that are halves (where g
// hardly differs from a power, only a few rows show it).
bool is_plausible(const OuterFit& fit, double null_rms) {
  if (fit.rms <= kSmooth * null_rms) return is_rational(fit.outer, kOffRationalOuter);
  return fit.rms <= kHardlySmooth * null_rms && is_rational(fit.outer, kRational);
}

std::size_t zeros_of(const std::vector<double>& outer) {
  return static_cast<std::size_t>(std::ranges::count(outer, 0.0));
}

Expression written(const Factors& factors, const std::vector<double>& exponents) {
  std::vector<Expression> formulas;
  for (const KnownFactor& known : factors) formulas.push_back(known.factor.formula);
  return product_of(1, formulas, exponents);
}

// The collapse, once for every way to share powers between outside and g that has the shortest
// outside: g may be simple with one of them alone.
void add_collapses(const LogRows& rows, const Factors& factors, const std::vector<double>& inner,
                   double null_rms, std::vector<Collapse>& found, Budget& budget) {
  const Differences differences(factors, rows.rows(), inner);
  const auto first = static_cast<std::size_t>(
      std::ranges::find_if(inner, [](double b) { return b != 0; }) - inner.begin());
  const OuterFit fit = fit_outer(rows, factors, differences, first, budget);
  if (!is_plausible(fit, null_rms)) return;
  std::vector<double> outer = fit.outer;
  for (double& a : outer) a = nearest_half(a);
  std::vector<std::vector<double>> shared = {outer};
  for (std::size_t j = 0; j < inner.size(); ++j) {
    if (inner[j] == 0 || outer[j] == 0) continue;
    std::vector<double> other = outer;
    for (std::size_t k = 0; k < inner.size(); ++k) other[k] -= outer[j] / inner[j] * inner[k];
    shared.push_back(std::move(other));
  }
  const std::size_t most = zeros_of(*std::ranges::max_element(shared, {}, zeros_of));
  for (const std::vector<double>& exponents : shared) {
    if (zeros_of(exponents) < most) continue;
    const double roughness = fit.rms / null_rms;
    found.push_back(
        {written(factors, exponents), written(factors, inner), roughness, roughness <= kSmooth});
  }
}

}  // namespace

std::vector<Collapse> find_collapses(const LogRows& rows, const OperatorSet& operators,
                                     std::size_t orders, std::size_t most, Budget& budget) {
  std::vector<Collapse> found;
  if (rows.inputs().size() < 2 || !rows.target().has_logs()) return found;
  Factors factors = known_factors(rows, operators, {FactorKind::wave, FactorKind::difference});
  std::erase_if(factors, [](const KnownFactor& known) { return !known.factor.has_logs(); });
  // Differences before waves: where there is not time for all, they are the likelier.
  std::ranges::stable_sort(factors, {}, [](const KnownFactor& known) {
    return known.kind == FactorKind::input ? 0 : known.kind == FactorKind::difference ? 1 : 2;
  });
  // What neighbours in no particular order differ by.
  const Differences null(factors, rows.rows(), std::vector<double>(factors.size(), 0.0));
  const double null_rms = fit_outer(rows, factors, null, factors.size(), budget).rms;
  if (!std::isfinite(null_rms)) return found;
  for (const std::vector<double>& inner : inner_exponents(factors, orders)) {
    if (budget.exhausted()) break;
    add_collapses(rows, factors, inner, null_rms, found, budget);
  }
  std::ranges::stable_sort(found, {}, &Collapse::roughness);
  if (found.size() > most) found.resize(most);
  return found;
}

}  // namespace tribench::relay
