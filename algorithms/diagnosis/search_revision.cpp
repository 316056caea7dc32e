// SPDX-License-Identifier: MIT
//
// What the search makes of its earlier choices once more is known: families that are not needed any
// more, columns that cancel each other, what is next to nothing.
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
  const BlockScores block = score_block(z, rest.basis, rest.residual, clusters_);
  return block.test.testable ? adjusted_p(block.test.score, round.maxima) : 1;
}

// By cross-validation, in the coordinates of the present noise.
Gain Search::lead_over_current(const FittedModel& other) const {
  const Eigen::VectorXd y =
      whitened(target_vector(data_) - predict(other.model, data_), clusters_, current_.noise);
  const Eigen::MatrixXd x = whitened(tangent(other.model, data_), clusters_, current_.noise);
  return paired_gain(current_.losses, held_out_losses(x, y, clusters_, current_.noise));
}

// What is not significant beside the rest stood in for something that has been found since.
void Search::drop_insignificant(std::size_t family) {
  LoopModel without = current_.model;
  remove_family(without, family);
  const FittedModel rest = fit(std::move(without), FitScope::linear);
  const auto entry = std::ranges::find(found, family, &Found::family);
  const double p = family_p_given_rest(family, rest, test_all(rest), current_);
  if (p <= (entry->few ? kRescueP : options_.alpha_library)) return;
  FittedModel smaller = fit(rest.model, FitScope::everything);
  if (stands_for_another_cause(smaller.model)) return;
  note(fmt::format("'{}' is not significant given the rest: removed", families_[family].name));
  found.erase(entry);
  current_ = std::move(smaller);
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

// Less than this is next to nothing beside the effects found; beside none everything counts.
double Search::least_worth() const {
  if (!options_.has("slight") || found.empty()) return 0;
  return kSlight * std::min(1.0, std::ranges::max(worths()));
}

// How much smaller the squared error is with these columns beside the model.
double Search::worth_beside(const Eigen::MatrixXd& columns, double ridge) const {
  return plain_losses(current_.model).sum() / plain_losses(current_.model, columns, ridge).sum() -
         1;
}

void Search::reconsider() {
  if (!options_.has("removal")) return;
  std::vector<std::size_t> families;
  for (const Found& one : found) families.push_back(one.family);
  for (const std::size_t family : families) {
    if (found.size() > 1) drop_insignificant(family);
  }
}

}  // namespace tribench::loop
