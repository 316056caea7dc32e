// SPDX-License-Identifier: MIT
//
// How well velocity and acceleration are derived from an encoder's position: the Kalman smoother of
// problems/preparation, which chooses everything from the data, against a Savitzky-Golay filter and
// a smoothing spline that are given the width that is best knowing the truth, and a spline that
// chooses its width by generalised cross-validation (Craven, Wahba 1979).
//
// Joints run under a controller (problems/joint_simulation/controlled_run.hpp).
#pragma once

#include <cstdint>
#include <vector>

namespace tribench {

struct SmootherStudyOptions {
  std::vector<int> bits = {12, 14, 16, 18, 20};  // counts of a turn: 2^bits
  std::vector<double> rates_hz = {250, 1000};    // divide 1000
  int runs = 2;
  double seconds = 30;  // of each
  std::uint64_t first_seed = 1;
};

// Root mean square errors while the joint moves.
struct DerivativeErrors {
  double velocity = 0;      // rad/s
  double acceleration = 0;  // rad/s^2
};

struct SmootherFigure {
  int bits = 0;
  double rate_hz = 0;
  DerivativeErrors kalman;
  DerivativeErrors savitzky_golay;    // cubic; the best width for velocity and acceleration each
  DerivativeErrors spline;            // third differences penalised; the best width for each
  DerivativeErrors validated_spline;  // width by generalised cross-validation
};

// One figure a rate and number of bits, by rate. Cost: about 2 s a figure.
std::vector<SmootherFigure> run_smoother_study(const SmootherStudyOptions& options);

}  // namespace tribench
