// SPDX-License-Identifier: MIT
#include "problems/measured/decimate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

#include "foundation/elementary.hpp"

namespace tribench::measured {
namespace {

constexpr int kOrder = 8;
constexpr double kRipple_db = 0.05;
constexpr double kCutOff = 0.8;  // of the new Nyquist frequency
constexpr std::size_t kExtension = 24;

// One biquad b (1 + 2/z + 1/z^2) / (1 + a1/z + a2/z^2) with gain 1 at frequency 0.
struct Section {
  double b;
  double a1;
  double a2;
};

// Poles of the analogue prototype (Parks and Burrus 1987), moved by the bilinear transform.
std::array<Section, kOrder / 2> design_sections(int factor) {
  const double epsilon = std::sqrt(elementary::pow(10, kRipple_db / 10) - 1);
  const double mu = elementary::log((1 + std::sqrt(1 + epsilon * epsilon)) / epsilon) / kOrder;
  const double edge = 2 * elementary::tan(std::numbers::pi * kCutOff / factor / 2);
  std::array<Section, kOrder / 2> sections{};
  for (std::size_t k = 0; k < sections.size(); ++k) {
    const double theta = std::numbers::pi * (2 * static_cast<double>(k) + 1) / (2 * kOrder);
    const std::complex<double> pole(-edge * elementary::sinh(mu) * elementary::sin(theta),
                                    edge * elementary::cosh(mu) * elementary::cos(theta));
    const std::complex<double> z = (2.0 + pole) / (2.0 - pole);
    const double a1 = -2 * z.real();
    const double a2 = std::norm(z);
    sections[k] = {(1 + a1 + a2) / 4, a1, a2};
  }
  return sections;
}

// In place; the state starts where a constant first sample would have brought it.
void run(const Section& section, std::vector<double>& signal) {
  const double first = signal.front();
  double second_state = first * (section.b - section.a2);
  double first_state = first * (2 * section.b - section.a1) + second_state;
  for (double& x : signal) {
    const double y = section.b * x + first_state;
    first_state = 2 * section.b * x - section.a1 * y + second_state;
    second_state = section.b * x - section.a2 * y;
    x = y;
  }
}

}  // namespace

std::vector<double> decimate(std::span<const double> signal, int factor) {
  std::vector<double> extended(signal.begin(), signal.end());
  if (factor > 1 && signal.size() > kExtension + 1) {
    extended.clear();
    for (std::size_t i = kExtension; i > 0; --i) extended.push_back(2 * signal[0] - signal[i]);
    extended.insert(extended.end(), signal.begin(), signal.end());
    for (std::size_t i = 0; i < kExtension; ++i) {
      extended.push_back(2 * signal.back() - signal[signal.size() - 2 - i]);
    }
    const auto sections = design_sections(factor);
    for (int pass = 0; pass < 2; ++pass) {
      for (const Section& section : sections) run(section, extended);
      std::reverse(extended.begin(), extended.end());
    }
    extended.erase(extended.begin(), extended.begin() + kExtension);
    extended.resize(signal.size());
  }
  std::vector<double> kept;
  for (std::size_t i = 0; i < extended.size(); i += static_cast<std::size_t>(factor)) {
    kept.push_back(extended[i]);
  }
  return kept;
}

}  // namespace tribench::measured
