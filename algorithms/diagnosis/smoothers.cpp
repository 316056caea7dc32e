// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/smoothers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tribench::loop {
namespace {

struct OneSignal {
  const char* signal;
  int centres;
};

// Specification, section 3.8.
constexpr std::array<OneSignal, 8> kSingles = {
    {{"v", 16}, {"q", 28}, {"g", 10}, {"T", 8}, {"t", 24}, {"d", 8}, {"a", 8}, {"v2", 8}}};
constexpr std::array<SignalPair, 5> kPairs = {
    {{"v", "q"}, {"q", "T"}, {"v", "T"}, {"v", "g"}, {"g", "T"}}};
constexpr Eigen::Index kFourierFeatures = 30;
// Of the unit interval into which a signal is mapped.
constexpr double kFourierLength = 0.22;

// The signal mapped to [0, 1]: |v|, log of the distance, anything else as it is. Empty where it
// does not vary.
Eigen::ArrayXf unit_values(const Observations& data, std::string_view name) {
  const Signal* signal = data.find(name);
  if (signal == nullptr || signal->values.empty()) return {};
  Eigen::ArrayXd x = Eigen::Map<const Eigen::ArrayXd>(
      signal->values.data(), static_cast<Eigen::Index>(signal->values.size()));
  if (name == "v") x = x.abs();
  if (name == "d") x = (x + 1e-3 * x.maxCoeff() + 1e-12).log();
  // The bulk of the values spans the interval: one far-off row must not flatten the rest.
  std::vector<double> values(x.begin(), x.end());
  const auto edge = static_cast<std::ptrdiff_t>(values.size() / 200);
  std::ranges::nth_element(values, values.begin() + edge);
  const double low = values[static_cast<std::size_t>(edge)];
  std::ranges::nth_element(values, values.end() - 1 - edge);
  const double high = *(values.end() - 1 - edge);
  if (!(high > low)) return {};
  return ((x - low) / (high - low)).max(-0.1).min(1.1).cast<float>();
}

Eigen::MatrixXf radial(const Eigen::ArrayXf& x, int centres) {
  Eigen::MatrixXf out(x.size(), centres);
  const float spacing = 1.0F / static_cast<float>(centres - 1);
  for (int k = 0; k < centres; ++k) {
    out.col(k) = (-0.5F * ((x - static_cast<float>(k) * spacing) / spacing).square()).exp();
  }
  return out;
}

Eigen::MatrixXf fourier(const Eigen::ArrayXf& x, const Eigen::ArrayXf& y, RandomStream random) {
  Eigen::MatrixXf out(x.size(), kFourierFeatures);
  for (Eigen::Index k = 0; k < kFourierFeatures; ++k) {
    const auto wx = static_cast<float>(random.normal() / kFourierLength);
    const auto wy = static_cast<float>(random.normal() / kFourierLength);
    const auto phase = static_cast<float>(random.uniform(0, 2 * std::numbers::pi));
    out.col(k) = (wx * x + wy * y + phase).cos();
  }
  return out;
}

Eigen::MatrixXf with_direction(const Eigen::MatrixXf& features, const Observations& data) {
  const Signal* sign = data.find("sgn_v");
  if (sign == nullptr) return features;
  const Eigen::VectorXf s =
      Eigen::Map<const Eigen::VectorXd>(sign->values.data(), features.rows()).cast<float>();
  Eigen::MatrixXf out(features.rows(), 2 * features.cols());
  out << features, s.asDiagonal() * features;
  return out;
}

}  // namespace

std::span<const SignalPair> smoothed_pairs() { return kPairs; }

Eigen::VectorXd unit_signal(const Observations& data, std::string_view name) {
  Eigen::VectorXd x = unit_values(data, name).cast<double>().matrix();
  if (x.size() == 0) return x;
  x.array() -= x.mean();
  return x * (std::sqrt(static_cast<double>(x.size())) / x.norm());
}

std::string input_name(const Observations& data, std::string_view signal) {
  if (signal == "d") return "distance_since_reversal";
  const Signal* found = data.find(signal);
  if (found == nullptr) return std::string(signal);
  return found->role == Role::none ? found->channel : std::string(role_name(found->role));
}

std::vector<Smoother> make_smoothers(const Observations& data, RandomStream random) {
  std::vector<Smoother> all;
  for (const OneSignal& single : kSingles) {
    const Eigen::ArrayXf x = unit_values(data, single.signal);
    if (x.size() == 0) continue;
    all.push_back({{single.signal},
                   {input_name(data, single.signal)},
                   with_direction(radial(x, single.centres), data)});
  }
  for (const auto& [first, second] : kPairs) {
    const Eigen::ArrayXf x = unit_values(data, first);
    const Eigen::ArrayXf y = unit_values(data, second);
    if (x.size() == 0 || y.size() == 0) continue;
    const RandomStream part = random.split(std::string(first) + "*" + std::string(second));
    all.push_back({{std::string(first), std::string(second)},
                   {input_name(data, first), input_name(data, second)},
                   with_direction(fourier(x, y, part), data)});
  }
  return all;
}

}  // namespace tribench::loop
