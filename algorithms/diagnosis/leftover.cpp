// SPDX-License-Identifier: MIT
//
// The parts of the search that doubt its own answer: all small subsets of families, and what is
// left over that no family explains.
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
constexpr std::size_t kLargestSubset = 3;
// Of what an effect adds: what adds less in the same inputs is its shape.
constexpr double kShapeShare = 0.1;

// Every subset of 1 .. kLargestSubset of n things.
std::vector<std::vector<std::size_t>> small_subsets(std::size_t n) {
  std::vector<std::vector<std::size_t>> all;
  for (std::size_t a = 0; a < n; ++a) {
    all.push_back({a});
    for (std::size_t b = a + 1; b < n; ++b) {
      all.push_back({a, b});
      for (std::size_t c = b + 1; c < n; ++c) all.push_back({a, b, c});
    }
  }
  return all;
}

}  // namespace

// One block of columns a family: the refined atoms of those found, the best atom of the others.
void Search::check_exhaustively() {
  if (found.size() > kLargestSubset) return;
  struct FamilyBlock {
    std::size_t family;
    std::vector<Atom> atoms;
    std::vector<Eigen::Index> columns;
  };
  const Round& round = base_round_;
  std::vector<FamilyBlock> blocks;
  Eigen::MatrixXd all = whitened(tangent(base_fit_.model, data_), clusters_, current_.noise);
  const Eigen::Index base_columns = all.cols();
  for (std::size_t f = 0; f < families_.size(); ++f) {
    FamilyBlock block{f, {}, {}};
    for (const Atom& atom : current_.model.atoms) {
      if (atom.family == f) block.atoms.push_back(atom);
    }
    if (block.atoms.empty() && round.family_score[f] > 0) {
      const std::optional<Candidate> best = best_atom(f, round, base_fit_);
      if (best) block.atoms.push_back(library_[best->atom]);
    }
    if (block.atoms.empty()) continue;
    for (const Atom& atom : block.atoms) {
      const Eigen::MatrixXd z =
          whitened(evaluate_columns(atom.columns, data_), clusters_, current_.noise);
      for (Eigen::Index j = 0; j < z.cols(); ++j) block.columns.push_back(all.cols() + j);
      all = beside(all, z);
    }
    blocks.push_back(std::move(block));
  }
  const Eigen::VectorXd y =
      whitened(target_vector(data_) - predict(base_fit_.model, data_), clusters_, current_.noise);
  const SubsetLosses subset_losses(all, y, clusters_, current_.noise);
  const auto losses_of = [&](const std::vector<std::size_t>& subset) {
    std::vector<Eigen::Index> chosen;
    for (Eigen::Index j = 0; j < base_columns; ++j) chosen.push_back(j);
    for (const std::size_t b : subset) {
      chosen.insert(chosen.end(), blocks[b].columns.begin(), blocks[b].columns.end());
    }
    return subset_losses.losses(chosen);
  };
  std::vector<std::size_t> greedy;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (std::ranges::count(found, blocks[b].family, &Found::family) > 0) greedy.push_back(b);
  }
  const Eigen::VectorXd greedy_losses = losses_of(greedy);
  std::vector<std::size_t> best = greedy;
  Gain lead;
  for (const std::vector<std::size_t>& subset : small_subsets(blocks.size())) {
    // A larger set always finds a little more; only one of the same size is a rival.
    if (subset.size() > greedy.size()) continue;
    const Gain gain = paired_gain(greedy_losses, losses_of(subset));
    if (gain.nats > lead.nats && gain.nats > gain.error) {
      lead = gain;
      best = subset;
    }
  }
  if (best == greedy) return;
  LoopModel model = base_fit_.model;
  std::vector<Found> members;
  for (const std::size_t b : best) {
    for (const Atom& atom : blocks[b].atoms) model.add(atom);
    const std::size_t f = blocks[b].family;
    const auto known = std::ranges::find(found, f, &Found::family);
    members.push_back(known != found.end() ? *known : Found{f, round.family_p[f], lead, false, {}});
  }
  FittedModel other = fit(std::move(model), FitScope::everything);
  if (stands_for_another_cause(other.model)) return;
  for (const Found& member : members) {
    LoopModel without = other.model;
    remove_family(without, member.family);
    const FittedModel rest = fit(std::move(without), FitScope::linear);
    const Round rest_round = test_all(rest);
    if (family_p_given_rest(member.family, rest, rest_round, other) > options_.alpha_library) {
      return;
    }
  }
  note(fmt::format(
      "the search over all subsets predicts better by {:.1f} nats than the stepwise choice: taken",
      lead.nats));
  found = std::move(members);
  current_ = std::move(other);
}

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
                     name == "T",
                     other.asDiagonal() * evaluate_columns(formulas, data_)});
    }
  }
  return all;
}

