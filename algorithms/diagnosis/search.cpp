// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "foundation/error.hpp"

namespace tribench::loop {
namespace {

// The rescue rule for families carried by few clusters (specification, 6.4).
constexpr double kFewClusters = 25;
constexpr double kRescueGain = 12;
constexpr std::size_t kAtomsTried = 3;  // of a family, best scores first
constexpr std::size_t kMostAtoms = 2;   // of a family: more is a sign of something else
constexpr double kCancelling = 0.1;     // of the columns' own sums of squares

// Torque comes in steps: no residual is more certain than its quantisation allows.
double quantisation_floor(const std::vector<double>& target) {
  std::vector<double> sorted = target;
  std::ranges::sort(sorted);
  const double span = sorted.back() - sorted.front();
  double smallest = span;
  std::size_t distinct = 1;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const double step = sorted[i] - sorted[i - 1];
    if (step <= 1e-12 * span) continue;
    smallest = std::min(smallest, step);
    ++distinct;
  }
  const double negligible = 1e-9 * span;
  if (distinct * 2 > sorted.size()) return negligible;
  return std::max(negligible, smallest / std::sqrt(12.0));
}

}  // namespace

Search::Search(const Observations& train, const BaseModel& base,
               const std::vector<EffectFamily>& families, const DiagnosisOptions& options,
               const Clusters& clusters, RandomStream random)
    : data_(train),
      families_(families),
      options_(options),
      clusters_(clusters),
      random_(random),
      noise_floor_(quantisation_floor(train.target)) {
  instantiate_library();
  flips_ = Flips(options.flips, clusters.stretches.size(), random.split("flips"));
  LoopModel model;
  model.base = base;
  model.coefficients.setZero(static_cast<Eigen::Index>(base.linear_terms.size()));
  base_fit_ = fit(std::move(model), FitScope::everything);
  current_ = base_fit_;
}

void Search::instantiate_library() {
  const std::vector<double> ratios = gear_ratios_for(data_, options_.gear_ratios);
  std::vector<Expression> formulas;
  for (std::size_t f = 0; f < families_.size(); ++f) {
    std::vector<std::string> missing;
    for (Atom& atom : instantiate(families_[f], f, data_, ratios, missing)) {
      blocks_.push_back({formulas.size(), atom.columns.size()});
      formulas.insert(formulas.end(), atom.columns.begin(), atom.columns.end());
      library_.push_back(std::move(atom));
    }
    if (!missing.empty()) {
      untestable.push_back({families_[f].name, fmt::format("{}", fmt::join(missing, ", ")), 0, 0,
                            families_[f].separate_by.empty() ? "" : families_[f].separate_by[0]});
    }
  }
  columns_ = evaluate_columns(formulas, data_);
  for (Eigen::Index j = 0; j < columns_.cols(); ++j) {
    const double rms = columns_.col(j).norm() / std::sqrt(static_cast<double>(columns_.rows()));
    if (rms > 0) columns_.col(j) /= rms;
  }
  usable_.assign(library_.size(), 1);
  for (std::size_t k = 0; k < library_.size(); ++k) {
    auto block = columns_.middleCols(static_cast<Eigen::Index>(blocks_[k].first),
                                     static_cast<Eigen::Index>(blocks_[k].count));
    if (block.allFinite()) continue;
    usable_[k] = 0;
    block.setZero();
  }
}

