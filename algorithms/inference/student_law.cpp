// SPDX-License-Identifier: MIT
#include "algorithms/inference/student_law.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "foundation/elementary.hpp"

namespace tribench::loop {
namespace {

constexpr std::array<double, 6> kDegreesOfFreedom = {3, 4, 5, 7, 12, 40};

// Of the kernels; a logarithm of the product of eight takes the time of one.
double sum_of_logs(std::span<const double> z, const StudentSide& law) {
  double sum = 0;
  double product = 1;
  for (std::size_t i = 0; i < z.size(); ++i) {
    product *= law.kernel(z[i]);
    if (i % 8 < 7 && i + 1 < z.size() && product < 1e30) continue;
    sum += elementary::log(product);
    product = 1;
  }
  return sum;
}

// But for a constant.
double log_density_at_0(const StudentSide& law) {
  return elementary::lgamma((law.freedom + 1) / 2) - elementary::lgamma(law.freedom / 2) -
         0.5 * elementary::log(law.freedom) - elementary::log(law.scale);
}

// A row's square counts top z^2 / (spread + z^2) where the noise has heavy tails.
struct TailWeight {
  double top;
  double spread;
  // Of a law whose rows are so many times as loud; what is summed is the square of that.
  TailWeight(const StudentSide& law, double square)
      : top((law.freedom + 1) * square), spread(law.freedom * law.scale * law.scale * square) {}
};

double weighted_squares(std::span<const double> z, const TailWeight& below,
                        const TailWeight& above) {
  constexpr std::size_t kSums = 4;  // at once: one would wait for itself
  std::array<double, kSums> sums = {};
  const auto weighted = [&](double x) {
    const TailWeight& own = x > 0 ? above : below;
    return own.top * x * x / (own.spread + x * x);
  };
  std::size_t i = 0;
  for (; i + kSums <= z.size(); i += kSums) {
    for (std::size_t k = 0; k < kSums; ++k) sums[k] += weighted(z[i + k]);
  }
  for (; i < z.size(); ++i) sums[0] += weighted(z[i]);
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

struct FittedSide {
  StudentSide law;
  double log_likelihood = -std::numeric_limits<double>::infinity();
};

FittedSide fit_side(std::span<const double> z) {
  constexpr int kIterations = 8;  // for each law, from where the one before ended
  const auto n = static_cast<double>(z.size());
  FittedSide best;
  double variance = 1;
  for (const double freedom : kDegreesOfFreedom) {
    for (int pass = 0; pass < kIterations; ++pass) {
      const TailWeight weight({freedom, 1}, variance);
      variance = std::max(weighted_squares(z, weight, weight) / n, 1e-12);
    }
    const StudentSide law{freedom, std::sqrt(variance)};
    const double likelihood = n * log_density_at_0(law) - 0.5 * (freedom + 1) * sum_of_logs(z, law);
    if (likelihood > best.log_likelihood) best = {law, likelihood};
  }
  return best;
}

}  // namespace

StudentLaw fit_student(std::span<const double> z) {
  const FittedSide both = fit_side(z);
  StudentLaw even(both.law.freedom, both.law.scale);
  std::vector<double> below;
  std::vector<double> above;
  for (const double x : z) {
    if (x != 0) (x > 0 ? above : below).push_back(x);
  }
  // Half of what lies at 0 is either side's.
  const std::size_t zeros = (z.size() - below.size() - above.size()) / 2;
  below.insert(below.end(), zeros, 0.0);
  above.insert(above.end(), zeros, 0.0);
  if (below.empty() || above.empty()) return even;
  const FittedSide low = fit_side(below);
  const FittedSide high = fit_side(above);
  const double gained = low.log_likelihood + high.log_likelihood - both.log_likelihood;
  if (!(gained > elementary::log(static_cast<double>(z.size())))) return even;
  StudentLaw skewed;
  skewed.below = low.law;
  skewed.above = high.law;
  skewed.log_density_ratio = log_density_at_0(high.law) - log_density_at_0(low.law);
  return skewed;
}

double level_of(std::span<const double> z, const StudentLaw& law, double level, int iterations) {
  double square = level * level;
  for (int k = 0; k < iterations; ++k) {
    const double sum = weighted_squares(z, {law.below, square}, {law.above, square});
    square = std::max(sum / static_cast<double>(z.size()), kLeastLevel * kLeastLevel);
  }
  return std::sqrt(square);
}

}  // namespace tribench::loop
