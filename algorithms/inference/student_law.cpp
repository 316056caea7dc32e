// SPDX-License-Identifier: MIT
#include "algorithms/inference/student_law.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "foundation/elementary.hpp"

namespace tribench::loop {
namespace {

constexpr std::array<double, 6> kDegreesOfFreedom = {3, 4, 5, 7, 12, 40};

// Of the kernels; a logarithm of the product of eight takes the time of one.
double sum_of_logs(std::span<const double> z, const StudentLaw& law) {
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

}  // namespace

StudentLaw fit_student(std::span<const double> z) {
  constexpr int kIterations = 8;  // for each law, from where the one before ended
  const auto n = static_cast<double>(z.size());
  StudentLaw best;
  double most = -std::numeric_limits<double>::infinity();
  double variance = 1;
  for (const double freedom : kDegreesOfFreedom) {
    for (int pass = 0; pass < kIterations; ++pass) {
      double sum = 0;
      for (const double x : z) sum += x * x * (freedom + 1) / (freedom + x * x / variance);
      variance = std::max(sum / n, 1e-12);
    }
    const StudentLaw law{freedom, std::sqrt(variance)};
    double likelihood =
        n * (elementary::lgamma((freedom + 1) / 2) - elementary::lgamma(freedom / 2) -
             0.5 * elementary::log(freedom) - elementary::log(law.scale));
    likelihood -= 0.5 * (freedom + 1) * sum_of_logs(z, law);
    if (likelihood > most) {
      most = likelihood;
      best = law;
    }
  }
  return best;
}

double level_of(std::span<const double> z, const StudentLaw& law, double level, int iterations) {
  const double unit = law.scale * law.scale;
  double square = level * level * unit;
  for (int k = 0; k < iterations; ++k) {
    double sum = 0;
    for (const double x : z) sum += x * x * (law.freedom + 1) / (law.freedom + x * x / square);
    square = std::max(sum / static_cast<double>(z.size()), kLeastLevel * kLeastLevel * unit);
  }
  return std::sqrt(square / unit);
}

}  // namespace tribench::loop
