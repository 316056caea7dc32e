// SPDX-License-Identifier: MIT
#include "reports/statistics/permutation_shift.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "foundation/elementary.hpp"
#include "foundation/random.hpp"
#include "reports/statistics/distributions.hpp"

namespace tribench {
namespace {

// About its mean, so that a stratum contributes 0 on average.
std::vector<double> centred(const std::vector<double>& scores) {
  const double mean =
      std::accumulate(scores.begin(), scores.end(), 0.0) / static_cast<double>(scores.size());
  std::vector<double> result = scores;
  for (double& score : result) score -= mean;
  return result;
}

// What drawing `later` of a stratum's scores without replacement, tilted by exp(tilt * their sum),
// needs: mean(i, j) is the mean over all choices of j of the first i scores of the product of their
// exponentials, and follows from that over i - 1.
class TiltedDraws {
 public:
  void prepare(const ShiftStratum& stratum, double tilt) {
    n_ = stratum.scores.size();
    later_ = stratum.later;
    factors_.resize(n_);
    for (std::size_t i = 0; i < n_; ++i) {
      factors_[i] = elementary::exp(tilt * stratum.scores[i]);
    }
    means_.assign((n_ + 1) * (later_ + 1), 0.0);
    means_[0] = 1;
    for (std::size_t i = 1; i <= n_; ++i) {
      mean(i, 0) = 1;
      for (std::size_t j = 1; j <= std::min(i, later_); ++j) {
        const double share = share_of(i, j);
        mean(i, j) = (1 - share) * mean(i - 1, j) + share * factors_[i - 1] * mean(i - 1, j - 1);
      }
    }
  }

  double log_mean() { return elementary::log(mean(n_, later_)); }

  // The sum of one such draw.
  double draw(const ShiftStratum& stratum, RandomStream& random) {
    double sum = 0;
    std::size_t j = later_;
    for (std::size_t i = n_; j > 0; --i) {
      const double taken = share_of(i, j) * factors_[i - 1] * mean(i - 1, j - 1);
      if (random.uniform() * mean(i, j) >= taken && j < i) continue;
      sum += stratum.scores[i - 1];
      --j;
    }
    return sum;
  }

 private:
  static double share_of(std::size_t i, std::size_t j) {
    return static_cast<double>(j) / static_cast<double>(i);
  }
  double& mean(std::size_t i, std::size_t j) { return means_[i * (later_ + 1) + j]; }

  std::size_t n_ = 0;
  std::size_t later_ = 0;
  std::vector<double> factors_;
  std::vector<double> means_;
};

class Tail {
 public:
  explicit Tail(std::span<const ShiftStratum> strata) {
    for (const ShiftStratum& stratum : strata) {
      if (stratum.later == 0 || stratum.later >= stratum.scores.size()) continue;
      add({centred(stratum.scores), stratum.later});
    }
    draws_.resize(strata_.size());
  }

  double z() const { return variance_ > 0 ? statistic_ / std::sqrt(variance_) : 0; }

  // log of Chernoff's bound. Convex in the tilt, and valid for any: the search need not be exact.
  // It ends where exponents would leave the range of doubles. Leaves the draws tilted.
  double log_bound() {
    constexpr double kLargestExponent = 600;
    constexpr double kGolden = 0.6180339887498949;
    double low = 0;
    double high = std::min(kLargestExponent / reach_, 20 * statistic_ / variance_);
    double left = high - kGolden * (high - low);
    double right = low + kGolden * (high - low);
    double at_left = exponent(left);
    double at_right = exponent(right);
    for (int step = 0; step < 24; ++step) {
      if (at_left < at_right) {
        high = right;
        right = std::exchange(left, right - kGolden * (right - low));
        at_right = std::exchange(at_left, exponent(left));
      } else {
        low = left;
        left = std::exchange(right, left + kGolden * (high - left));
        at_left = std::exchange(at_right, exponent(right));
      }
    }
    tilt_ = 0.5 * (left + right);
    return exponent(tilt_);
  }

  // By importance sampling from the tilted draws, half of which lie beyond the observed statistic
  // however rare that is: the mean, made larger by two of its standard errors.
  double sampled(double log_bound) {
    const RandomStream random(key_of("permutation shift"));
    double sum = 0;
    double squares = 0;
    for (std::size_t round = 0; static_cast<double>(round) < kRounds; ++round) {
      RandomStream stream = random.split(round);
      double drawn = 0;
      for (std::size_t k = 0; k < strata_.size(); ++k) drawn += draws_[k].draw(strata_[k], stream);
      const double beyond = drawn - statistic_;
      if (beyond < -kRounding * (1 + std::abs(statistic_))) continue;
      const double weight = elementary::exp(-tilt_ * std::max(0.0, beyond));
      sum += weight;
      squares += weight * weight;
    }
    const double mean = sum / kRounds;
    const double error = std::sqrt(std::max(0.0, squares / kRounds - mean * mean) / kRounds);
    return elementary::exp(log_bound) * std::min(1.0, mean + 2 * error);
  }

 private:
  static constexpr double kRounds = 1000;
  static constexpr double kRounding = 1e-9;

  void add(ShiftStratum stratum) {
    const std::vector<double>& scores = stratum.scores;
    statistic_ += std::accumulate(scores.end() - static_cast<std::ptrdiff_t>(stratum.later),
                                  scores.end(), 0.0);
    double squares = 0;
    double largest = 0;
    for (const double score : scores) {
      squares += score * score;
      largest = std::max(largest, std::abs(score));
    }
    const auto later = static_cast<double>(stratum.later);
    const auto all = static_cast<double>(scores.size());
    variance_ += squares * later * (all - later) / (all * (all - 1));
    reach_ = std::max(reach_, largest * later);
    strata_.push_back(std::move(stratum));
  }

  double exponent(double tilt) {
    double sum = -tilt * statistic_;
    for (std::size_t k = 0; k < strata_.size(); ++k) {
      draws_[k].prepare(strata_[k], tilt);
      sum += draws_[k].log_mean();
    }
    return sum;
  }

  std::vector<ShiftStratum> strata_;
  std::vector<TiltedDraws> draws_;
  double statistic_ = 0;
  double variance_ = 0;
  double reach_ = 0;  // of an exponent, for a tilt of 1
  double tilt_ = 0;
};

// Nearer to 0 no tail is worth its cost. A sum of bounded scores has a lighter tail than a normal
// one; where all of 20 equal strata point one way, by a seventh of z.
double least_z(double largest_told) {
  constexpr double kLightest = 0.6;
  return largest_told < 0.5 ? std::max(1.0, -kLightest * normal_quantile(largest_told)) : 1.0;
}

}  // namespace

double permutation_shift_p(std::span<const ShiftStratum> strata, double largest_told) {
  Tail tail(strata);
  if (tail.z() < least_z(largest_told)) return 1;
  const double log_bound = tail.log_bound();
  // The bound is some ten times too large where it matters; far above what is asked for it does.
  constexpr double kSlack = 100;
  if (log_bound > elementary::log(kSlack * largest_told)) {
    return std::min(1.0, elementary::exp(log_bound));
  }
  return std::min(1.0, tail.sampled(log_bound));
}

}  // namespace tribench
