// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "algorithms/fitting/symmetric_system.hpp"
#include "algorithms/inference/canonical_correlation.hpp"
#include "algorithms/inference/column_products.hpp"
#include "algorithms/inference/offset_grams.hpp"
#include "algorithms/inference/whitening.hpp"

namespace tribench::loop {
namespace {

// The rescue rule for families carried by few clusters (specification, 6.4).
constexpr double kRescueGain = 12;      // nats
constexpr std::size_t kAtomsTried = 3;  // of a family, those that explain most
// A family that lags by less is one that the data cannot tell from the winner.
constexpr double kAliasErrors = 2;   // standard errors
constexpr double kCloseRival = 0.5;  // of the winner's gain, on the library's grid of shapes
// Least correlation of an alias: of two effects that have less in common, each may be there.
constexpr double kLeastLikeness = 0.5;

// How many independent pieces of data carry an atom, as an effective number: movements where it
// differs between them rather than within them, else stretches.
double carriers(const Round& round, std::size_t atom, const FittedModel& model,
                const Campaign& campaign) {
  const Eigen::MatrixXd z =
      project_off(campaign.library.block_of(round.columns, atom), model.basis);
  double all = 0;
  double squares = 0;
  double between = 0;
  for (const RowRange& m : campaign.clusters.movements) {
    const auto rows =
        z.middleRows(static_cast<Eigen::Index>(m.begin), static_cast<Eigen::Index>(m.size()));
    const double own = rows.squaredNorm();
    all += own;
    squares += own * own;
    between += rows.colwise().sum().squaredNorm() / static_cast<double>(m.size());
  }
  const bool by_movement = between > 0.5 * all;
  return by_movement ? all * all / squares : round.blocks[atom].test.effective_clusters;
}

// The losses of the model with an atom more, with the spread of the movements' offsets that it
// leaves itself: what differs between movements shows in that spread more than in the squares.
Eigen::VectorXd losses_with_own_offsets(std::size_t atom, const FilteredModel& filtered,
                                        const FittedModel& model, const Campaign& campaign) {
  const OffsetGrams grams =
      filtered.beside(campaign.library.block_of(campaign.library.columns, atom));
  Noise noise = model.noise;
  for (int pass = 0; pass < 2; ++pass) {
    noise.between_sd = grams.spread_beside(grams.coefficients_at(noise.between_sd));
  }
  return held_out_losses(grams.at(noise.between_sd), campaign.clusters, noise) +
         offset_nats(campaign.clusters, noise);
}

// The most that an atom can gain: all offsets, and what it explains of the rows it is fitted to. An
// atom that made the offsets larger would not be rescued.
double most_gain(const BlockTest& test, const FittedModel& model, double offsets) {
  const double left = std::max(0.0, model.residual.squaredNorm() - test.statistic);
  return model.losses.sum() + offsets - left / model.noise.unit();
}

// The rescue rule. What is carried by few movements cannot reach a small p by flipping their signs,
// but it can explain their offsets: how far their variance falls is a part of its gain.
class Rescue {
 public:
  Rescue(const Round& round, const FittedModel& model, const Campaign& campaign)
      : round_(round), model_(model), campaign_(campaign) {}

  std::optional<Candidate> of(std::size_t family);

  // Gives one that was not rescued a gain that can be compared with that of one that was: with the
  // offsets that it leaves the movements.
  void count_offsets(Candidate& one);

 private:
  // Not before an atom is looked at: most campaigns have none to rescue.
  const FilteredModel& filtered() {
    if (!filtered_) {
      filtered_.emplace(model_.raw_tangent, model_.raw_residual, campaign_.clusters, model_.noise);
    }
    return *filtered_;
  }

