// SPDX-License-Identifier: MIT
//
// Constants under Huber's robust loss: quadratic up to a threshold, linear beyond, so that outliers
// pull with bounded force.
//
// Source: Huber 1964; by iteratively reweighted least squares (Holland & Welsch 1977), which never
// raises the loss. Each step is a weighted Levenberg-Marquardt fit.
#pragma once

#include "algorithms/fitting/constant_fit.hpp"

namespace tribench {

struct HuberFitOptions {
  // Where quadratic turns linear, in the target's unit. 0: 1.345 times the median absolute residual
  // / 0.6745 of the formula as given, the usual estimate of the noise (95 % efficient where the
  // noise is Gaussian).
  double threshold = 0;
  int rounds = 20;
  double tolerance = 1e-9;  // relative decrease of the loss that ends the rounds
  ConstantFitOptions fit = {};
};

struct HuberFitResult {
  FitStatus status = FitStatus::no_constants;
  double loss = 0;  // sum of r^2 / 2 up to the threshold t, t |r| - t^2 / 2 beyond
  double threshold = 0;
  std::uint64_t node_rows = 0;
};

// The best constants seen, never worse by the loss than those given. target must be finite.
HuberFitResult fit_huber(ConstantFitter& fitter, Expression& formula, const Inputs& inputs,
                         std::span<const double> target, const HuberFitOptions& options = {});

}  // namespace tribench
