// SPDX-License-Identifier: MIT
#include "algorithms/leftover/local_defect.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "algorithms/inference/whitening.hpp"
#include "algorithms/loop_model/smoothers.hpp"
#include "foundation/elementary.hpp"

namespace tribench::loop {
namespace {

constexpr int kPlaces = 40;  // over the travel
constexpr int kWidths = 6;
constexpr double kNarrower = 1.5;  // each than the one before
constexpr int kBumpSteps = 16;
constexpr double kWidest = 1. / 8;  // standard deviation, of the travel: a wider one is no place

struct Bump {
  double place = 0;
  double width = 0;
};

// What is left without the families, in the present model's noise, and how a bump explains it.
class BesideTheRest {
 public:
  BesideTheRest(const FittedModel& rest, const FittedModel& present, const Campaign& campaign)
      : campaign_(campaign),
        noise_(present.noise),
        position_(campaign.data.find("q")->values),
        direction_(direction_of(campaign.data).cast<double>()),
        x_(whitened(rest.raw_tangent, campaign.clusters, noise_)),
        y_(whitened(rest.raw_residual, campaign.clusters, noise_)),
        basis_(orthonormal_basis(x_)),
        residual_(project_off(y_, basis_)) {}

  double explained(const Bump& bump) const {
    return score_statistic(columns(bump), basis_, residual_);
  }
  Eigen::VectorXd losses(const Bump& bump) const {
    return held_out_losses(beside(x_, columns(bump)), y_, campaign_.clusters, noise_);
  }
  Bump best() const;

 private:
  // As it is and times the direction of motion.
  Eigen::MatrixXd columns(const Bump& bump) const {
    Eigen::MatrixXd z(direction_.size(), 2);
    for (Eigen::Index i = 0; i < z.rows(); ++i) {
      const double x = (position_[static_cast<std::size_t>(i)] - bump.place) / bump.width;
      z(i, 0) = -x * x / 2;
    }
    elementary::exp_of_each({z.col(0).data(), position_.size()});
    z.col(1) = direction_.cwiseProduct(z.col(0));
    return whitened(std::move(z), campaign_.clusters, noise_);
  }

  const Campaign& campaign_;
  const Noise& noise_;
  std::span<const double> position_;
  Eigen::VectorXd direction_;
  Eigen::MatrixXd x_;
  Eigen::VectorXd y_;
  Eigen::MatrixXd basis_;
  Eigen::VectorXd residual_;
};

// On a grid, then by steps to either side that become shorter (Hooke and Jeeves 1961).
Bump BesideTheRest::best() const {
  const auto [low, high] = std::ranges::minmax(position_);
  Bump best;
  double most = -1;
  const auto is_better = [&](const Bump& bump) {
    const double now = explained(bump);
    if (now <= most) return false;
    most = now;
    best = bump;
    return true;
  };
  const double between = (high - low) / kPlaces;
  double width = (high - low) * kWidest;
  for (int w = 0; w < kWidths; ++w, width /= kNarrower) {
    for (int k = 0; k < kPlaces; ++k) is_better({low + between * (k + 0.5), width});
  }
  double step = between / 2;
  double factor = std::sqrt(kNarrower);
  for (int n = 0; n < kBumpSteps; ++n) {
    const Bump at = best;
    const bool moved =
        is_better({at.place - step, at.width}) || is_better({at.place + step, at.width});
    const Bump there = best;
    const bool changed = is_better({there.place, there.width / factor}) ||
                         is_better({there.place, there.width * factor});
    if (moved || changed) continue;
    step /= 2;
    factor = std::sqrt(factor);
  }
  return best;
}

}  // namespace

std::optional<double> gain_as_a_defect(const std::vector<std::size_t>& families,
                                       const FittedModel& present, const Campaign& campaign) {
  if (campaign.data.find("q") == nullptr) return std::nullopt;
  LoopModel model = present.model;
  for (const std::size_t family : families) model = model.without(family);
  const FittedModel rest = fit_in_its_noise(std::move(model), campaign, FitScope::linear);
  const BesideTheRest without(rest, present, campaign);
  const Gain lead = paired_gain(present.losses, without.losses(without.best()));
  return lead.nats > lead.error ? std::optional(lead.nats) : std::nullopt;
}

}  // namespace tribench::loop