  const Round& round_;
  const FittedModel& model_;
  const Campaign& campaign_;
  std::optional<FilteredModel> filtered_;
};

std::optional<Candidate> Rescue::of(std::size_t family) {
  std::optional<Candidate> best;
  if (!campaign_.options.has("rescue")) return best;
  const bool may_be_unsteady = round_.family_p[family] < kRescueP;
  // All atoms where their flips say something: with few carriers their scores tell next to nothing.
  // Those that may gain most come first, so that most need not be looked at.
  std::vector<std::size_t> atoms;
  for (std::size_t k = 0; k < campaign_.library.atoms.size(); ++k) {
    if (campaign_.library.atoms[k].family == family && round_.blocks[k].test.testable) {
      atoms.push_back(k);
    }
  }
  std::ranges::stable_sort(atoms, std::ranges::greater(),
                           [&](std::size_t k) { return round_.blocks[k].test.statistic; });
  if (!may_be_unsteady && atoms.size() > kAtomsTried) atoms.resize(kAtomsTried);
  const Eigen::VectorXd offsets = offset_nats(campaign_.clusters, model_.noise);
  const double all_offsets = offsets.sum();
  for (const std::size_t k : atoms) {
    const double least = best ? best->gain.nats : kRescueGain;
    if (!(most_gain(round_.blocks[k].test, model_, all_offsets) > least)) break;
    if (!(carriers(round_, k, model_, campaign_) < kFewClusters)) continue;
    Eigen::VectorXd losses = losses_with_own_offsets(k, filtered(), model_, campaign_);
    const Gain gain = paired_gain(model_.losses + offsets, losses);
    if (!(gain.nats > kRescueGain)) continue;
    if (!(may_be_unsteady ? is_more_than_error(gain) : is_steady(gain))) continue;
    if (!best || gain.nats > best->gain.nats) {
      losses -= offsets;
      best = {family, k, gain, std::move(losses), true};
    }
  }
  return best;
}

void Rescue::count_offsets(Candidate& one) {
  const Eigen::VectorXd offsets = offset_nats(campaign_.clusters, model_.noise);
  Eigen::VectorXd losses = losses_with_own_offsets(one.atom, filtered(), model_, campaign_);
  if (!losses.allFinite()) return;
  one.gain = paired_gain(model_.losses + offsets, losses);
  one.losses = losses - offsets;
}

// The family's atoms that can be tested; those with a column that the model has already only where
// there are no others, for what is new in them is one of the others.
std::vector<std::size_t> testable_atoms(std::size_t family, const Round& round,
                                        const Campaign& campaign) {
  std::vector<std::size_t> atoms;
  for (std::size_t k = 0; k < campaign.library.atoms.size(); ++k) {
    if (campaign.library.atoms[k].family == family && round.blocks[k].test.testable) {
      atoms.push_back(k);
    }
  }
  const auto is_whole = [&](std::size_t k) {
    const auto columns = static_cast<std::size_t>(round.blocks[k].whitened_sums.cols());
    return columns == campaign.library.blocks[k].count;
  };
  if (std::ranges::any_of(atoms, is_whole)) {
    std::erase_if(atoms, [&](std::size_t k) { return !is_whole(k); });
  }
  return atoms;
}

}  // namespace

std::optional<Candidate> best_atom(std::size_t family, const Round& round, const FittedModel& model,
                                   const Campaign& campaign) {
  std::vector<std::size_t> atoms = testable_atoms(family, round, campaign);
  std::ranges::stable_sort(atoms, [&](std::size_t a, std::size_t b) {
    return round.blocks[a].test.statistic > round.blocks[b].test.statistic;
  });
  if (atoms.size() > kAtomsTried) atoms.resize(kAtomsTried);
  std::optional<Candidate> best;
  for (const std::size_t k : atoms) {
    Eigen::VectorXd losses =
        losses_beside(model, campaign.library.block_of(round.columns, k), campaign);
    const Gain gain = paired_gain(model.losses, losses);
    if (!std::isfinite(gain.nats)) continue;  // one fold alone excites it
    if (!best || gain.nats > best->gain.nats) {
      best = Candidate{family, k, gain, std::move(losses), false};
    }
  }
  return best;
}

std::vector<Candidate> admitted(const Round& round, const FittedModel& model,
                                const Campaign& campaign) {
  Rescue rescue(round, model, campaign);
  std::vector<Candidate> all;
  for (std::size_t f = 0; f < campaign.families.size(); ++f) {
    if (!(round.family_score[f] > 0)) continue;
    const bool significant =
        round.rescue_only[f] == 0 && round.family_p[f] <= campaign.options.alpha_library;
    // What few movements carry gains by their offsets, significant or not: a smaller p must not
    // make it harder to be admitted.
    if (std::optional<Candidate> one = rescue.of(f)) all.push_back(std::move(*one));
    if (!significant) continue;
    if (std::optional<Candidate> one = best_atom(f, round, model, campaign)) {
      all.push_back(std::move(*one));
    }
  }
  if (std::ranges::any_of(all, &Candidate::rescued)) {
    for (Candidate& one : all) {
      if (!one.rescued) rescue.count_offsets(one);
    }
  }
  std::ranges::stable_sort(
      all, [](const Candidate& a, const Candidate& b) { return a.gain.nats > b.gain.nats; });
  std::vector<char> seen(campaign.families.size(), 0);
  std::erase_if(all, [&](const Candidate& one) { return std::exchange(seen[one.family], 1) != 0; });
  return all;
}

namespace {

// Atoms whose columns are as they stand, so that some of them can be compared with others.
bool is_rigid(const Atom& atom) { return std::ranges::none_of(atom.shapes, &Shape::refined); }

using AtomSet = std::vector<std::size_t>;  // of the library

// A family's rigid atoms, one or two together, by what they explain of the target beside the rest.
class AtomSets {
 public:
  AtomSets(std::size_t family, const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
           const Round& round, const Campaign& campaign)
      : campaign_(campaign) {
    const std::vector<Atom>& atoms = campaign.library.atoms;
    std::vector<Eigen::Index> columns;
    for (std::size_t k = 0; k < atoms.size(); ++k) {
      const bool is_one = atoms[k].family == family && campaign.library.usable[k] != 0;
      if (!is_one || !is_rigid(atoms[k])) continue;
      const Block& block = campaign.library.blocks[k];
      places_.push_back(
          {k, static_cast<Eigen::Index>(columns.size()), static_cast<Eigen::Index>(block.count)});
      for (std::size_t j = 0; j < block.count; ++j) {
        columns.push_back(static_cast<Eigen::Index>(block.first + j));
      }
    }
    const Eigen::MatrixXd basis = orthonormal_basis(x);
    const Eigen::MatrixXd z = project_off(round.columns(Eigen::all, columns), basis);
    gram_ = gram_of(z);
    cross_ = cross_products(z, project_off(y, basis));
  }