Round Search::test_all(const FittedModel& state) const {
  Round round;
  round.columns = whitened(columns_, clusters_, state.noise);
  round.blocks = score_blocks(round.columns, blocks_, state.basis, state.residual, clusters_);
  for (std::size_t k = 0; k < library_.size(); ++k) {
    const bool lonely =
        library_[k].beside_another && atoms_of(library_[k].family, state.model) == 0;
    if (usable_[k] == 0 || lonely) round.blocks[k].test.testable = false;
  }
  count_carriers(round);
  round.maxima = flip_maxima(round.blocks, flips_);
  round.family_p.assign(families_.size(), 1);
  round.family_score.assign(families_.size(), 0);
  for (std::size_t k = 0; k < library_.size(); ++k) {
    if (!round.blocks[k].test.testable) continue;
    double& score = round.family_score[library_[k].family];
    score = std::max(score, round.blocks[k].test.score);
  }
  for (std::size_t f = 0; f < families_.size(); ++f) {
    if (round.family_score[f] > 0) {
      round.family_p[f] = adjusted_p(round.family_score[f], round.maxima);
    }
  }
  return round;
}

namespace {

bool reads_velocity_alone(const Expression& formula, const Observations& data) {
  return std::ranges::all_of(formula.nodes(), [&](const Node& node) {
    if (!node.is_variable()) return true;
    const std::string& name = data.signals[node.variable].name;
    return name == "v" || name == "sgn_v";
  });
}

}  // namespace

// Whether there is less friction somewhere than at the slowest row, in one direction: by the base
// and this family, as far as they read the velocity alone.
bool Search::falls_with_speed(const LoopModel& model, std::size_t family) const {
  std::vector<Expression> terms;
  std::vector<double> coefficients;
  const auto take = [&](const Expression& term, std::size_t column) {
    if (!reads_velocity_alone(term, data_)) return;
    terms.push_back(term);
    coefficients.push_back(model.coefficients[static_cast<Eigen::Index>(column)]);
  };
  for (std::size_t k = 0; k < model.base.linear_terms.size(); ++k) {
    take(model.base.linear_terms[k], k);
  }
  for (std::size_t k = 0; k < model.atoms.size(); ++k) {
    if (model.atoms[k].family != family) continue;
    for (std::size_t j = 0; j < model.atoms[k].columns.size(); ++j) {
      take(model.atoms[k].columns[j], model.first_column(k) + j);
    }
  }
  const Eigen::VectorXd friction =
      evaluate_columns(terms, data_) *
      Eigen::Map<const Eigen::VectorXd>(coefficients.data(),
                                        static_cast<Eigen::Index>(coefficients.size()));
  const std::vector<double>& v = data_.find("v")->values;
  for (const double direction : {1.0, -1.0}) {
    double slowest = std::numeric_limits<double>::infinity();
    double there = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < v.size(); ++i) {
      if (!(direction * v[i] > 0)) continue;
      const double against = direction * friction[static_cast<Eigen::Index>(i)];
      least = std::min(least, against);
      if (std::abs(v[i]) < slowest) {
        slowest = std::abs(v[i]);
        there = against;
      }
    }
    if (least < there) return true;
  }
  return false;
}

// Whether the one column of a family has the sign that its cause cannot have.
bool Search::has_impossible_sign(const LoopModel& model) const {
  for (std::size_t k = 0; k < model.atoms.size(); ++k) {
    const Atom& atom = model.atoms[k];
    if (atoms_of(atom.family, model) > 1) continue;
    for (const Sanity& sanity : families_[atom.family].sanity) {
      const auto at = std::ranges::find(atom.coefficients, sanity.coefficient);
      if (at == atom.coefficients.end()) continue;
      const auto column =
          model.first_column(k) + static_cast<std::size_t>(at - atom.coefficients.begin());
      if (sanity.sign * model.coefficients[static_cast<Eigen::Index>(column)] < 0) return true;
    }
  }
  return false;
}

// Curves of speed that two families can draw are told apart by whether friction falls. A base that
// is a formula has its own curve, which nobody knows.
bool Search::stands_for_another_cause(const LoopModel& model) const {
  if (!options_.physical_vetoes) return false;
  if (has_impossible_sign(model)) return true;
  if (!model.base.formula.empty()) return false;
  return std::ranges::any_of(model.atoms, [&](const Atom& atom) {
    return atom.curve != SpeedCurve::any &&
           falls_with_speed(model, atom.family) != (atom.curve == SpeedCurve::falls);
  });
}

