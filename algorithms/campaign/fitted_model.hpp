// SPDX-License-Identifier: MIT
//
// A model fitted to a campaign in the coordinates of its own noise, and what one model predicts
// better than another.
#pragma once

#include <Eigen/Core>

#include "algorithms/campaign/campaign.hpp"
#include "algorithms/inference/cross_validation.hpp"
#include "algorithms/loop_model/model_fit.hpp"

namespace tribench::loop {

struct FittedModel {
  LoopModel model;
  Noise noise;
  Eigen::MatrixXd x;            // whitened raw_tangent
  Eigen::MatrixXd basis;        // of the whole whitened tangent, orthonormal
  Eigen::VectorXd residual;     // whitened, orthogonal to the basis
  StretchGrams grams;           // of [x residual]
  Eigen::VectorXd losses;       // held-out, by stretch
  Eigen::MatrixXd raw_tangent;  // told_tangent
  Eigen::VectorXd raw_residual;
};

// The tangent, with zeros for those constants of the base that one fold alone tells: how well they
// predict elsewhere nobody can say, and they stay as they are fitted. A base's curve that is not
// there in the data can go anywhere (a Stribeck curve that falls within a row), and no effect could
// be judged beside it.
Eigen::MatrixXd told_tangent(const LoopModel& model, const Campaign& campaign);

// Noise and coefficients in turn. scope: what is fitted besides the coefficients.
FittedModel fit_in_its_noise(LoopModel model, const Campaign& campaign, FitScope scope);

// Held-out losses of the model with whitened columns beside its own. ridge: on these.
Eigen::VectorXd losses_beside(const FittedModel& model, const Eigen::MatrixXd& columns,
                              const Campaign& campaign, double ridge = 0);

// What `other` predicts better than `present`, by cross-validation in the noise of `present`.
Gain lead_over(const FittedModel& present, const FittedModel& other, const Campaign& campaign);

// What `present` predicts better than it would without these families.
Gain gain_of(const std::vector<std::size_t>& families, const FittedModel& present,
             const Campaign& campaign);

}  // namespace tribench::loop
