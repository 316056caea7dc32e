// SPDX-License-Identifier: MIT
#include "algorithms/inference/burst_likelihood.hpp"

#include <algorithm>
#include <cmath>

#include "foundation/elementary.hpp"

namespace tribench::loop {
namespace {

// A spell is so many times as loud as the rest.
constexpr std::array<double, 3> kLoudness = {2, 4, 8};
constexpr std::size_t kWindow = 9;  // rows in which spells are looked for
// Spells are reckoned with once the rows speak for them at these odds.
constexpr double kOdds = 10;
constexpr double kFirstShare = 0.1;
constexpr int kRounds = 30;        // of expectation and maximisation
constexpr double kMostNats = 600;  // what is likelier is as good as certain

// x to the power -(freedom + 1) / 2, of which twice is an integer.
double student_power(double x, double freedom) {
  const auto twice = static_cast<int>(freedom) + 1;
  double base = 1 / x;
  double result = twice % 2 == 0 ? 1 : std::sqrt(base);
  for (int n = twice / 2; n > 0; n /= 2, base *= base) {
    if (n % 2 == 1) result *= base;
  }
  return result;
}

// The kernels of rows on either side of 0, multiplied.
struct SideProducts {
  double below = 1;
  double above = 1;
  double rows_above = 0;
  void add(const StudentLaw& law, double z) {
    (z > 0 ? above : below) *= law.kernel(z);
    rows_above += z > 0 ? 1 : (z < 0 ? 0 : 0.5);
  }
};

// pulse_likelihood where the sides have laws of their own, so that the kernels' powers differ.
double skewed_likelihood(const StudentLaw& law, const double* z, const double* unit, double height,
                         std::size_t rows, const NoiseLevels& levels) {
  SideProducts without;
  for (std::size_t k = 0; k < rows; ++k) without.add(law, z[k]);
  double sum = 0;
  for (std::size_t q = 0; q < levels.factor.size(); ++q) {
    const StudentLaw own = law.times(levels.factor[q]);
    SideProducts with;
    for (std::size_t k = 0; k < rows; ++k) with.add(own, z[k] - height * unit[k]);
    double nats = (with.rows_above - without.rows_above) * law.log_density_ratio;
    nats -= static_cast<double>(rows) * elementary::log(levels.factor[q]);
    // Both at once: of mirrored rows the same bits.
    nats -= 0.5 * ((law.below.freedom + 1) * elementary::log(with.below / without.below) +
                   (law.above.freedom + 1) * elementary::log(with.above / without.above));
    sum += NoiseLevels::kWeights[q] * elementary::exp(std::min(nats, kMostNats));
  }
  return sum;
}

// Of every window without a row left out: how much likelier it is in a loud spell.
std::vector<double> odds_of_loudness(const BurstNoise& noise, const std::vector<char>& left_out) {
  std::vector<double> odds;
  for (std::size_t m = 0; m < noise.movements().size(); ++m) {
    const RowRange& range = noise.movements()[m];
    for (std::size_t i = range.begin; i + kWindow <= range.end; i += kWindow) {
      const char* rows = &left_out[i];
      if (std::any_of(rows, rows + kWindow, [](char one) { return one != 0; })) continue;
      const NoiseLevels levels(noise.level_without(m, i, kWindow), noise.level_error(m, kWindow));
      const double* z = &noise.innovation()[i];
      std::array<double, kWindow> inverse_kernels{};
      for (std::size_t k = 0; k < kWindow; ++k) inverse_kernels[k] = 1 / noise.law().kernel(z[k]);
      const QuietLikelihood at =
          quiet_likelihood(noise.law(), z, kWindow, levels, inverse_kernels.data());
      odds.push_back(at.loud / at.plain);
    }
  }
  return odds;
}

}  // namespace

NoiseLevels::NoiseLevels(double middle, double error) {
  for (std::size_t q = 0; q < kNodes.size(); ++q) {
    factor[q] = middle * elementary::exp(kNodes[q] * error);
  }
}

NoiseLevels NoiseLevels::times(double loudness) const {
  NoiseLevels out = *this;
  for (double& one : out.factor) one *= loudness;
  return out;
}

double NoiseLevels::draw(RandomStream& random) const {
  double left = random.uniform();
  std::size_t q = 0;
  while (q + 1 < kWeights.size() && left >= kWeights[q]) left -= kWeights[q++];
  return factor[q];
}

double pulse_likelihood(const StudentLaw& law, const double* z, const double* unit, double height,
                        std::size_t rows, const NoiseLevels& levels,
                        const double* inverse_kernels) {
  if (!law.is_even()) return skewed_likelihood(law, z, unit, height, rows, levels);
  double sum = 0;
  for (std::size_t q = 0; q < levels.factor.size(); ++q) {
    const double inverse = 1 / (levels.factor[q] * law.above.scale);
    double product = 1;
    double scales = 1;
    for (std::size_t k = 0; k < rows; ++k) {
      const double x = (z[k] - height * unit[k]) * inverse;
      product *= (1 + x * x / law.above.freedom) * inverse_kernels[k];
      scales *= inverse * law.above.scale;
    }
    sum += NoiseLevels::kWeights[q] * scales * student_power(product, law.above.freedom);
  }
  return sum;
}

QuietLikelihood quiet_likelihood(const StudentLaw& law, const double* z, std::size_t rows,
                                 const NoiseLevels& levels, const double* inverse_kernels) {
  constexpr std::array<double, kLongestPulse> kNoPulse{};
  const auto at = [&](const NoiseLevels& all) {
    return pulse_likelihood(law, z, kNoPulse.data(), 0, rows, all, inverse_kernels);
  };
  QuietLikelihood out;
  out.plain = at(levels);
  for (const double loudness : kLoudness) out.loud += at(levels.times(loudness));
  out.loud /= static_cast<double>(kLoudness.size());
  return out;
}

double share_of_loud_spells(const BurstNoise& noise, const std::vector<char>& left_out) {
  const std::vector<double> odds = odds_of_loudness(noise, left_out);
  if (odds.empty()) return 0;
  double share = kFirstShare;
  double nats = 0;
  for (int round = 0; round < kRounds; ++round) {
    double sum = 0;
    nats = 0;
    for (const double one : odds) {
      const double mixture = 1 - share + share * one;
      nats += elementary::log(mixture);
      sum += share * one / mixture;
    }
    share = sum / static_cast<double>(odds.size());
  }
  return nats > elementary::log(kOdds) ? share : 0;
}

}  // namespace tribench::loop