// Atoms that too few clusters carry cannot be tested. A family that has no others may be rescued.
void Search::count_carriers(Round& round) const {
  std::vector<std::size_t> most(families_.size(), 0);
  for (std::size_t k = 0; k < library_.size(); ++k) {
    const BlockTest& test = round.blocks[k].test;
    std::size_t& count = most[library_[k].family];
    if (test.testable) count = std::max(count, test.carrying);
  }
  round.rescue_only.assign(families_.size(), 0);
  for (std::size_t f = 0; f < families_.size(); ++f) {
    round.rescue_only[f] = most[f] < kFewestClusters ? 1 : 0;
  }
  // Its gain has to be one on whole movements: pieces of a few say too little of each other.
  const bool enough = clusters_.movements.size() >= kFewestClusters;
  for (std::size_t k = 0; k < library_.size(); ++k) {
    BlockTest& test = round.blocks[k].test;
    const bool rescue_only = enough && round.rescue_only[library_[k].family] != 0;
    if (test.carrying < (rescue_only ? kFewestToRescue : kFewestClusters)) test.testable = false;
  }
}

std::optional<Candidate> Search::best_atom(std::size_t family, const Round& round,
                                           const FittedModel& state) const {
  std::vector<std::size_t> atoms;
  for (std::size_t k = 0; k < library_.size(); ++k) {
    if (library_[k].family == family && round.blocks[k].test.testable) atoms.push_back(k);
  }
  std::ranges::stable_sort(atoms, [&](std::size_t a, std::size_t b) {
    return round.blocks[a].test.score > round.blocks[b].test.score;
  });
  if (atoms.size() > kAtomsTried) atoms.resize(kAtomsTried);
  std::optional<Candidate> best;
  for (const std::size_t k : atoms) {
    const Eigen::MatrixXd x = beside(state.x, block_of(round.columns, k));
    Eigen::VectorXd losses = held_out_losses(x, state.residual, clusters_, state.noise);
    const Gain gain = paired_gain(state.losses, losses);
    if (!std::isfinite(gain.nats)) continue;  // one fold alone excites it
    if (!best || gain.nats > best->gain.nats) {
      best = Candidate{family, k, gain, std::move(losses), false};
    }
  }
  return best;
}

