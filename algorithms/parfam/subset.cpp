// SPDX-License-Identifier: MIT
#include "algorithms/parfam/subset.hpp"

#include <algorithm>
#include <cmath>

namespace tribench::parfam {
namespace {

constexpr double kDependent = 1e-10;      // share of a column's square that must be new
constexpr double kRoundingLeft = 1e-24;   // of y's square
constexpr double kWorthwhile = 1 - 1e-9;  // an exchange must win more than rounding
constexpr int kMaxRounds = 20;

struct Addition {
  std::size_t candidate = 0;
  double gain = -1;
};

class Selector {
 public:
  Selector(std::span<const double> gram, std::size_t candidates)
      : gram_(gram), m_(candidates), stride_(candidates + 1) {}

  // The candidate that adds most to `base`, and what it takes off the sum of squares.
  Addition best_addition(std::span<const std::size_t> base);
  // Sum of squares left by `base`; valid after best_addition(base).
  double left() const { return left_; }

 private:
  double at(std::size_t i, std::size_t j) const { return gram_[i * stride_ + j]; }

  std::span<const double> gram_;
  std::size_t m_;
  std::size_t stride_;
  double left_ = 0;
  std::vector<double> factor_;
  std::vector<double> solved_;
};

Addition Selector::best_addition(std::span<const std::size_t> base) {
  const std::size_t p = base.size();
  factor_.assign(p * p, 0.0);
  solved_.resize(p);
  // Solves L x = column of `which` in the base's coordinates.
  const auto solve = [&](std::size_t which, std::size_t rows, double* x) {
    double norm = 0;
    for (std::size_t i = 0; i < rows; ++i) {
      double entry = at(base[i], which);
      for (std::size_t k = 0; k < i; ++k) entry -= factor_[i * p + k] * x[k];
      x[i] = entry / factor_[i * p + i];
      norm += x[i] * x[i];
    }
    return norm;
  };
  for (std::size_t j = 0; j < p; ++j) {
    const double norm = solve(base[j], j, factor_.data() + j * p);
    factor_[j * p + j] = std::sqrt(std::max(at(base[j], base[j]) - norm, 1e-300));
  }
  std::vector<double> target(p);
  left_ = at(m_, m_) - solve(m_, p, target.data());
  Addition best;
  for (std::size_t c = 0; c < m_; ++c) {
    const double square = at(c, c);
    const double fresh = square - solve(c, p, solved_.data());
    if (!(fresh > kDependent * square)) continue;
    double with_target = at(c, m_);
    for (std::size_t k = 0; k < p; ++k) with_target -= solved_[k] * target[k];
    const double gain = with_target * with_target / fresh;
    if (gain > best.gain) best = {c, gain};
  }
  return best;
}

// Replaces one column after the other by the best in its place until nothing changes.
double exchange(Selector& selector, std::vector<std::size_t>& chosen, double left) {
  for (int round = 0; round < kMaxRounds; ++round) {
    bool changed = false;
    for (std::size_t place = 0; place < chosen.size(); ++place) {
      std::vector<std::size_t> base = chosen;
      base.erase(base.begin() + static_cast<std::ptrdiff_t>(place));
      const Addition choice = selector.best_addition(base);
      const double reached = selector.left() - choice.gain;
      if (choice.gain < 0 || choice.candidate == chosen[place] || !(reached < kWorthwhile * left)) {
        continue;
      }
      chosen[place] = choice.candidate;
      left = reached;
      changed = true;
    }
    if (!changed) break;
  }
  return left;
}

}  // namespace

std::vector<Subset> best_subsets(std::span<const double> gram, std::size_t candidates,
                                 std::size_t max_terms) {
  Selector selector(gram, candidates);
  const double total = gram[candidates * (candidates + 1) + candidates];
  std::vector<Subset> path;
  std::vector<std::size_t> chosen;
  while (chosen.size() < std::min(max_terms, candidates)) {
    const Addition choice = selector.best_addition(chosen);
    if (choice.gain < 0) break;
    double left = selector.left() - choice.gain;
    chosen.push_back(choice.candidate);
    if (chosen.size() > 1) left = exchange(selector, chosen, left);
    Subset subset{chosen, std::max(left, 0.0)};
    std::ranges::sort(subset.chosen);
    path.push_back(std::move(subset));
    if (!(left > kRoundingLeft * total)) break;
  }
  return path;
}

}  // namespace tribench::parfam
