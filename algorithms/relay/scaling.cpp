// SPDX-License-Identifier: MIT
#include "algorithms/relay/scaling.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace tribench::relay {
namespace {

constexpr std::size_t kMostInputs = 10;
constexpr int kMostSize = 6;           // sum of |d|
constexpr std::size_t kMostParts = 4;  // d that are not 0
constexpr std::size_t kWays = 2;
constexpr double kRounding = 1e-6;  // of a slope: less is no better

struct Direction {
  std::vector<int> d;
  int size = 0;
  double c = 0;
  double left = 0;  // of the largest slope, squared
};

// Halves, or thirds and quarters that are plainly meant.
std::optional<double> fraction_near(double c) {
  const double half = std::nearbyint(2 * c) / 2;
  if (std::abs(c - half) <= 0.03) return half;
  for (const double q : {3.0, 4.0}) {
    const double near = std::nearbyint(q * c) / q;
    if (std::abs(c - near) <= 0.01) return near;
  }
  return std::nullopt;
}

class Directions {
 public:
  Directions(const std::vector<std::vector<double>>& slopes, const std::vector<double>& reference,
             double tolerance)
      : n_(slopes.size()), tolerance_(tolerance) {
    square_ = reference.empty() ? 0 : mean_product(reference, reference);
    for (const auto& a : slopes) {
      along_.push_back(reference.empty() ? 0 : mean_product(a, reference));
      for (const auto& b : slopes) products_.push_back(mean_product(a, b));
    }
    for (std::size_t j = 0; j < n_; ++j) largest_ = std::max(largest_, products_[j * n_ + j]);
  }

  // A direction with one number more must be twice as good.
  std::vector<Direction> best_first() {
    std::vector<int> d(n_, 0);
    extend(0, 0, kMostSize, d);
    std::ranges::stable_sort(found_, {}, [](const Direction& direction) {
      return std::ldexp(std::sqrt(direction.left) + kRounding, direction.size);
    });
    return std::move(found_);
  }

 private:
  void extend(std::size_t next, std::size_t parts, int left, std::vector<int>& d) {
    if (next == n_) {
      if (parts > 0) consider(d);
      return;
    }
    for (int k = -2; k <= 2; ++k) {
      if (std::abs(k) > left || (k != 0 && parts == kMostParts) || (k < 0 && parts == 0)) continue;
      d[next] = k;
      extend(next + 1, parts + (k != 0 ? 1 : 0), left - std::abs(k), d);
    }
    d[next] = 0;
  }

  void consider(const std::vector<int>& d) {
    double square = 0;
    double along = 0;
    double weakest = HUGE_VAL;
    int size = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      if (d[i] == 0) continue;
      size += std::abs(d[i]);
      along += d[i] * along_[i];
      weakest = std::min(weakest, d[i] * d[i] * products_[i * n_ + i]);
      for (std::size_t j = 0; j < n_; ++j) square += d[i] * d[j] * products_[i * n_ + j];
    }
    const double c = square_ > 0 ? along / square_ : 0;
    const double left = std::max(0.0, square - c * along);
    const double bound = tolerance_ * tolerance_;
    if (!(left <= bound * weakest) && !(size == 1 && square <= 0.01 * bound * largest_)) return;
    const auto fraction = fraction_near(c);
    if (fraction) found_.push_back({d, size, *fraction, left / largest_});
  }

  std::size_t n_;
  double tolerance_;
  double square_ = 0;
  double largest_ = 0;
  std::vector<double> along_;
  std::vector<double> products_;
  std::vector<Direction> found_;
};

// Solves a (m x m, row by row) x = b; false where a is singular.
bool solve(std::vector<double> a, std::vector<double>& b) {
  const std::size_t m = b.size();
  for (std::size_t k = 0; k < m; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < m; ++i) {
      if (std::abs(a[i * m + k]) > std::abs(a[pivot * m + k])) pivot = i;
    }
    if (std::abs(a[pivot * m + k]) < 1e-9) return false;
    for (std::size_t j = 0; j < m; ++j) std::swap(a[k * m + j], a[pivot * m + j]);
    std::swap(b[k], b[pivot]);
    for (std::size_t i = 0; i < m; ++i) {
      if (i == k) continue;
      const double f = a[i * m + k] / a[k * m + k];
      for (std::size_t j = 0; j < m; ++j) a[i * m + j] -= f * a[k * m + j];
      b[i] -= f * b[k];
    }
  }
  for (std::size_t k = 0; k < m; ++k) b[k] /= a[k * m + k];
  return true;
}

