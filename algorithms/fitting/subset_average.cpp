// SPDX-License-Identifier: MIT
#include "algorithms/fitting/subset_average.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "foundation/elementary.hpp"

namespace tribench {
namespace {

// Widths of the prior, in rows: from slopes that are hardly seen in the noise to a noise of 1e-10.
constexpr int kNarrowest = -1;
constexpr int kWidest = 10;
constexpr double kLn10 = 2.302585092994046;

class Average {
 public:
  Average(std::span<const double> products, std::size_t rows, std::size_t of)
      : products_(products),
        columns_(static_cast<std::size_t>(std::sqrt(static_cast<double>(products.size()))) - 1),
        rows_(static_cast<double>(rows)),
        most_(rows - 2),
        square_(products.back()),
        slopes_(columns_, 0.0) {
    for (int power = kNarrowest; power <= kWidest; ++power) {
      const double in_rows = elementary::exp(power * kLn10);
      widths_.push_back({in_rows * rows_, elementary::log(1 + in_rows * rows_),
                         elementary::log(in_rows) - 1.5 * elementary::log(1 + in_rows)});
    }
    // 1 / ((of + 1) (of over k)).
    for (std::size_t k = 0; k <= columns_; ++k) {
      const auto n = static_cast<double>(of);
      const auto chosen = static_cast<double>(k);
      priors_.push_back(elementary::lgamma(chosen + 1) + elementary::lgamma(n - chosen + 1) -
                        elementary::lgamma(n + 2));
    }
  }

  std::vector<double> slopes() {
    if (!(square_ > 0)) return slopes_;
    visit(0);
    for (double& slope : slopes_) slope /= total_;
    return slopes_;
  }

 private:
  struct Width {
    double g = 0;
    double log = 0;    // of 1 + g
    double prior = 0;  // log, of a step of the grid
  };

  double product(std::size_t a, std::size_t b) const { return products_[a * (columns_ + 1) + b]; }

  // The subset as it is, and all that have further columns from `next` on besides.
  void visit(std::size_t next) {
    count();
    if (subset_.size() == most_) return;
    for (std::size_t j = next; j < columns_; ++j) {
      if (!push(j)) continue;
      visit(j + 1);
      subset_.pop_back();
    }
  }

  // A row more of the Cholesky factor and of what the target is along it; false where nothing of
  // the column is new.
  bool push(std::size_t j) {
    const std::size_t k = subset_.size();
    double left = product(j, j);
    double along = product(j, columns_);
    for (std::size_t i = 0; i < k; ++i) {
      double entry = product(j, subset_[i]);
      for (std::size_t h = 0; h < i; ++h) entry -= factor_[k][h] * factor_[i][h];
      factor_[k][i] = entry / factor_[i][i];
      left -= factor_[k][i] * factor_[k][i];
      along -= factor_[k][i] * along_[i];
    }
    if (!(left > kNewShare * product(j, j))) return false;
    factor_[k][k] = std::sqrt(left);
    along_[k] = along / factor_[k][k];
    subset_.push_back(j);
    return true;
  }

  void count() {
    const std::size_t k = subset_.size();
    double explained = 0;
    for (std::size_t i = 0; i < k; ++i) explained += along_[i] * along_[i];
    const double left = std::max(0.0, 1 - explained / square_);
    std::array<double, kWidest - kNarrowest + 1> nats{};
    for (std::size_t w = 0; w < widths_.size(); ++w) {
      nats[w] = priors_[k] + widths_[w].prior +
                0.5 * (rows_ - 1 - static_cast<double>(k)) * widths_[w].log -
                0.5 * (rows_ - 1) * elementary::log(1 + widths_[w].g * left);
    }
    rise_to(std::ranges::max(nats));
    double shrunk = 0;
    for (std::size_t w = 0; w < widths_.size(); ++w) {
      const double weight = elementary::exp(nats[w] - level_);
      total_ += weight;
      shrunk += weight * widths_[w].g / (1 + widths_[w].g);
    }
    add(shrunk);
  }

  // Weights are told in units of the largest so far.
  void rise_to(double level) {
    if (level <= level_) return;
    const double scale = total_ > 0 ? elementary::exp(level_ - level) : 0;
    total_ *= scale;
    for (double& slope : slopes_) slope *= scale;
    level_ = level;
  }

  // The subset's own slopes, so many times.
  void add(double weight) {
    for (std::size_t k = subset_.size(); k-- > 0;) {
      double slope = along_[k];
      for (std::size_t i = k + 1; i < subset_.size(); ++i) slope -= factor_[i][k] * own_[i];
      own_[k] = slope / factor_[k][k];
      slopes_[subset_[k]] += weight * own_[k];
    }
  }

  std::span<const double> products_;
  std::size_t columns_;
  double rows_;
  std::size_t most_;
  double square_;  // of the target
  std::vector<Width> widths_;
  std::vector<double> priors_;  // log, of a subset of so many
  std::vector<std::size_t> subset_;
  std::array<std::array<double, kMostAveraged>, kMostAveraged> factor_{};
  std::array<double, kMostAveraged> along_{};
  std::array<double, kMostAveraged> own_{};
  double level_ = -HUGE_VAL;  // log
  double total_ = 0;
  std::vector<double> slopes_;
};

}  // namespace

std::vector<double> average_over_subsets(std::span<const double> products, std::size_t rows,
                                         std::size_t of) {
  return Average(products, rows, of).slopes();
}

}  // namespace tribench
