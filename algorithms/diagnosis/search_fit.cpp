// SPDX-License-Identifier: MIT
//
// A model fitted in the coordinates of its own noise.
#include "algorithms/diagnosis/search.hpp"

namespace tribench::loop {
namespace {

// Where correlated noise is all that is wrong, fits with and without whitening agree but for noise.
// Where they do not, the model lacks something fast (what happens at reversals, a filter's shadow),
// and to look at changes within a movement would fit that. Hausman 1978: the difference in the
// fitted values against what it can be at most by noise alone, parameter by parameter.
bool whitening_is_safe(const LoopModel& model, const Observations& data, const Clusters& clusters,
                       const Noise& noise) {
  const Eigen::MatrixXd x = tangent(model, data);
  const Eigen::VectorXd y = target_vector(data) - predict(model, data);
  if (x.cols() == 0) return true;
  Noise plain;
  plain.within_sd = 1;
  const Eigen::MatrixXd weighted = whitened(x, clusters, plain);
  const Eigen::VectorXd one = least_squares(weighted, whitened(y, clusters, plain));
  const Eigen::VectorXd other =
      least_squares(whitened(x, clusters, noise), whitened(y, clusters, noise));
  const double rows =
      static_cast<double>(data.rows()) / static_cast<double>(clusters.movements.size());
  const double most = noise.within_sd * noise.within_sd * noise.inflation +
                      rows * noise.between_sd * noise.between_sd;
  return (weighted * (one - other)).squaredNorm() < most * static_cast<double>(x.cols());
}

}  // namespace

FittedModel Search::fit(LoopModel model, FitScope scope) const {
  FittedModel out;
  Noise plain;
  plain.within_sd = 1;
  Noise noise = plain;
  Noise weighing = plain;  // how the coefficients are fitted: plain least squares at first
  const bool formula = !model.base.formula.empty();
  bool safe = true;
  for (int pass = 0; pass < 3; ++pass) {
    // A formula's constants are moved by every pass: the first must start from its best fit, and
    // the last must undo what a whitening that is not safe has done to them.
    const bool refine = pass == 1 || (formula && (pass == 0 || !safe));
    fit_model(model, data_, clusters_, weighing, refine ? scope : FitScope::linear);
    if (pass == 2) break;
    const Eigen::VectorXd residual = target_vector(data_) - predict(model, data_);
    const auto fitted = static_cast<std::size_t>(model.coefficients.size());
    noise = estimate_noise(residual, clusters_, fitted, noise_floor_);
    weighing = noise;
    if (pass == 0 || !options_.has("whitening")) continue;
    noise.whitening = noise.rho;
    weighing = noise;
    if (whitening_is_safe(model, data_, clusters_, noise)) continue;
    noise.whitening = 0;
    // A model that is wrong predicts best as plain least squares has it.
    safe = whitening_is_safe(model, data_, clusters_, noise);
    weighing = safe ? noise : plain;
  }
  out.raw_tangent = tangent(model, data_);
  out.raw_residual = target_vector(data_) - predict(model, data_);
  out.x = whitened(out.raw_tangent, clusters_, noise);
  out.basis = orthonormal_basis(out.x);
  out.residual = project_off(whitened(out.raw_residual, clusters_, noise), out.basis);
  out.losses = held_out_losses(out.x, out.residual, clusters_, noise);
  out.model = std::move(model);
  out.noise = noise;
  return out;
}

}  // namespace tribench::loop
