// SPDX-License-Identifier: MIT
//
// What is left over that no family explains, where it lives, and which of the families found only
// stood in for it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "algorithms/diagnosis/search.hpp"
#include "algorithms/inference/feature_scores.hpp"

namespace tribench::loop {
namespace {

constexpr double kSmootherRidge = 0.02;  // of the mean diagonal (specification, 3.8)
// Of what an effect adds: what adds less in the same inputs is its shape.
constexpr double kShapeShare = 0.1;

}  // namespace

// An effect that lives in one input of a pair, times the other: what there is where the effect's
// size varies with that other input. Far sharper than a smoother in the pair.
std::vector<Search::Modifier> Search::modifiers() const {
  std::vector<Modifier> all;
  for (const Found& one : found) {
    std::set<std::string> lives_in;
    std::vector<Expression> formulas;
    for (const Atom& atom : current_.model.atoms) {
      if (atom.family != one.family) continue;
      formulas.insert(formulas.end(), atom.columns.begin(), atom.columns.end());
      for (const Expression& column : atom.columns) {
        for (const Node& node : column.nodes()) {
          if (!node.is_variable()) continue;
          const Signal& signal = data_.signals[node.variable];
          if (signal.role != Role::velocity_sign) lives_in.insert(signal.name);
        }
      }
    }
    if (lives_in.size() != 1) continue;
    for (const SignalPair& pair : smoothed_pairs()) {
      const bool first = *lives_in.begin() == pair[0];
      if (!first && *lives_in.begin() != pair[1]) continue;
      const std::string_view name = pair[first ? 1 : 0];
      const Eigen::VectorXd other = unit_signal(data_, name);
      if (other.size() == 0) continue;
      all.push_back({one.family,
                     {std::string(pair[0]), std::string(pair[1])},
                     other.asDiagonal() * evaluate_columns(formulas, data_)});
    }
  }
  return all;
}

BlockScores Search::score_modifier(const Modifier& modifier) const {
  const Eigen::MatrixXd z = whitened(modifier.columns, clusters_, current_.noise);
  BlockScores block = score_block(z, current_.basis, current_.residual, clusters_);
  if (block.test.carrying < kFewestClusters) block.test.testable = false;
  return block;
}

// The signals that the family's columns in the model are functions of, signs left out. What has a
// memory of the motion is a function of all of it: near a reversal the path since, the speed and
// the acceleration tell the same.
std::vector<std::string> Search::inputs_of(std::size_t family) const {
  std::set<std::string> names;
  for (const Atom& atom : current_.model.atoms) {
    if (atom.family != family) continue;
    for (const Expression& column : atom.columns) {
      for (const Node& node : column.nodes()) {
        if (!node.is_variable()) continue;
        const Signal& signal = data_.signals[node.variable];
        for (const char* name : {"v", "a", "d"}) {
          if (signal.has_memory() && data_.find(name) != nullptr) names.insert(name);
        }
        if (!signal.name.starts_with("sgn_")) names.insert(signal.name);
      }
    }
  }
  return {names.begin(), names.end()};
}

// What the present model predicts better than without these families.
Gain Search::gain_of(const std::vector<std::size_t>& families) const {
  LoopModel without = current_.model;
  for (const std::size_t family : families) remove_family(without, family);
  const Gain lead = lead_over_current(fit(std::move(without), FitScope::linear));
  return {-lead.nats, lead.error};
}

// The effect found before the one at `end` that has all of these inputs, the first of them; none
// where all that have them add no more than `nats` together: which of them would be at home there
// matters less than what lives there at all.
Search::Found* Search::home_of(const std::vector<std::string>& inputs, std::size_t end,
                               double nats) {
  Found* home = nullptr;
  std::vector<std::size_t> families;
  for (std::size_t k = 0; k < end; ++k) {
    if (!std::ranges::includes(inputs_of(found[k].family), inputs)) continue;
    if (home == nullptr) home = &found[k];
    families.push_back(found[k].family);
  }
  return home != nullptr && gain_of(families).nats > nats ? home : nullptr;
}

bool Search::remembers(std::size_t family) const {
  const std::vector<std::string> inputs = inputs_of(family);
  return std::ranges::any_of(
      inputs, [&](const std::string& name) { return data_.find(name)->has_memory(); });
}

// No curve of the library is the true one to the last nat. What lives in nothing but the inputs of
// a larger effect is that effect in another shape: what is left over is no UNKNOWN beside the right
// name, and where that effect remembers the motion, one that came after it and adds far less gives
// it its columns.
void Search::name_shapes() {
  const bool takes_small_ones = options_.has("shape_of_memory");
  for (std::size_t k = takes_small_ones ? found.size() : 0; k-- > 1;) {
    const std::size_t family = found[k].family;
    const std::vector<std::string> inputs = inputs_of(family);
    Found* home =
        inputs.empty() ? nullptr : home_of(inputs, k, gain_of({family}).nats / kShapeShare);
    if (home == nullptr || !remembers(home->family)) continue;
    home->another_shape = true;
    note(
        fmt::format("'{}' only shapes '{}': in the same inputs more than {:.0f} times as much is "
                    "explained without it",
                    families_[family].name, families_[home->family].name, 1 / kShapeShare));
    for (Atom& atom : current_.model.atoms) {
      if (atom.family == family) atom.family = home->family;
    }
    found.erase(found.begin() + static_cast<std::ptrdiff_t>(k));
  }
  if (leftover.inputs.empty() || !options_.has("shape_of_leftover")) return;
  std::vector<std::string> inputs = leftover.signals;
  std::ranges::sort(inputs);
  Found* home = home_of(inputs, found.size(), leftover_nats_);
  if (home == nullptr) return;
  home->another_shape = true;
  leftover.inputs.clear();
}

void Search::test_leftover() {
  if (clusters_.stretches.size() < kFewestClusters) {
    note(fmt::format(
        "{} stretches of movement are too few to tell whether anything is left over; {} "
        "are needed",
        clusters_.stretches.size(), kFewestClusters));
    return;
  }
  leftover_tested = true;
  const std::vector<Smoother> smoothers = make_smoothers(data_, random_.split("smoothers"));
  const std::vector<Modifier> products = modifiers();
  std::vector<BlockScores> blocks;
  const FeatureScorer scorer(current_.basis, current_.residual, clusters_, current_.noise,
                             direction_of(data_));
  for (const Smoother& smoother : smoothers) {
    blocks.push_back(scorer.score(smoother.features, kSmootherRidge));
  }
  for (const Modifier& modifier : products) blocks.push_back(score_modifier(modifier));
  double largest = 0;
  for (const BlockScores& block : blocks) largest = std::max(largest, block.test.score);
  // Once so many flips have exceeded it the p-value cannot come below alpha any more.
  const auto stop = static_cast<std::size_t>(
      std::ceil(options_.alpha_leftover * static_cast<double>(options_.flips + 1)));
  const std::vector<double> maxima = flip_maxima(blocks, flips_, largest, stop);
  leftover.p = adjusted_p(largest, maxima);
  if (leftover.p > options_.alpha_leftover) return;
  locate_leftover(smoothers, products, blocks, maxima);
}

// Where it lives: what predicts best; a product only if it beats every single input.
void Search::locate_leftover(const std::vector<Smoother>& smoothers,
                             const std::vector<Modifier>& products,
                             const std::vector<BlockScores>& blocks,
                             const std::vector<double>& maxima) {
  std::size_t winner = blocks.size();
  Gain best{-1e300, 0};
  Eigen::VectorXd best_losses;
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    if (adjusted_p(blocks[k].test.score, maxima) > options_.alpha_leftover) continue;
    const bool smooth = k < smoothers.size();
    const Eigen::MatrixXd features = whitened(
        smooth ? with_direction(smoothers[k], data_) : products[k - smoothers.size()].columns,
        clusters_, current_.noise);
    const Eigen::VectorXd losses =
        held_out_losses(beside(current_.x, features), current_.residual, clusters_, current_.noise,
                        features.cols(), smooth ? kSmootherRidge : 0);
    const Gain gain = paired_gain(current_.losses, losses);
    const bool product = !smooth || smoothers[k].signals.size() > 1;
    const bool clearly =
        best_losses.size() == 0 || paired_gain(best_losses, losses).nats >
                                       (product ? paired_gain(best_losses, losses).error : 0.0);
    if (gain.nats > best.nats && clearly) {
      best = gain;
      best_losses = losses;
      winner = k;
    }
  }
  if (winner == blocks.size()) return;
  const bool smooth = winner < smoothers.size();
  const Eigen::MatrixXd features = smooth ? with_direction(smoothers[winner], data_)
                                          : products[winner - smoothers.size()].columns;
  if (worth_beside(features, smooth ? kSmootherRidge : 0) < least_worth()) {
    note("what is left over is next to nothing beside the effects found");
    return;
  }
  leftover_nats_ = best.nats;
  leftover.signals = winner < smoothers.size() ? smoothers[winner].signals
                                               : products[winner - smoothers.size()].signals;
  leftover.inputs.clear();
  for (const std::string& signal : leftover.signals) {
    leftover.inputs.push_back(input_name(data_, signal));
  }
  if (!whole_) whole_ = WholeModel{current_, best.nats};
  const std::size_t before = found.size();
  const auto home = std::ranges::find(smoothers, leftover.signals, &Smoother::signals);
  if (home != smoothers.end() && options_.has("proxies")) drop_proxies(*home);
  if (found.size() == before) return;
  // Without its proxies the leftover shows better where it lives.
  const LeftoverFinding known = leftover;
  test_leftover();
  if (leftover.inputs.empty()) {
    leftover.inputs = known.inputs;
    leftover.signals = known.signals;
  }
}

