// SPDX-License-Identifier: MIT
#include "algorithms/relay/surrogate.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "algorithms/fitting/linear_least_squares.hpp"
#include "foundation/elementary.hpp"

namespace tribench::relay {
namespace {

constexpr std::size_t kMostInputsSeen = 12;
constexpr std::size_t kFewestRowsSeen = 40;
constexpr std::size_t kMostSurfaceTerms = 140;
constexpr std::size_t kMostDegree = 20;
constexpr double kExactSurface = 1e-7;  // of the target's spread
constexpr std::size_t kHeldOut = 6;     // every so many rows one

// An input on [-1, 1] with Chebyshev polynomials of it, and their slopes by the input itself.
struct Coordinate {
  std::vector<std::vector<double>> values;  // [degree][row]
  std::vector<std::vector<double>> slopes;

  Coordinate(const Factor& input, bool is_log, std::size_t degree) {
    std::vector<double> place = is_log ? input.logs : input.values;
    const auto [low, high] = std::ranges::minmax(place);
    const double scale = high > low ? 2 / (high - low) : 0;
    std::vector<double> inner(place.size());  // of the place by the input
    for (std::size_t r = 0; r < place.size(); ++r) {
      inner[r] = is_log ? scale / input.values[r] : scale;
      place[r] = scale * (place[r] - low) - 1;
    }
    values.assign(degree + 1, std::vector<double>(place.size(), 1.0));
    slopes.assign(degree + 1, std::vector<double>(place.size(), 0.0));
    for (std::size_t k = 1; k <= degree; ++k) {
      for (std::size_t r = 0; r < place.size(); ++r) {
        const double before = k > 1 ? values[k - 2][r] : 0;
        const double slope_before = k > 1 ? slopes[k - 2][r] : 0;
        const double twice = k > 1 ? 2 : 1;
        values[k][r] = twice * place[r] * values[k - 1][r] - before;
        slopes[k][r] =
            twice * (values[k - 1][r] * inner[r] + place[r] * slopes[k - 1][r]) - slope_before;
      }
    }
  }
};

using Degrees = std::vector<std::size_t>;  // per input

void add_degrees(std::size_t next, std::size_t left, Degrees& degrees, std::vector<Degrees>& all) {
  if (next == degrees.size()) {
    all.push_back(degrees);
    return;
  }
  for (std::size_t k = 0; k <= left; ++k) {
    degrees[next] = k;
    add_degrees(next + 1, left - k, degrees, all);
  }
  degrees[next] = 0;
}

// The highest degree whose products `rows` can determine.
std::size_t highest_degree(std::size_t inputs, std::size_t rows) {
  const std::size_t most = std::min(kMostSurfaceTerms, 2 * rows / 5);
  std::size_t degree = 1;
  double terms = static_cast<double>(inputs) + 1;
  while (degree < kMostDegree) {
    const double more =
        terms * static_cast<double>(inputs + degree + 1) / static_cast<double>(degree + 1);
    if (more > static_cast<double>(most)) break;
    terms = more;
    ++degree;
  }
  return degree;
}

std::vector<Degrees> products(std::size_t inputs, std::size_t degree) {
  Degrees none(inputs, 0);
  std::vector<Degrees> all;
  add_degrees(0, degree, none, all);
  return all;
}

double spread_of(std::span<const double> values) {
  const auto n = static_cast<double>(values.size());
  double mean = 0;
  for (const double x : values) mean += x / n;
  double square = 0;
  for (const double x : values) square += (x - mean) * (x - mean) / n;
  return std::sqrt(square);
}

class Polynomial {
 public:
  Polynomial(const LogRows& rows, std::span<const double> target, bool by_logs, std::size_t degree)
      : rows_(rows.rows()), terms_(products(rows.inputs().size(), degree)) {
    for (const Factor& input : rows.inputs()) {
      const bool is_log = by_logs && input.has_logs() && !input.changes_sign && input.values[0] > 0;
      coordinates_.emplace_back(input, is_log, degree);
    }
    fit(target);
  }

  double error() const { return error_; }

  std::vector<double> slope(std::size_t j) const {
    std::vector<double> sum(rows_, 0.0);
    for (std::size_t t = 0; t < terms_.size(); ++t) {
      if (terms_[t][j] == 0 || coefficients_[t] == 0) continue;
      const std::vector<double> values = values_of(terms_[t], j);
      for (std::size_t r = 0; r < rows_; ++r) sum[r] += coefficients_[t] * values[r];
    }
    return sum;
  }

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  // The product, or its slope by one input.
  std::vector<double> values_of(const Degrees& degrees, std::size_t by) const {
    std::vector<double> values(rows_, 1.0);
    for (std::size_t j = 0; j < degrees.size(); ++j) {
      if (degrees[j] == 0) continue;
      const auto& factor = j == by ? coordinates_[j].slopes : coordinates_[j].values;
      for (std::size_t r = 0; r < rows_; ++r) values[r] *= factor[degrees[j]][r];
    }
    return values;
  }

  void fit(std::span<const double> target) {
    std::vector<std::vector<double>> columns;
    std::vector<std::vector<double>> trained;
    std::vector<double> trained_target;
    for (std::size_t r = 0; r < rows_; ++r) {
      if (r % kHeldOut != 0) trained_target.push_back(target[r]);
    }
    std::vector<const double*> pointers;
    for (const Degrees& degrees : terms_) {
      columns.push_back(values_of(degrees, kNone));
      trained.emplace_back();
      for (std::size_t r = 0; r < rows_; ++r) {
        if (r % kHeldOut != 0) trained.back().push_back(columns.back()[r]);
      }
    }
    for (const auto& column : trained) pointers.push_back(column.data());
    coefficients_ = solve_least_squares(pointers, trained_target).coefficients;
    double square = 0;
    double count = 0;
    for (std::size_t r = 0; r < rows_; r += kHeldOut) {
      double left = target[r];
      for (std::size_t t = 0; t < columns.size(); ++t) left -= coefficients_[t] * columns[t][r];
      square += left * left;
      count += 1;
    }
    error_ = std::sqrt(square / count) / spread_of(target);
    if (!std::isfinite(error_)) error_ = HUGE_VAL;
  }

  std::size_t rows_;
  std::vector<Degrees> terms_;
  std::vector<Coordinate> coordinates_;
  std::vector<double> coefficients_;
  double error_ = HUGE_VAL;
};

}  // namespace

Surrogate::Surrogate(const LogRows& rows, std::span<const double> target, Budget& budget)
    : error_(HUGE_VAL) {
  const std::size_t inputs = rows.inputs().size();
  if (inputs == 0 || inputs > kMostInputsSeen || rows.rows() < kFewestRowsSeen) return;
  const std::size_t degree = highest_degree(inputs, rows.rows());
  const std::size_t terms = products(inputs, degree).size();
  if (!budget.spend(terms * terms / 4 * rows.rows())) return;
  // The lower degree where it will do: its slopes are steadier.
  std::optional<Polynomial> best;
  for (const std::size_t tried : {(degree + 1) / 2, degree}) {
    for (const bool by_logs : {false, true}) {
      Polynomial polynomial(rows, target, by_logs, tried);
      if (!best || polynomial.error() < best->error()) best = std::move(polynomial);
    }
    if (best->error() <= kExactSurface) break;
  }
  error_ = best->error();
  if (!std::isfinite(error_)) return;
  for (std::size_t j = 0; j < inputs; ++j) slopes_.push_back(best->slope(j));
}

}  // namespace tribench::relay
