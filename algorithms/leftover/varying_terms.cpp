// SPDX-License-Identifier: MIT
#include "algorithms/leftover/varying_terms.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/campaign/rich_model.hpp"
#include "algorithms/campaign/worth.hpp"
#include "algorithms/inference/random_slopes.hpp"
#include "algorithms/inference/robust_ridge.hpp"
#include "algorithms/inference/whitening.hpp"
#include "algorithms/inference/within_movements.hpp"

namespace tribench::loop {
namespace {

// Of what is left: more than that is a doubt of all else, sure or not.
constexpr double kMuch = 0.1;

struct VaryingTerm {
  std::string name;
  Eigen::MatrixXd columns;
};

// The base's friction: of a term the name and the signal.
constexpr std::array<std::pair<const char*, const char*>, 2> kFriction = {
    {{"coulomb_friction", "sgn_v"}, {"viscous_friction", "v"}}};

std::optional<Eigen::VectorXd> column_of(const char* signal, const Campaign& campaign) {
  const Signal* found = campaign.data.find(signal);
  if (found == nullptr) return std::nullopt;
  return Eigen::Map<const Eigen::VectorXd>(found->values.data(),
                                           static_cast<Eigen::Index>(found->values.size()));
}

// Coulomb and viscous friction, and what an arm carries.
std::vector<VaryingTerm> varying_terms(const Campaign& campaign) {
  std::vector<VaryingTerm> terms;
  for (const auto& [name, signal] : kFriction) {
    if (const auto found = column_of(signal, campaign)) terms.push_back({name, *found});
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
Eigen::VectorXd unexplained(const SearchState& state, const Eigen::VectorXd& rich_residual,
                            const Campaign& campaign) {
  if (state.found.empty()) return rich_residual;
  const FittedModel& model = state.model;
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

// An offset and the terms that are no part of this family.
Eigen::MatrixXd own_terms(const std::vector<VaryingTerm>& terms, const std::string& family,
                          const Campaign& campaign) {
  Eigen::MatrixXd columns =
      Eigen::MatrixXd::Ones(static_cast<Eigen::Index>(campaign.data.rows()), 1);
  for (const VaryingTerm& term : terms) {
    if (term.name != family) columns = beside(columns, term.columns);
  }
  return columns;
}

// The effects that may stand for what varies: that is not next to nothing beside them, and they
// show neither within movements that have terms of their own nor by whole movements.
void doubt_stand_ins(SearchState& state, double varying, const std::vector<VaryingTerm>& terms,
                     const Campaign& campaign, const RandomStream& random) {
  const FittedModel& model = state.model;
  const auto white = [&](Eigen::MatrixXd columns) {
    return whitened(std::move(columns), campaign.clusters, model.noise);
  };
  const DiagnosisOptions& options = campaign.options;
  const std::vector<double> worth = worths(model.model, state.families(), campaign);
  for (std::size_t k = 0; k < worth.size(); ++k) {
    if (varying < least_worth({worth[k]}, options)) continue;
    Found& found = state.found[k];
    const Eigen::VectorXd torque = contribution(model.model, found.family, campaign.data);
    const AskedColumn asked = {white(torque),
                               white(told_tangent(model.model.without(found.family), campaign)),
                               white(model.raw_residual + torque)};
    const Eigen::MatrixXd own =
        white(own_terms(terms, campaign.families[found.family].name, campaign));
    const double within = p_within_movements(asked, own, campaign.clusters, campaign.flips);
    const double whole = p_of_movements(asked, campaign.clusters, options.flips, random);
    found.stands_in = std::min(within, whole) > options.alpha_library;
  }
}

}  // namespace

void find_varying_term(SearchState& state, LeftoverFinding& leftover,
                       const Eigen::VectorXd& rich_residual, const Campaign& campaign,
                       const RandomStream& random) {
  if (!leftover.inputs.empty() || !campaign.options.has("random_slopes")) return;
  const std::vector<VaryingTerm> terms = varying_terms(campaign);
  std::vector<Eigen::MatrixXd> columns;
  for (const VaryingTerm& term : terms) columns.push_back(term.columns);
  const std::vector<RandomSlopes> all =
      random_slopes(columns, unexplained(state, rich_residual, campaign),
                    campaign.clusters.movements, campaign.options.flips, random);
  if (all.empty()) return;
  auto told = std::ranges::max_element(all, {}, &RandomSlopes::mean_share);
  const bool is_sure = told->p <= campaign.options.alpha_leftover;
  if (!is_sure) told = std::ranges::max_element(all, {}, &RandomSlopes::share);
  if (!(told->share > 0)) return;
  const double worth = told->share / (1 - told->share);
  doubt_stand_ins(state, worth, terms, campaign, random.split("whole movements"));
  const bool is_much =
      (is_sure || told->share >= kMuch) &&
      worth >= least_worth_of_leftover(state.model.model, state.families(), campaign);
  if (!is_much && std::ranges::none_of(state.found, &Found::stands_in)) return;
  const VaryingTerm& term = terms[static_cast<std::size_t>(told - all.begin())];
  leftover.varying = finding_of(term, *told, campaign);
  if (!is_sure || !is_much) return;
  leftover.p = told->p;
  leftover.inputs = {"movement"};
}

}  // namespace tribench::loop