  // The first few sets of `size` atoms, a first one that may stand alone and any second: those that
  // explain most more than by chance (unit: the square of the noise).
  std::vector<AtomSet> best(std::size_t size, double unit) const {
    std::vector<std::pair<double, AtomSet>> all;
    for (const Place& first : places_) {
      if (campaign_.library.atoms[first.atom].beside_another) continue;
      if (size == 1) all.push_back({surplus({first}, unit), {first.atom}});
      for (const Place& second : places_) {
        if (size != 2 || second.atom == first.atom) continue;
        all.push_back({surplus({first, second}, unit), {first.atom, second.atom}});
      }
    }
    std::ranges::stable_sort(all, [](const auto& a, const auto& b) { return a.first > b.first; });
    if (all.size() > kAtomsTried) all.resize(kAtomsTried);
    std::vector<AtomSet> sets;
    for (auto& one : all) sets.push_back(std::move(one.second));
    return sets;
  }

 private:
  struct Place {
    std::size_t atom;
    Eigen::Index first;  // column
    Eigen::Index count;
  };

  double surplus(std::initializer_list<Place> places, double unit) const {
    constexpr double kRidge = 1e-6;
    std::vector<Eigen::Index> columns;
    for (const Place& one : places) {
      for (Eigen::Index j = 0; j < one.count; ++j) columns.push_back(one.first + j);
    }
    Eigen::MatrixXd gram = gram_(columns, columns);
    gram.diagonal() *= 1 + kRidge;
    const Eigen::VectorXd cross = cross_(columns);
    return cross.dot(solve_symmetric(gram, cross)) / unit - static_cast<double>(columns.size());
  }

