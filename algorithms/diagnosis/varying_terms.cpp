// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/varying_terms.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/diagnosis/rich_model.hpp"
#include "algorithms/diagnosis/worth.hpp"
#include "algorithms/inference/random_slopes.hpp"
#include "algorithms/inference/robust_ridge.hpp"

namespace tribench::loop {
namespace {

// Of what is left: more than that is a doubt of all else, sure or not.
constexpr double kMuch = 0.1;

struct VaryingTerm {
  std::string name;
  Eigen::MatrixXd columns;
};

// Coulomb and viscous friction, and what an arm carries.
std::vector<VaryingTerm> varying_terms(const Campaign& campaign) {
  std::vector<VaryingTerm> terms;
  for (const auto& [name, signal] :
       {std::pair{"coulomb_friction", "sgn_v"}, std::pair{"viscous_friction", "v"}}) {
    if (const Signal* found = campaign.data.find(signal)) {
      terms.push_back(
          {name, Eigen::Map<const Eigen::VectorXd>(
                     found->values.data(), static_cast<Eigen::Index>(found->values.size()))});
    }
  }
  const Library& library = campaign.library;
  for (std::size_t k = 0; k < library.atoms.size(); ++k) {
    const Atom& atom = library.atoms[k];
    if (!campaign.families[atom.family].changeable || library.usable[k] == 0) continue;
    terms.push_back({campaign.families[atom.family].name, library.block_of(library.columns, k)});
  }
  return terms;
}

double own_torque(const Eigen::MatrixXd& columns, const RowRange& rows,
                  const Eigen::VectorXd& slopes) {
  const auto begin = static_cast<Eigen::Index>(rows.begin);
  const auto count = static_cast<Eigen::Index>(rows.size());
  const Eigen::VectorXd part = columns.middleRows(begin, count) * slopes;
  const double rms = part.norm() / std::sqrt(static_cast<double>(count));
  return slopes.size() == 1 ? std::copysign(rms, slopes[0]) : rms;
}

// What neither the rich model nor what was found explains: that has no rare effects, and of shapes
// a few.
Eigen::VectorXd unexplained(const SearchResult& result, const Eigen::VectorXd& rich_residual,
                            const Campaign& campaign) {
  if (result.state.found.empty()) return rich_residual;
  const FittedModel& model = result.state.model;
  std::vector<Eigen::Index> rows(campaign.data.rows());
  std::iota(rows.begin(), rows.end(), Eigen::Index{0});
  return robust_ridge_residual(beside(rich_columns(campaign.data, model.model.base,
                                                   campaign.families, campaign.options.gear_ratios),
                                      model.raw_tangent),
                               model.raw_residual, rows);
}

VaryingFinding finding_of(const VaryingTerm& term, const RandomSlopes& slopes,
                          const Campaign& campaign) {
  VaryingFinding finding;
  finding.term = term.name;
  finding.share = slopes.share;
  for (std::size_t m = 0; m < campaign.clusters.movements.size(); ++m) {
    const RowRange& rows = campaign.clusters.movements[m];
    const int movement = campaign.data.movement[rows.begin];
    const Eigen::VectorXd own = slopes.slopes.row(static_cast<Eigen::Index>(m)).transpose();
    finding.movements.push_back(
        {movement, campaign.data.name_of(movement), own_torque(term.columns, rows, own)});
  }
  return finding;
}

}  // namespace

void find_varying_term(SearchResult& result, const Eigen::VectorXd& rich_residual,
                       const Campaign& campaign, RandomStream random) {
  LeftoverFinding& leftover = result.leftover;
  if (!leftover.inputs.empty() || !campaign.options.has("random_slopes")) return;
  const std::vector<VaryingTerm> terms = varying_terms(campaign);
  std::vector<Eigen::MatrixXd> columns;
  for (const VaryingTerm& term : terms) columns.push_back(term.columns);
  const std::vector<RandomSlopes> all =
      random_slopes(columns, unexplained(result, rich_residual, campaign),
                    campaign.clusters.movements, campaign.options.flips, std::move(random));
  if (all.empty()) return;
  auto told = std::ranges::max_element(all, {}, &RandomSlopes::mean_share);
  const bool is_sure = told->p <= campaign.options.alpha_leftover;
  if (!is_sure) told = std::ranges::max_element(all, {}, &RandomSlopes::share);
  if (!is_sure && told->share < kMuch) return;
  const double worth = told->share / (1 - told->share);
  const SearchState& state = result.state;
  if (worth < least_worth_of_leftover(state.model.model, state.families(), campaign)) return;
  const VaryingTerm& term = terms[static_cast<std::size_t>(told - all.begin())];
  leftover.varying = finding_of(term, *told, campaign);
  if (!is_sure) return;
  leftover.p = told->p;
  leftover.inputs = {"movement"};
}

}  // namespace tribench::loop