// How many independent pieces of data carry an atom, as an effective number: movements where it
// differs between them rather than within them, else stretches.
double Search::carriers(const Round& round, std::size_t atom, const FittedModel& state) const {
  const Eigen::MatrixXd z = project_off(block_of(round.columns, atom), state.basis);
  double all = 0;
  double squares = 0;
  double between = 0;
  for (const RowRange& m : clusters_.movements) {
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
Eigen::VectorXd Search::losses_with_own_offsets(std::size_t atom, const FittedModel& state) const {
  const Eigen::MatrixXd x = beside(state.raw_tangent, columns_of(atom));
  const auto fitted =
      static_cast<std::size_t>(state.model.coefficients.size()) + blocks_[atom].count;
  Noise noise = state.noise;
  for (int pass = 0; pass < 2; ++pass) {
    const Eigen::VectorXd solution = least_squares(whitened(x, clusters_, noise),
                                                   whitened(state.raw_residual, clusters_, noise));
    const Eigen::VectorXd residual = state.raw_residual - x * solution;
    noise.between_sd = estimate_noise(residual, clusters_, fitted, noise_floor_).between_sd;
  }
  return held_out_losses(whitened(x, clusters_, noise),
                         whitened(state.raw_residual, clusters_, noise), clusters_, noise) +
         offset_nats(clusters_, noise);
}

// The rescue rule. What is carried by few movements cannot reach a small p by flipping their signs,
// but it can explain their offsets: its gain counts what it leaves of their spread.
std::optional<Candidate> Search::rescue(std::size_t family, const Round& round,
                                        const FittedModel& state) const {
  std::optional<Candidate> best;
  if (!options_.has("rescue")) return best;
  // All atoms: with few carriers their scores tell next to nothing.
  for (std::size_t k = 0; k < library_.size(); ++k) {
    if (library_[k].family != family || !round.blocks[k].test.testable) continue;
    if (!(carriers(round, k, state) < kFewClusters)) continue;
    Eigen::VectorXd losses = losses_with_own_offsets(k, state);
    const Gain gain = paired_gain(state.losses + offset_nats(clusters_, state.noise), losses);
    if (!(gain.nats > kRescueGain && gain.nats > 2 * gain.error)) continue;
    if (!best || gain.nats > best->gain.nats) {
      losses -= offset_nats(clusters_, state.noise);
      best = {family, k, gain, std::move(losses), true};
    }
  }
  return best;
}

// As the data have it: in a model's own coordinates a spread of offsets that the atom's absence has
// swollen would hide it.
bool Search::differs_between_movements(std::size_t atom, const FittedModel& state) const {
  const Eigen::MatrixXd z =
      project_off(block_of(columns_, atom), orthonormal_basis(tangent(state.model, data_)));
  double between = 0;
  for (const RowRange& m : clusters_.movements) {
    between += z.middleRows(static_cast<Eigen::Index>(m.begin), static_cast<Eigen::Index>(m.size()))
                   .colwise()
                   .sum()
                   .squaredNorm() /
               static_cast<double>(m.size());
  }
  return between > 0.5 * z.squaredNorm();
}

// A missing effect that differs between movements swells the spread of their offsets, in which its
// atoms look alike. The best of them is the one that leaves the least of that spread.
std::size_t Search::best_shape(std::size_t atom, const Round& round,
                               const FittedModel& state) const {
  if (!options_.has("best_shape") || !differs_between_movements(atom, state)) return atom;
  std::size_t best = atom;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < library_.size(); ++k) {
    if (library_[k].family != library_[atom].family || !round.blocks[k].test.testable) continue;
    const double loss = losses_with_own_offsets(k, state).sum();
    if (loss < least) {
      least = loss;
      best = k;
    }
  }
  return best;
}

std::vector<Candidate> Search::admitted(const Round& round) const {
  std::vector<Candidate> all;
  for (std::size_t f = 0; f < families_.size(); ++f) {
    if (std::ranges::count(rejected_, f) > 0 || !(round.family_score[f] > 0)) continue;
    const bool significant =
        round.rescue_only[f] == 0 && round.family_p[f] <= options_.alpha_library;
    if (!significant && round.family_p[f] >= kRescueP) continue;
    std::optional<Candidate> one = rescue(f, round, current_);
    if (significant) {
      // What few movements carry gains by their offsets, significant or not: a smaller p must not
      // make it harder to be admitted.
      std::optional<Candidate> plain = best_atom(f, round, current_);
      if (!one || (plain && plain->gain.nats >= one->gain.nats)) one = std::move(plain);
    }
    if (one) all.push_back(std::move(*one));
  }
  std::ranges::stable_sort(
      all, [](const Candidate& a, const Candidate& b) { return a.gain.nats > b.gain.nats; });
  return all;
}

std::size_t Search::atoms_of(std::size_t family, const LoopModel& model) {
  return static_cast<std::size_t>(std::ranges::count(model.atoms, family, &Atom::family));
}

void Search::remove_family(LoopModel& model, std::size_t family) const {
  for (std::size_t k = model.atoms.size(); k-- > 0;) {
    if (model.atoms[k].family == family) model.remove(k);
  }
}

bool Search::add_best(const Round& round) {
  const double least = least_worth();
  for (const Candidate& winner : admitted(round)) {
    if (!(winner.gain.nats > winner.gain.error)) return false;
    // At the grid's shapes it is worth less than it will be.
    if (worth_beside(columns_of(winner.atom)) < least / 2) continue;
    if (add(winner, round)) return true;
  }
  return false;
}

void Search::note(std::string text) {
  if (std::ranges::count(notes, text) == 0) notes.push_back(std::move(text));
}

// False where the family has had its share already: the next best may still be needed.
bool Search::add(const Candidate& winner, const Round& round) {
  const std::size_t known = atoms_of(winner.family, current_.model);
  const bool again = known > 0;
  if (known >= kMostAtoms && options_.has("most_columns")) {
    asked_more_.push_back(winner.family);
    note(fmt::format(
        "more than {} columns of '{}' are asked for: a sign of something that only looks like it",
        kMostAtoms, families_[winner.family].name));
    return false;
  }
  if (std::ranges::count(one_column_, winner.family) > 0 && again) return false;
  LoopModel model = current_.model;
  model.add(library_[best_shape(winner.atom, round, current_)]);
  FittedModel extended = fit(std::move(model), FitScope::everything);
  if (again && cancels_itself(extended.model, winner.family)) {
    note(fmt::format("a second column of '{}' only cancels the first: left out",
                     families_[winner.family].name));
    return false;
  }
  // One fold alone can tell of it: that it holds elsewhere too is beyond these data.
  if (!extended.losses.allFinite() || stands_for_another_cause(extended.model)) return false;
  if (!again) {
    found.push_back({winner.family, round.family_p[winner.family], winner.gain, winner.rescued,
                     aliases_of(winner, round)});
  }
  current_ = std::move(extended);
  return true;
}

// Two columns that grew together and stand against each other say nothing but their difference.
// What an effect has besides (a drift of its phase) is meant to take some of it away.
bool Search::cancels_itself(const LoopModel& model, std::size_t family) const {
  if (!options_.has("cancelling")) return false;
  double sum = 0;
  Eigen::VectorXd together = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(data_.rows()));
  for (std::size_t k = 0; k < model.atoms.size(); ++k) {
    const Atom& atom = model.atoms[k];
    if (atom.family != family || atom.beside_another) continue;
    const Eigen::VectorXd one =
        evaluate_columns(atom.columns, data_) *
        model.coefficients.segment(static_cast<Eigen::Index>(model.first_column(k)),
                                   static_cast<Eigen::Index>(atom.columns.size()));
    together += one;
    sum += one.squaredNorm();
  }
  return sum > 0 && together.squaredNorm() < kCancelling * sum;
}