  const Campaign& campaign_;
  std::vector<Place> places_;
  Eigen::MatrixXd gram_;
  Eigen::VectorXd cross_;
};

}  // namespace

std::vector<std::size_t> better_atoms(std::size_t family, const Round& round,
                                      const FittedModel& model, const Campaign& campaign) {
  std::vector<std::string> own;
  for (const Atom& atom : model.model.atoms) {
    if (atom.family != family) continue;
    if (!is_rigid(atom) && !atom.beside_another) return {};
    own.push_back(atom.label);
  }
  const auto is_own = [&](std::size_t atom) {
    return std::ranges::count(own, campaign.library.atoms[atom].label) > 0;
  };
  const LoopModel rest = model.model.without(family);
  const Eigen::MatrixXd x = whitened(told_tangent(rest, campaign), campaign.clusters, model.noise);
  const Eigen::VectorXd y = whitened(target_vector(campaign.data) - predict(rest, campaign.data),
                                     campaign.clusters, model.noise);
  const StretchGrams of_rest = stretch_grams(x, y, campaign.clusters);
  const AtomSets sets(family, x, y, round, campaign);
  AtomSet best;
  Eigen::VectorXd best_losses = model.losses;
  for (std::size_t size = own.size(); size > 0; --size) {
    for (AtomSet& set : sets.best(size, model.noise.unit())) {
      if (size == own.size() && std::ranges::all_of(set, is_own)) continue;
      Eigen::MatrixXd columns(x.rows(), 0);
      for (const std::size_t atom : set) {
        columns = beside(columns, campaign.library.block_of(round.columns, atom));
      }
      Eigen::VectorXd losses = held_out_losses(
          with_columns(of_rest, x, y, columns, campaign.clusters), campaign.clusters, model.noise);
      const Gain lead = paired_gain(best_losses, losses);
      // One that says as much as two is the simpler story.
      const bool simpler = size < (best.empty() ? own.size() : best.size());
      if (!(lead.nats > (simpler ? -lead.error : lead.error))) continue;
      best = std::move(set);
      best_losses = std::move(losses);
    }
  }
  return best;
}

namespace {

// What the winner predicts better than a rival whose shapes are fitted as its own are: those of the
// library's grid fit one of two causes better by chance. Of a rival that is far behind on the grid
// as it stands there.
Gain lead_of(const Candidate& winner, const FittedModel& extended, const Candidate& rival,
             const FittedModel& model, const Campaign& campaign) {
  const Gain lead = paired_gain(rival.losses, winner.losses);
  const bool is_close = rival.gain.nats > kCloseRival * winner.gain.nats;
  if (!is_close || lead.nats < kAliasErrors * lead.error) return lead;
  LoopModel other = model.model;
  other.add(campaign.library.atoms[rival.atom]);
  const FittedModel fitted = fit_in_its_noise(std::move(other), campaign, FitScope::everything);
  return fitted.losses.allFinite() ? lead_over(fitted, extended, campaign) : lead;
}

bool is_in_library(std::size_t family, const Campaign& campaign) {
  return std::ranges::count(campaign.library.atoms, family, &Atom::family) > 0;
}

// Effects of signals that are withheld cannot be found, but they can be what was found: of one
// movement in one direction the position goes with the time, and a spring is a drift.
void add_withheld_aliases(const Candidate& winner, const Round& round, const FittedModel& model,
                          const Campaign& campaign, std::vector<AliasFinding>& aliases) {
  if (campaign.data.withheld.empty()) return;
  const Eigen::MatrixXd block = campaign.library.block_of(round.columns, winner.atom);
  const Eigen::MatrixXd beside_base = project_off(block, model.basis);
  const Eigen::VectorXd losses = losses_beside(model, block, campaign);
  Observations whole = campaign.data;
  whole.withheld.clear();
  const std::vector<double> ratios = gear_ratios_for(whole, campaign.options.gear_ratios);
  for (std::size_t f = 0; f < campaign.families.size(); ++f) {
    if (is_in_library(f, campaign)) continue;
    const EffectFamily& family = campaign.families[f];
    std::optional<AliasFinding> nearest;
    std::vector<std::string> missing;
    for (const Atom& atom : instantiate(family, f, whole, ratios, missing)) {
      Eigen::MatrixXd columns = evaluate_columns(atom.columns, whole);
      if (!columns.allFinite()) continue;
      columns = whitened(std::move(columns), campaign.clusters, model.noise);
      const double r = canonical_correlation(beside_base, project_off(columns, model.basis));
      if (!(r >= kLeastLikeness)) continue;
      const Gain lead = paired_gain(losses_beside(model, columns, campaign), losses);
      const bool exact = r > kExactCorrelation;
      if (!exact && !(lead.nats < kAliasErrors * lead.error)) continue;
      if (nearest && nearest->correlation >= r) continue;
      nearest =
          AliasFinding{family.name, r, lead.nats, lead.error, exact, family.first_experiment()};
    }
    if (nearest) aliases.push_back(*nearest);
  }
}

}  // namespace

std::vector<AliasFinding> aliases_of(const Candidate& winner, const FittedModel& extended,
                                     const Round& round, const FittedModel& model,
                                     const Campaign& campaign) {
  Rescue rescue(round, model, campaign);
  std::vector<AliasFinding> aliases;
  const EffectFamily& taken = campaign.families[winner.family];
  const auto columns = [&](std::size_t atom) {
    return project_off(campaign.library.block_of(round.columns, atom), model.basis);
  };
  const double largest_p = winner.rescued ? kRescueP : kNearAliasP;
  for (std::size_t f = 0; f < campaign.families.size(); ++f) {
    if (f == winner.family || round.family_p[f] > largest_p) continue;
    std::optional<Candidate> rival;
    if (winner.rescued) rival = rescue.of(f);
    if (!rival) {
      rival = best_atom(f, round, model, campaign);
      if (!rival) continue;
      if (winner.rescued) rescue.count_offsets(*rival);
    }
    const double r = canonical_correlation(columns(winner.atom), columns(rival->atom));
    if (!(r >= kLeastLikeness)) continue;
    const Gain lead = lead_of(winner, extended, *rival, model, campaign);
    const bool exact = r > kExactCorrelation;
    if (!exact && lead.nats >= kAliasErrors * lead.error) continue;
    aliases.push_back(
        {campaign.families[f].name, r, lead.nats, lead.error, exact, taken.first_experiment()});
  }
  add_withheld_aliases(winner, round, model, campaign, aliases);
  const std::vector<std::string>& coefficients = campaign.library.atoms[winner.atom].coefficients;
  for (const KnownAlias& known : taken.known_aliases) {
    const bool applies =
        known.coefficient.empty() || std::ranges::count(coefficients, known.coefficient) > 0;
    const bool is_told_apart = campaign.data.find(known.unless_known) != nullptr;
    if (!applies || is_told_apart) continue;
    aliases.push_back({known.name, 1, 0, 0, true, known.separate_by});
  }
  return aliases;
}

}  // namespace tribench::loop
