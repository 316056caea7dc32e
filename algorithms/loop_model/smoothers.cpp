// SPDX-License-Identifier: MIT
#include "algorithms/loop_model/smoothers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/vector/kernels.hpp"
#include "algorithms/expression/vector/level.hpp"
#include "foundation/elementary.hpp"
#include "problems/preparation/canonical.hpp"

namespace tribench::loop {
namespace {

struct OneSignal {
  std::string_view signal;
  int centres;
};

// Specification, section 3.8, but for the time since a movement began.
constexpr std::array<OneSignal, 9> kSingles = {{{"v", 16},
                                                {"q", 28},
                                                {"g", 10},
                                                {"T", 8},
                                                {"t", 24},
                                                {"d", 8},
                                                {"a", 8},
                                                {"v2", 8},
                                                {Signal::kSinceStart, 8}}};
constexpr std::array<SignalPair, 5> kPairs = {
    {{"v", "q"}, {"q", "T"}, {"v", "T"}, {"v", "g"}, {"g", "T"}}};
constexpr Eigen::Index kFourierFeatures = 30;
// Of the unit interval into which a signal is mapped; kSmoothCentres radial functions are as wide.
constexpr double kFourierLength = 0.22;

// Of a radial function, in widths: 1e-10 is nothing, but products of such numbers are denormal,
// which takes the processor thirty times as long.
constexpr float kReach = 6.8F;
constexpr float kNothing = -1000;  // its exponential is 0

// The signal mapped to [0, 1]: |v|, log of the distance and of the time since the start, anything
// else as it is, in the direction that is the first (mirror_sign). Empty where it does not vary.
Eigen::ArrayXf unit_values(const Observations& data, std::string_view name) {
  const Signal* signal = data.find(name);
  if (signal == nullptr || signal->values.empty()) return {};
  Eigen::ArrayXd x = Eigen::Map<const Eigen::ArrayXd>(
      signal->values.data(), static_cast<Eigen::Index>(signal->values.size()));
  if (name == "v") x = x.abs();
  constexpr std::array<std::string_view, 4> kSigned = {"q", "g", "a", "v2"};
  if (std::ranges::count(kSigned, name) > 0) x *= mirror_sign(data);
  const bool fades = name == "d" || name == Signal::kSinceStart;
  if (fades && x.maxCoeff() > 0) x = (x / x.maxCoeff() + 1e-3).unaryExpr(&elementary::log);
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

// The evaluator's own function of every element: fast, and the same bits on every machine.
void apply(Op function, FloatRows& x) {
  const auto n = static_cast<std::size_t>(x.size());
  const int place = static_cast<int>(function) - static_cast<int>(Op::neg);
  kernel_table<float>(vector_level()).function[place](x.data(), x.data(), nullptr, nullptr, n);
}

FloatRows radial(const Eigen::ArrayXf& x, int centres) {
  FloatRows out(x.size(), centres);
  const auto inverse_spacing = static_cast<float>(centres - 1);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const float place = x[i] * inverse_spacing;
    float* row = out.row(i).data();
    for (int k = 0; k < centres; ++k) {
      const float apart = place - static_cast<float>(k);
      row[k] = std::abs(apart) < kReach ? -0.5F * apart * apart : kNothing;
    }
  }
  apply(Op::exp, out);
  return out;
}

FloatRows fourier(const Eigen::ArrayXf& x, const Eigen::ArrayXf& y, RandomStream random) {
  Eigen::Matrix<float, 3, kFourierFeatures> waves;
  for (Eigen::Index k = 0; k < kFourierFeatures; ++k) {
    waves(0, k) = static_cast<float>(random.normal() / kFourierLength);
    waves(1, k) = static_cast<float>(random.normal() / kFourierLength);
    waves(2, k) = static_cast<float>(random.uniform(0, 2 * std::numbers::pi));
  }
  FloatRows out(x.size(), kFourierFeatures);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    out.row(i) = x[i] * waves.row(0) + y[i] * waves.row(1) + waves.row(2);
  }
  apply(Op::cos, out);
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
  if (signal == Signal::kSinceStart) return "time_since_start";
  const Signal* found = data.find(signal);
  if (found == nullptr) return std::string(signal);
  return found->role == Role::none ? found->channel : std::string(role_name(found->role));
}

Eigen::VectorXf direction_of(const Observations& data) {
  const Signal* sign = data.find("sgn_v");
  if (sign == nullptr) return {};
  const Eigen::Map<const Eigen::VectorXd> s(sign->values.data(),
                                            static_cast<Eigen::Index>(sign->values.size()));
  return (mirror_sign(data) * s).cast<float>();
}

Eigen::MatrixXd with_direction(const Smoother& smoother, const Observations& data) {
  Eigen::MatrixXd features = smoother.features.cast<double>();
  const Eigen::VectorXd s = direction_of(data).cast<double>();
  if (s.size() == 0) return features;
  Eigen::MatrixXd out(features.rows(), 2 * features.cols());
  out << features, s.asDiagonal() * features;
  return out;
}

Smoother smooth_single(const Observations& data, std::string_view signal, int centres) {
  return {{std::string(signal)},
          {input_name(data, signal)},
          radial(unit_values(data, signal), centres)};
}

std::vector<Smoother> make_smoothers(const Observations& data, RandomStream random) {
  std::vector<Smoother> all;
  for (const OneSignal& single : kSingles) {
    const Eigen::ArrayXf x = unit_values(data, single.signal);
    if (x.size() == 0) continue;
    all.push_back({{std::string(single.signal)},
                   {input_name(data, single.signal)},
                   radial(x, single.centres)});
  }
  for (const auto& [first, second] : kPairs) {
    const Eigen::ArrayXf x = unit_values(data, first);
    const Eigen::ArrayXf y = unit_values(data, second);
    if (x.size() == 0 || y.size() == 0) continue;
    const RandomStream part = random.split(std::string(first) + "*" + std::string(second));
    all.push_back({{std::string(first), std::string(second)},
                   {input_name(data, first), input_name(data, second)},
                   fourier(x, y, part)});
  }
  return all;
}

}  // namespace tribench::loop
