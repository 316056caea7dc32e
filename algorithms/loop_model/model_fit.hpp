// SPDX-License-Identifier: MIT
//
// Fits a loop's model to rows: linear coefficients exactly, shapes and a base's constants by damped
// steps of variable projection (Golub and Pereyra 1973; the Jacobian as Kaufman 1975), in the
// metric of a noise. And the directions in which a fitted model can move.
#pragma once

#include <Eigen/Core>

#include "algorithms/inference/noise.hpp"
#include "algorithms/loop_model/loop_model.hpp"

namespace tribench::loop {

// Least squares in which columns that depend on others get no weight.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& columns, const Eigen::VectorXd& target);

// Every direction in which the fitted model can move: base constants, linear terms, atoms' columns
// and their refined shapes; zeros for a shape that stands at its bound. rows x directions.
Eigen::MatrixXd tangent(const LoopModel& model, const Observations& data);

enum class FitScope { linear, everything };

// Fits to data.target, in the metric of `noise`. Leaves the model no worse than it was. A shape
// that hits its bound stays there. Cost: a few dozen evaluations of the non-linear columns and
// their products with the others.
void fit_model(LoopModel& model, const Observations& data, const Clusters& clusters,
               const Noise& noise, FitScope scope);

}  // namespace tribench::loop
