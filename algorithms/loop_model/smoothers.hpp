// SPDX-License-Identifier: MIT
//
// Flexible bases in one or two signals: what finds structure that no effect of the library
// explains, and says in which inputs it lives. Radial functions in one signal, random Fourier
// features (Rahimi and Recht 2007) in two, each with and without the direction of motion.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/inference/flips.hpp"
#include "algorithms/loop_model/signal_table.hpp"
#include "foundation/random.hpp"

namespace tribench::loop {

struct Smoother {
  std::vector<std::string> signals;  // one or two
  std::vector<std::string> inputs;   // their role names: "velocity", "position", ...
  FloatRows features;                // rows x features
};

// All smoothers that the data have the signals for.
std::vector<Smoother> make_smoothers(const Observations& data, RandomStream random);

// In one signal that varies; so many radial functions, by default as smooth as those in two.
inline constexpr int kSmoothCentres = 6;
Smoother smooth_single(const Observations& data, std::string_view signal,
                       int centres = kSmoothCentres);

// The direction of motion, a row, the first one positive (mirror_sign); empty where the data have
// none.
Eigen::VectorXf direction_of(const Observations& data);

// The features, then the same times the direction.
Eigen::MatrixXd with_direction(const Smoother& smoother, const Observations& data);

// The pairs of signals in which smoothers look for products.
using SignalPair = std::array<std::string_view, 2>;
std::span<const SignalPair> smoothed_pairs();

// The signal as smoothers see it (|v| for v), centred and of unit rms; empty where it does not
// vary.
Eigen::VectorXd unit_signal(const Observations& data, std::string_view name);

// The name under which a signal is reported: its role's.
std::string input_name(const Observations& data, std::string_view signal);

}  // namespace tribench::loop
