// SPDX-License-Identifier: MIT
//
// What the search makes of its earlier choices once more is known: families that are not needed any
// more, others in their place, other columns of the same.
#include <fmt/format.h>

#include <algorithm>

#include "algorithms/diagnosis/search.hpp"

namespace tribench::loop {

double Search::family_p_given_rest(std::size_t family, const FittedModel& rest, const Round& round,
                                   const FittedModel& with) const {
  std::vector<Expression> formulas;
  for (const Atom& atom : with.model.atoms) {
    if (atom.family != family) continue;
    formulas.insert(formulas.end(), atom.columns.begin(), atom.columns.end());
  }
  const Eigen::MatrixXd z = whitened(evaluate_columns(formulas, data_), clusters_, rest.noise);
  const Eigen::VectorXd before = z.colwise().squaredNorm();
  const BlockScores block =
      score_block(project_off(z, rest.basis), before, rest.residual, clusters_, 0);
  return block.test.testable ? adjusted_p(block.test.score, round.maxima) : 1;
}

// By cross-validation, in the coordinates of the present noise.
Gain Search::lead_over_current(const FittedModel& other) const {
  const Eigen::VectorXd y =
      whitened(target_vector(data_) - predict(other.model, data_), clusters_, current_.noise);
  const Eigen::MatrixXd x = whitened(tangent(other.model, data_), clusters_, current_.noise);
  return paired_gain(current_.losses, held_out_losses(x, y, clusters_, current_.noise));
}

// A family's columns were chosen when other effects were still missing and may have stood in for
// them (harmonics of the position for a step of the load): they are chosen anew beside the rest.
bool Search::renew(std::size_t family, const FittedModel& rest, const Round& round) {
  std::vector<std::string> known;
  for (const Atom& atom : current_.model.atoms) {
    if (atom.family == family) known.push_back(atom.label);
  }
  LoopModel model = rest.model;
  FittedModel other = rest;
  for (std::size_t k = 0; k < known.size(); ++k) {
    const Round own = k == 0 ? round : test_all(other);
    const std::optional<Candidate> best = best_atom(family, own, other);
    if (!best || !(best->gain.nats > best->gain.error)) return false;
    if (k == 0 && std::ranges::count(known, library_[best->atom].label) > 0) return false;
    model.add(library_[best_shape(best->atom, own, other)]);
    other = fit(model, FitScope::everything);
    const Gain lead = lead_over_current(other);
    if (!(lead.nats > lead.error) || stands_for_another_cause(other.model)) continue;
    note(fmt::format("'{}' predicts better by {:.1f} nats with other columns: taken",
                     families_[family].name, lead.nats));
    std::erase(asked_more_, family);
    current_ = std::move(other);
    return true;
  }
  return false;
}

bool Search::swap_or_drop(std::size_t family) {
  LoopModel without = current_.model;
  remove_family(without, family);
  const FittedModel rest = fit(std::move(without), FitScope::linear);
  const Round round = test_all(rest);
  const auto entry = std::ranges::find(found, family, &Found::family);
  const double p = family_p_given_rest(family, rest, round, current_);
  if (options_.has("removal") && p > (entry->few ? kRescueP : options_.alpha_library)) {
    FittedModel smaller = fit(rest.model, FitScope::everything);
    if (stands_for_another_cause(smaller.model)) return false;
    note(fmt::format("'{}' is not significant given the rest: removed", families_[family].name));
    found.erase(entry);
    current_ = std::move(smaller);
    return true;
  }
  if (options_.has("renewal") && renew(family, rest, round)) return true;
  if (!options_.has("swap")) return false;
  std::vector<std::size_t> skip;
  for (const Found& one : found) skip.push_back(one.family);
  const std::vector<Candidate> rivals = admitted(round, rest, skip);
  if (rivals.empty()) return false;
  LoopModel swapped = rest.model;
  swapped.add(library_[rivals.front().atom]);
  FittedModel other = fit(std::move(swapped), FitScope::everything);
  const Gain lead = lead_over_current(other);
  if (!(lead.nats > lead.error) || stands_for_another_cause(other.model)) return false;
  const Candidate& rival = rivals.front();
  note(fmt::format("'{}' replaced by '{}', which predicts better by {:.1f} nats",
                   families_[family].name, families_[rival.family].name, lead.nats));
  *entry = {rival.family, round.family_p[rival.family], rival.gain, rival.rescued,
            aliases_of(rival, round)};
  current_ = std::move(other);
  return true;
}

// The rule for a second column holds for the model as it stands: two that stood for something when
// the second came can grow together and against each other in a later fit. The better one stays,
// and its family gets no second one again.
void Search::leave_out_cancelling() {
  for (const Found& one : found) {
    const std::size_t family = one.family;
    if (atoms_of(family, current_.model) < 2 || !cancels_itself(current_.model, family)) continue;
    one_column_.push_back(family);
    LoopModel rest = current_.model;
    remove_family(rest, family);
    std::optional<FittedModel> best;
    double most = 0;
    for (const Atom& atom : current_.model.atoms) {
      if (atom.family != family) continue;
      LoopModel model = rest;
      model.add(atom);
      FittedModel other = fit(std::move(model), FitScope::everything);
      const double lead = lead_over_current(other).nats;
      if (best && !(lead > most)) continue;
      most = lead;
      best = std::move(other);
    }
    current_ = std::move(*best);
    note(fmt::format("a second column of '{}' only cancels the first: left out",
                     families_[family].name));
  }
}

// Squared errors in rows as they are, each stretch predicted from the others.
Eigen::VectorXd Search::plain_losses(const LoopModel& model, const Eigen::MatrixXd& features,
                                     double ridge) const {
  Noise plain;
  plain.within_sd = 1;
  Eigen::MatrixXd x = tangent(model, data_);
  if (features.size() > 0) x = beside(x, features);
  return held_out_losses(whitened(std::move(x), clusters_, plain),
                         whitened(target_vector(data_) - predict(model, data_), clusters_, plain),
                         clusters_, plain, ridge > 0 ? features.cols() : 0, ridge);
}

// How much larger the squared error is without each of the families found.
std::vector<double> Search::worths() const {
  const double with = plain_losses(current_.model).sum();
  std::vector<double> all;
  for (const Found& one : found) {
    LoopModel without = current_.model;
    remove_family(without, one.family);
    all.push_back(plain_losses(without).sum() / with - 1);
  }
  return all;
}

// No form of the library is the true one to the last per cent, and what a large effect's form lacks
// some small effect can mimic. However many rows say so, that is no cause; and it is where stories
// change when the recording is told again.
void Search::leave_out_slight() {
  while (options_.has("slight") && found.size() > 1) {
    const std::vector<double> worth = worths();
    const auto least = std::ranges::min_element(worth);
    if (*least >= kSlight * std::min(1.0, *std::ranges::max_element(worth))) return;
    const auto slight = found.begin() + (least - worth.begin());
    note(
        fmt::format("'{}' is worth {:.1f} % of what is left, next to nothing beside the others: "
                    "left out",
                    families_[slight->family].name, 100 * *least));
    LoopModel model = current_.model;
    remove_family(model, slight->family);
    found.erase(slight);
    current_ = fit(std::move(model), FitScope::everything);
  }
}

bool Search::leftover_is_slight(const Eigen::MatrixXd& features, double ridge) const {
  if (!options_.has("slight") || found.empty()) return false;
  const std::vector<double> worth = worths();
  const double with = plain_losses(current_.model, features, ridge).sum();
  const double own = plain_losses(current_.model).sum() / with - 1;
  return own < kSlight * std::min(1.0, *std::ranges::max_element(worth));
}

void Search::reconsider() {
  if (found.size() < 2) return;
  std::vector<std::size_t> families;
  for (const Found& one : found) families.push_back(one.family);
  for (const std::size_t family : families) {
    if (found.size() < 2) return;
    swap_or_drop(family);
  }
}

}  // namespace tribench::loop