void Search::run() {
  const Eigen::VectorXd raw = target_vector(data_) - predict(base_fit_.model, data_);
  const double scale = target_vector(data_).norm();
  if (!(raw.norm() > 1e-9 * scale)) {
    note("the base model leaves no residual");
    leftover_tested = true;
    return;
  }
  Round round = test_all(base_fit_);
  list_untestable(round);
  list_coinciding(round);
  list_candidates(round);
  // A second column of a family refines it and is no addition.
  for (std::size_t turn = 0; turn < 3 * options_.max_effects; ++turn) {
    if (found.size() >= options_.max_effects) break;
    if (!add_best(round)) break;
    const std::vector<Found> before = found;
    reconsider();
    leave_out_cancelling();
    // What did not stand beside the rest is not tried again: the search goes on or ends.
    for (const Found& one : before) {
      if (std::ranges::count(found, one.family, &Found::family) == 0) {
        rejected_.push_back(one.family);
      }
    }
    round = test_all(current_);
  }
  leave_out_cancelling();
  leave_out_slight();
  test_leftover();
  leave_out_cancelling();  // the fit without proxies is another
  name_shapes();
  // As they stand beside each other, whatever way the search has come.
  for (Found& one : found) one.gain = gain_of({one.family});
  // What its gain has rescued was testable after all.
  for (const Found& one : found) {
    std::erase_if(untestable, [&](const UntestableFinding& finding) {
      return finding.family == families_[one.family].name;
    });
  }
}

}  // namespace tribench::loop