BlockScores Search::score_modifier(const Modifier& modifier) const {
  const Eigen::MatrixXd z = whitened(modifier.columns, clusters_, current_.noise);
  BlockScores block = score_block(project_off(z, current_.basis), z.colwise().squaredNorm(),
                                  current_.residual, clusters_, 0);
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
  if (leftover_is_slight(smooth ? with_direction(smoothers[winner], data_)
                                : products[winner - smoothers.size()].columns,
                         smooth ? kSmootherRidge : 0)) {
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
  const bool varies = options_.has("varying") && drop_varying(products);
  const auto home = std::ranges::find(smoothers, leftover.signals, &Smoother::signals);
  if (home != smoothers.end() && options_.has("proxies")) drop_proxies(*home);
  if (found.size() == before) return;
  // Without its proxies the leftover shows better where it lives; what an effect varies with is
  // known already.
  const LeftoverFinding known = leftover;
  test_leftover();
  if (varies || leftover.inputs.empty()) {
    leftover.inputs = known.inputs;
    leftover.signals = known.signals;
  }
}

// An effect whose size varies with temperature is part of what is left over: c f(q) + d f(q) T is
// d f(q) (T - T0), and the origin of T is nobody's. (Nelder 1977: no main effect is to be read
// where an interaction holds it.) Where it varies with speed, load or position,
// or is ten times what is left over, it is still itself.
bool Search::drop_varying(const std::vector<Modifier>& products) {
  LoopModel model = current_.model;
  for (const Modifier& product : products) {
    if (product.signals != leftover.signals || !product.with_temperature) continue;
    std::vector<BlockScores> own = {score_modifier(product)};
    if (!own[0].test.testable) continue;
    if (adjusted_p(own[0].test.score, flip_maxima(own, flips_)) > options_.alpha_library) continue;
    LoopModel without = model;
    remove_family(without, product.family);
    if (explains_more_than_is_left(fit(without, FitScope::linear), 1 / kShapeShare)) continue;
    leftover.proxies_removed.push_back(families_[product.family].name);
    note(fmt::format("the size of '{}' varies with {}: it is part of what is left over",
                     families_[product.family].name, fmt::join(leftover.inputs, " or ")));
    std::erase_if(found, [&](const Found& one) { return one.family == product.family; });
    remove_family(model, product.family);
  }
  if (model.atoms.size() == current_.model.atoms.size()) return false;
  current_ = fit(std::move(model), FitScope::everything);
  return true;
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
bool Search::explains_more_than_is_left(const FittedModel& rest, double times) const {
  const Noise& noise = whole_->fit.noise;
  const Eigen::MatrixXd x = whitened(tangent(rest.model, data_), clusters_, noise);
  const Eigen::VectorXd y =
      whitened(target_vector(data_) - predict(rest.model, data_), clusters_, noise);
  const Gain own = paired_gain(held_out_losses(x, y, clusters_, noise), whole_->fit.losses);
  return own.nats > times * whole_->leftover_nats && own.nats > own.error;
}

}  // namespace tribench::loop
