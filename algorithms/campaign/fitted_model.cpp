// SPDX-License-Identifier: MIT
#include "algorithms/campaign/fitted_model.hpp"

#include <numeric>

#include "algorithms/inference/whitening.hpp"

namespace tribench::loop {
namespace {

Clusters unweighted(Clusters clusters) {
  clusters.weight.clear();
  return clusters;
}

// Where correlated noise is all that is wrong, fits with and without whitening agree but for noise.
// Where they do not, the model lacks something fast (what happens at reversals, a filter's shadow),
// and to look at changes within a movement would fit that. Hausman 1978: the difference in the
// fitted values against what it can be at most by noise alone, parameter by parameter. Plain least
// squares knows no weights of movements either.
bool whitening_is_safe(const LoopModel& model, const Observations& data, const Clusters& clusters,
                       const Noise& noise) {
  const Eigen::MatrixXd x = tangent(model, data);
  const Eigen::VectorXd y = target_vector(data) - predict(model, data);
  if (x.cols() == 0) return true;
  Noise plain;
  plain.within_sd = 1;
  const Clusters even = unweighted(clusters);
  const Eigen::MatrixXd weighted = whitened(x, clusters, plain);
  const Eigen::VectorXd one = least_squares(whitened(x, even, plain), whitened(y, even, plain));
  const Eigen::VectorXd other =
      least_squares(whitened(x, clusters, noise), whitened(y, clusters, noise));
  const double rows =
      static_cast<double>(data.rows()) / static_cast<double>(clusters.movements.size());
  const double most = noise.within_sd * noise.within_sd * noise.inflation() +
                      rows * noise.between_sd * noise.between_sd;
  return (weighted * (one - other)).squaredNorm() < most * static_cast<double>(x.cols());
}

// Of a column's squares, what all folds but one have to have of it to say how large it is.
constexpr double kToldElsewhere = 0.05;

bool is_told_by_one_fold(const Eigen::VectorXd& column, const Clusters& clusters) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(clusters.folds);
  for (std::size_t c = 0; c < clusters.stretches.size(); ++c) {
    const RowRange& rows = clusters.stretches[c];
    squares[clusters.fold_of[c]] +=
        column
            .segment(static_cast<Eigen::Index>(rows.begin), static_cast<Eigen::Index>(rows.size()))
            .squaredNorm();
  }
  const double all = squares.sum();
  return all > 0 && all - squares.maxCoeff() <= kToldElsewhere * all;
}

// The tangent's columns that are the base's: its linear terms, and behind all linear columns its
// constants.
std::vector<Eigen::Index> columns_of_base(const LoopModel& model) {
  std::vector<Eigen::Index> columns(model.base.linear_terms.size());
  std::iota(columns.begin(), columns.end(), Eigen::Index{0});
  const std::size_t linear = linear_columns(model).size();
  for (std::size_t k = 0; k < fitted_constants(model.base).size(); ++k) {
    columns.push_back(static_cast<Eigen::Index>(linear + k));
  }
  return columns;
}

std::vector<Eigen::Index> untold_columns(const Eigen::MatrixXd& tangent, const LoopModel& model,
                                         const Clusters& clusters) {
  std::vector<Eigen::Index> columns = columns_of_base(model);
  std::erase_if(columns,
                [&](Eigen::Index j) { return !is_told_by_one_fold(tangent.col(j), clusters); });
  return columns;
}

}  // namespace

Eigen::MatrixXd told_tangent(const LoopModel& model, const Campaign& campaign) {
  Eigen::MatrixXd x = tangent(model, campaign.data);
  for (const Eigen::Index j : untold_columns(x, model, campaign.clusters)) x.col(j).setZero();
  return x;
}

FittedModel fit_in_its_noise(LoopModel model, const Campaign& campaign, FitScope scope) {
  const Observations& data = campaign.data;
  const Clusters& clusters = campaign.clusters;
  FittedModel out;
  Noise plain;
  plain.within_sd = 1;
  Noise noise = plain;
  bool plainly = true;  // how the coefficients are fitted
  const Clusters even = unweighted(clusters);
  const bool formula = !model.base.formula.empty();
  bool safe = true;
  for (int pass = 0; pass < 3; ++pass) {
    // A formula's constants are moved by every pass: the first must start from its best fit, and
    // the last must undo what a whitening that is not safe has done to them.
    const bool refine = pass == 1 || (formula && (pass == 0 || !safe));
    fit_model(model, data, plainly ? even : clusters, plainly ? plain : noise,
              refine ? scope : FitScope::linear);
    if (pass == 2) break;
    const Eigen::VectorXd residual = target_vector(data) - predict(model, data);
    const auto fitted = static_cast<std::size_t>(model.coefficients.size());
    noise = estimate_noise(residual, clusters, fitted, campaign.noise_floor);
    plainly = false;
    if (pass == 0 || !campaign.options.has("whitening")) continue;
    noise.whitened = true;
    if (whitening_is_safe(model, data, clusters, noise)) continue;
    noise.whitened = false;
    // A model that is wrong predicts best as plain least squares has it.
    safe = whitening_is_safe(model, data, clusters, noise);
    plainly = !safe;
  }
  out.raw_tangent = tangent(model, data);
  out.raw_residual = target_vector(data) - predict(model, data);
  out.x = whitened(out.raw_tangent, clusters, noise);
  out.basis = orthonormal_basis(out.x);
  for (const Eigen::Index j : untold_columns(out.raw_tangent, model, clusters)) {
    out.raw_tangent.col(j).setZero();
    out.x.col(j).setZero();
  }
  out.residual = project_off(whitened(out.raw_residual, clusters, noise), out.basis);
  out.grams = stretch_grams(out.x, out.residual, clusters);
  out.losses = held_out_losses(out.grams, clusters, noise);
  out.model = std::move(model);
  out.noise = noise;
  return out;
}

Eigen::VectorXd losses_beside(const FittedModel& model, const Eigen::MatrixXd& columns,
                              const Campaign& campaign, double ridge) {
  const StretchGrams grams =
      with_columns(model.grams, model.x, model.residual, columns, campaign.clusters);
  return held_out_losses(grams, campaign.clusters, model.noise, ridge > 0 ? columns.cols() : 0,
                         ridge);
}

Gain lead_over(const FittedModel& present, const FittedModel& other, const Campaign& campaign) {
  const auto in_its_noise = [&](Eigen::MatrixXd columns) {
    return whitened(std::move(columns), campaign.clusters, present.noise);
  };
  const Eigen::VectorXd y =
      in_its_noise(target_vector(campaign.data) - predict(other.model, campaign.data));
  const Eigen::MatrixXd x = in_its_noise(told_tangent(other.model, campaign));
  return paired_gain(present.losses, held_out_losses(x, y, campaign.clusters, present.noise));
}

Gain gain_of(const std::vector<std::size_t>& families, const FittedModel& present,
             const Campaign& campaign) {
  LoopModel rest = present.model;
  for (const std::size_t family : families) rest = rest.without(family);
  const FittedModel other = fit_in_its_noise(std::move(rest), campaign, FitScope::linear);
  const Gain lead = lead_over(present, other, campaign);
  return {-lead.nats, lead.error, -lead.bounded_z};
}

}  // namespace tribench::loop