// A family that the leftover's smoother makes superfluous is a proxy of what is left over, unless
// it explains more than that: the smoother in v takes the place of any effect of v, the true one
// too. What is left over is what the whole model leaves, and its proxies have to explain less
// together: each one dropped leaves more for the smoother, which would make the next one look
// superfluous. A family that asked for more columns than an effect has is not excused
// (specification, 11.6: a defect at one place is absorbed by many harmonics).
void Search::drop_proxies(const Smoother& smoother) {
  const std::size_t before = found.size();
  LoopModel model = current_.model;
  const auto drop_if_superfluous = [&](std::size_t family, bool excused) {
    LoopModel without = model;
    remove_family(without, family);
    FittedModel rest = fit(without, FitScope::linear);
    if (excused && explains_more_than_is_left(rest)) return;
    rest.basis = orthonormal_basis(
        beside(rest.x, whitened(with_direction(smoother, data_), clusters_, rest.noise)));
    rest.residual = project_off(rest.residual, rest.basis);
    const Round round = test_all(rest);
    if (family_p_given_rest(family, rest, round, current_) <= options_.alpha_library) return;
    leftover.proxies_removed.push_back(families_[family].name);
    std::erase_if(found, [&](const Found& other) { return other.family == family; });
    model = std::move(without);
  };
  for (const bool excused : {false, true}) {
    for (const Found& one : std::vector<Found>(found)) {
      const bool asked_more = std::ranges::count(asked_more_, one.family) > 0;
      if (asked_more != excused) drop_if_superfluous(one.family, excused);
    }
    if (!excused && found.size() < before) whole_->fit = fit(model, FitScope::everything);
  }
  if (found.size() < before) current_ = fit(std::move(model), FitScope::everything);
}

// What the whole model has and `rest` has not, against what the whole model leaves over.
bool Search::explains_more_than_is_left(const FittedModel& rest) const {
  const Noise& noise = whole_->fit.noise;
  const Eigen::MatrixXd x = whitened(tangent(rest.model, data_), clusters_, noise);
  const Eigen::VectorXd y =
      whitened(target_vector(data_) - predict(rest.model, data_), clusters_, noise);
  const Gain own = paired_gain(held_out_losses(x, y, clusters_, noise), whole_->fit.losses);
  return own.nats > whole_->leftover_nats && own.nats > own.error;
}

}  // namespace tribench::loop