// Independent ones, the best.
std::vector<Direction> basis_of(const std::vector<Direction>& directions) {
  std::vector<Direction> basis;
  std::vector<std::vector<double>> reduced;  // with a leading place each
  std::vector<std::size_t> leads;
  for (const Direction& direction : directions) {
    std::vector<double> rest(direction.d.begin(), direction.d.end());
    for (std::size_t k = 0; k < reduced.size(); ++k) {
      const double f = rest[leads[k]] / reduced[k][leads[k]];
      for (std::size_t j = 0; j < rest.size(); ++j) rest[j] -= f * reduced[k][j];
    }
    const auto lead = std::ranges::max_element(rest, {}, [](double x) { return std::abs(x); });
    if (std::abs(*lead) < 1e-9) continue;
    leads.push_back(static_cast<std::size_t>(lead - rest.begin()));
    reduced.push_back(std::move(rest));
    basis.push_back(direction);
  }
  return basis;
}

bool is_multiple(double x, double part) {
  return std::abs(x / part - std::nearbyint(x / part)) < 1e-9;
}
bool is_half(double x) { return is_multiple(x, 0.5); }
bool is_fraction(double x) { return is_multiple(x, 0.25) || is_multiple(x, 1.0 / 3); }
bool is_whole(double x) { return std::abs(x - std::nearbyint(x)) < 1e-9; }

double size_of(const Rescaled& rescaled) {
  double size = 0;
  const auto add = [&](double x) { size += std::abs(x) + (is_whole(x) ? 0 : 3); };
  for (const double x : rescaled.outer) add(x);
  for (const auto& inner : rescaled.inner) std::ranges::for_each(inner, add);
  return size;
}

// With the inputs `pivots` scaled to 1.
std::optional<Rescaled> written(const std::vector<Direction>& basis,
                                const std::vector<std::size_t>& pivots, std::size_t n) {
  const std::size_t m = basis.size();
  std::vector<double> a;
  for (const Direction& direction : basis) {
    for (const std::size_t p : pivots) a.push_back(direction.d[p]);
  }
  const auto exponents = [&](const auto& of_direction) -> std::optional<std::vector<double>> {
    std::vector<double> b;
    for (const Direction& direction : basis) b.push_back(of_direction(direction));
    if (!solve(a, b)) return std::nullopt;
    std::vector<double> all(n, 0.0);
    for (std::size_t k = 0; k < m; ++k) all[pivots[k]] = b[k];
    return all;
  };
  const auto outer = exponents([](const Direction& direction) { return direction.c; });
  if (!outer || !std::ranges::all_of(*outer, is_fraction)) return std::nullopt;
  Rescaled rescaled{*outer, {}};
  for (std::size_t j = 0; j < n; ++j) {
    if (std::ranges::count(pivots, j) > 0) continue;
    auto inner = *exponents([j](const Direction& direction) { return -direction.d[j]; });
    if (!std::ranges::all_of(inner, is_half)) return std::nullopt;
    inner[j] = 1;
    rescaled.inner.push_back(std::move(inner));
  }
  return rescaled;
}

// In the two shortest ways.
void write_shortest(const std::vector<Direction>& basis, std::size_t n,
                    std::vector<Rescaled>& out) {
  std::vector<std::pair<double, Rescaled>> ways;
  std::vector<std::size_t> pivots;
  const auto extend = [&](auto&& self, std::size_t next) -> void {
    if (pivots.size() == basis.size()) {
      if (auto rescaled = written(basis, pivots, n)) {
        const double size = size_of(*rescaled);
        ways.emplace_back(size, std::move(*rescaled));
      }
      return;
    }
    for (std::size_t j = next; j < n; ++j) {
      pivots.push_back(j);
      self(self, j + 1);
      pivots.pop_back();
    }
  };
  extend(extend, 0);
  std::ranges::stable_sort(ways, {}, &std::pair<double, Rescaled>::first);
  for (std::size_t k = 0; k < std::min(kWays, ways.size()); ++k) {
    out.push_back(std::move(ways[k].second));
  }
}

}  // namespace

double mean_product(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t r = 0; r < a.size(); ++r) sum += a[r] * b[r];
  return sum / static_cast<double>(a.size());
}

std::vector<Rescaled> find_scalings(const std::vector<std::vector<double>>& slopes,
                                    const std::vector<double>& reference, double tolerance) {
  const std::size_t n = slopes.size();
  if (n == 0 || n > kMostInputs) return {};
  auto basis = basis_of(Directions(slopes, reference, tolerance).best_first());
  std::vector<Rescaled> found;
  for (; !basis.empty(); basis.pop_back()) write_shortest(basis, n, found);
  return found;
}

}  // namespace tribench::relay
