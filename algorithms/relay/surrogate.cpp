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
constexpr double kAllNoise = 0.95;      // of its own spread, of what is left
constexpr std::size_t kHeldOut = 6;     // every so many rows one

using Degrees = std::vector<std::size_t>;  // per input

// The products of the part's inputs from place `next` on; the constant not among them.
void add_degrees(const std::vector<std::size_t>& part, std::size_t next, std::size_t left,
                 Degrees& degrees, std::vector<Degrees>& all) {
  if (next == part.size()) {
    if (std::ranges::any_of(degrees, [](std::size_t k) { return k > 0; })) all.push_back(degrees);
    return;
  }
  for (std::size_t k = 0; k <= left; ++k) {
    degrees[part[next]] = k;
    add_degrees(part, next + 1, left - k, degrees, all);
  }
  degrees[part[next]] = 0;
}

Parts all_together(std::size_t inputs) {
  Parts whole(1);
  for (std::size_t j = 0; j < inputs; ++j) whole[0].push_back(j);
  return whole;
}

// Of one polynomial in each part, with the constant.
double count_terms(const Parts& parts, std::size_t degree) {
  double all = 1;
  for (const auto& part : parts) {
    double terms = 1;
    for (std::size_t d = 1; d <= degree; ++d) {
      terms *= static_cast<double>(part.size() + d) / static_cast<double>(d);
    }
    all += std::nearbyint(terms) - 1;
  }
  return all;
}

std::size_t highest_degree(const Parts& parts, std::size_t most_terms) {
  const auto most = static_cast<double>(most_terms);
  std::size_t degree = 1;
  while (degree < kMostDegree && count_terms(parts, degree + 1) <= most) ++degree;
  return degree;
}

// The constant first.
std::vector<Degrees> products(const Parts& parts, std::size_t inputs, std::size_t degree) {
  Degrees none(inputs, 0);
  std::vector<Degrees> all = {none};
  for (const auto& part : parts) add_degrees(part, 0, degree, none, all);
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

}  // namespace

class Surrogate::Polynomial {
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

 public:
  Polynomial(const std::vector<Factor>& inputs, std::span<const double> target, const Parts& parts,
             bool by_logs, std::size_t degree)
      : rows_(target.size()), terms_(products(parts, inputs.size(), degree)), by_logs_(by_logs) {
    for (const Factor& input : inputs) {
      const bool is_log = by_logs && input.has_logs() && !input.changes_sign && input.values[0] > 0;
      coordinates_.emplace_back(input, is_log, degree);
    }
    fit(target);
  }

  double error() const { return error_; }
  bool by_logs() const { return by_logs_; }

  std::vector<double> slope(std::size_t j) const {
    return sum_where([j](const Degrees& term) { return term[j] > 0; }, j);
  }

  // The values of the terms with inputs of the part.
  std::vector<double> values_in(const std::vector<std::size_t>& part) const {
    return sum_where(
        [&](const Degrees& term) {
          return std::ranges::any_of(part, [&](std::size_t j) { return term[j] > 0; });
        },
        kNone);
  }

  double shared(std::size_t i, std::size_t j) const {
    double sum = 0;
    for (std::size_t t = 0; t < terms_.size(); ++t) {
      if (terms_[t][i] > 0 && terms_[t][j] > 0) sum += coefficients_[t] * coefficients_[t];
    }
    return sum;
  }

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  template <typename IsWanted>
  std::vector<double> sum_where(const IsWanted& is_wanted, std::size_t by) const {
    std::vector<double> sum(rows_, 0.0);
    for (std::size_t t = 0; t < terms_.size(); ++t) {
      if (coefficients_[t] == 0 || !is_wanted(terms_[t])) continue;
      const std::vector<double> values = values_of(terms_[t], by);
      for (std::size_t r = 0; r < rows_; ++r) sum[r] += coefficients_[t] * values[r];
    }
    return sum;
  }

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
  bool by_logs_;
  double error_ = HUGE_VAL;
};

Surrogate::Surrogate(const LogRows& rows, std::span<const double> target, Budget& budget) {
  const std::size_t inputs = rows.inputs().size();
  const Parts together = all_together(inputs);
  const auto best = fitted(rows, target, together, {false, true}, budget);
  if (!best) return;
  error_ = best->error();
  by_logs_ = best->by_logs();
  if (!std::isfinite(error_)) return;
  for (std::size_t j = 0; j < inputs; ++j) slopes_.push_back(best->slope(j));
  for (std::size_t i = 0; i < inputs; ++i) {
    for (std::size_t j = 0; j < inputs; ++j) shared_.push_back(best->shared(i, j));
  }
}

Surrogate::Surrogate(const LogRows& rows, std::span<const double> target, const Parts& parts,
                     const Surrogate& whole, Budget& budget) {
  const auto best = fitted(rows, target, parts, {whole.by_logs_}, budget);
  if (!best) return;
  error_ = best->error();
  for (const auto& part : parts) parts_.push_back(best->values_in(part));
}

Surrogate::Surrogate(const std::vector<Factor>& inputs, std::span<const double> target,
                     std::size_t most_terms, Budget& budget) {
  const Parts whole = all_together(inputs.size());
  const std::size_t degree = highest_degree(whole, most_terms);
  const auto terms = static_cast<std::size_t>(count_terms(whole, degree));
  if (target.size() < kFewestRowsSeen || !budget.spend(terms * terms / 8 * target.size())) return;
  error_ = Polynomial(inputs, target, whole, false, degree).error();
}

std::optional<Surrogate::Polynomial> Surrogate::fitted(const LogRows& rows,
                                                       std::span<const double> target,
                                                       const Parts& parts,
                                                       std::initializer_list<bool> by_logs,
                                                       Budget& budget) {
  const std::size_t inputs = rows.inputs().size();
  if (inputs == 0 || inputs > kMostInputsSeen || rows.rows() < kFewestRowsSeen) return std::nullopt;
  // As many terms as the rows can determine.
  const std::size_t degree =
      highest_degree(parts, std::min(kMostSurfaceTerms, 2 * rows.rows() / 5));
  const auto terms = static_cast<std::size_t>(count_terms(parts, degree));
  if (!budget.spend(terms * terms / 4 * rows.rows())) return std::nullopt;
  // The lower degree where it will do: its slopes are steadier.
  std::optional<Polynomial> best;
  for (const std::size_t tried : {(degree + 1) / 2, degree}) {
    for (const bool is_log : by_logs) {
      Polynomial polynomial(rows.inputs(), target, parts, is_log, tried);
      if (!best || polynomial.error() < best->error()) best = std::move(polynomial);
    }
    if (best->error() <= kExactSurface) break;
  }
  return best;
}

bool leaves_noise(const Expression& formula, const LogRows& rows, Budget& budget) {
  std::vector<double> left = factor_of(formula, rows).values;
  for (std::size_t r = 0; r < left.size(); ++r) left[r] = rows.target().values[r] - left[r];
  const double error = Surrogate(rows, left, budget).error();
  return std::isfinite(error) && error >= kAllNoise;
}

}  // namespace tribench::relay
