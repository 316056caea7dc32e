// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/search.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "foundation/error.hpp"

namespace tribench::loop {
namespace {

// A family excited in fewer clusters cannot reach a small p by sign flips (specification, 3.3).
constexpr std::size_t kFewestClusters = 20;
// The rescue rule for families carried by few clusters (specification, 6.4).
constexpr double kFewClusters = 25;
constexpr double kRescueP = 0.15;
constexpr double kRescueGain = 12;
constexpr std::size_t kAtomsTried = 3;  // of a family, best scores first
constexpr std::size_t kMostAtoms = 2;   // of a family: more is a sign of something else
constexpr double kCancelling = 0.1;     // of the columns' own sums of squares
constexpr double kNearAliasP = 0.05;
constexpr double kExactCorrelation = 0.995;
constexpr std::array<double, 7> kUsualGearRatios = {50, 80, 100, 101, 120, 121, 160};

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

// Where correlated noise is all that is wrong, fits with and without whitening agree but for noise.
// Where they do not, the model lacks something fast (what happens at reversals, a filter's shadow),
// and to look at changes within a movement would fit that. Hausman 1978: the difference in the
// fitted values against what it can be at most by noise alone, parameter by parameter.
bool whitening_is_safe(const LoopModel& model, const Observations& data, const Clusters& clusters,
                       const Noise& noise) {
  const Eigen::MatrixXd x = tangent(model, data);
  const Eigen::VectorXd y = target_vector(data) - predict(model, data);
  if (x.cols() == 0) return true;
  const auto solution = [&](const Eigen::MatrixXd& columns, const Eigen::VectorXd& target) {
    const Eigen::VectorXd norms = columns.colwise().norm().cwiseMax(1e-300);
    const Eigen::MatrixXd scaled = columns * norms.cwiseInverse().asDiagonal();
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
    qr.setThreshold(1e-9);
    qr.compute(scaled);
    return Eigen::VectorXd(qr.solve(target).cwiseQuotient(norms));
  };
  Noise plain;
  plain.within_sd = 1;
  const Eigen::MatrixXd weighted = whitened(x, clusters, plain);
  const Eigen::VectorXd one = solution(weighted, whitened(y, clusters, plain));
  const Eigen::VectorXd other =
      solution(whitened(x, clusters, noise), whitened(y, clusters, noise));
  const double rows =
      static_cast<double>(data.rows()) / static_cast<double>(clusters.movements.size());
  const double most = noise.within_sd * noise.within_sd * noise.inflation +
                      rows * noise.between_sd * noise.between_sd;
  return (weighted * (one - other)).squaredNorm() < most * static_cast<double>(x.cols());
}

// The largest canonical correlation of two column spaces.
double canonical_correlation(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const Eigen::MatrixXd qa = orthonormal_basis(a);
  const Eigen::MatrixXd qb = orthonormal_basis(b);
  if (qa.cols() == 0 || qb.cols() == 0) return 0;
  const Eigen::MatrixXd cross = qa.transpose() * qb;
  const Eigen::MatrixXd gram = cross.transpose() * cross;
  return std::sqrt(std::min(1.0, gram.selfadjointView<Eigen::Lower>().operatorNorm()));
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
  flips_ = make_flips(options.flips, clusters.stretches.size(), random.split("flips"));
  LoopModel model;
  model.base = base;
  model.coefficients.setZero(static_cast<Eigen::Index>(base.linear_terms.size()));
  base_fit_ = fit(std::move(model), FitScope::everything);
  current_ = base_fit_;
}

void Search::instantiate_library() {
  const std::span<const double> ratios = options_.gear_ratios.empty()
                                             ? std::span<const double>(kUsualGearRatios)
                                             : std::span<const double>(options_.gear_ratios);
  std::vector<Expression> formulas;
  for (std::size_t f = 0; f < families_.size(); ++f) {
    std::vector<std::string> missing;
    for (Atom& atom : instantiate(families_[f], f, data_, ratios, missing)) {
      blocks_.push_back({formulas.size(), atom.columns.size()});
      formulas.insert(formulas.end(), atom.columns.begin(), atom.columns.end());
      library_.push_back(std::move(atom));
    }
    if (!missing.empty()) {
      untestable.push_back({families_[f].name, fmt::format("no {}", fmt::join(missing, ", no ")), 0,
                            0,
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
    const auto block = columns_.middleCols(static_cast<Eigen::Index>(blocks_[k].first),
                                           static_cast<Eigen::Index>(blocks_[k].count));
    if (!block.allFinite()) usable_[k] = 0;
  }
}

FittedModel Search::fit(LoopModel model, FitScope scope) const {
  FittedModel out;
  Noise plain;
  plain.within_sd = 1;
  Noise noise = plain;
  Noise weighing = plain;  // how the coefficients are fitted: plain least squares at first
  for (int pass = 0; pass < 3; ++pass) {
    const bool refine = pass == 1 && scope == FitScope::everything;
    fit_model(model, data_, clusters_, weighing, refine ? scope : FitScope::linear);
    if (pass == 2) break;
    const Eigen::VectorXd residual = target_vector(data_) - predict(model, data_);
    const auto fitted = static_cast<std::size_t>(model.coefficients.size());
    noise = estimate_noise(residual, clusters_, fitted, noise_floor_);
    weighing = noise;
    if (pass == 0) continue;
    noise.whitening = noise.rho;
    weighing = noise;
    if (whitening_is_safe(model, data_, clusters_, noise)) continue;
    noise.whitening = 0;
    // A model that is wrong predicts best as plain least squares has it.
    weighing = whitening_is_safe(model, data_, clusters_, noise) ? noise : plain;
  }
  out.x = whitened(tangent(model, data_), clusters_, noise);
  out.basis = orthonormal_basis(out.x);
  const Eigen::VectorXd residual =
      whitened(target_vector(data_) - predict(model, data_), clusters_, noise);
  out.residual = project_off(residual, out.basis);
  out.losses = held_out_losses(out.x, out.residual, clusters_, noise);
  out.model = std::move(model);
  out.noise = noise;
  return out;
}

Round Search::test_all(const FittedModel& state) const {
  Round round;
  round.columns = whitened(columns_, clusters_, state.noise);
  const Eigen::VectorXd before = round.columns.colwise().squaredNorm();
  const Eigen::MatrixXd projected = project_off(round.columns, state.basis);
  round.blocks.resize(library_.size());
  for (std::size_t k = 0; k < library_.size(); ++k) {
    if (usable_[k] == 0) continue;
    const auto first = static_cast<Eigen::Index>(blocks_[k].first);
    const auto count = static_cast<Eigen::Index>(blocks_[k].count);
    round.blocks[k] = score_block(projected.middleCols(first, count), before.segment(first, count),
                                  state.residual, clusters_, 0);
    if (round.blocks[k].test.carrying < kFewestClusters) round.blocks[k].test.testable = false;
  }
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

Candidate Search::best_atom(std::size_t family, const Round& round,
                            const FittedModel& state) const {
  std::vector<std::size_t> atoms;
  for (std::size_t k = 0; k < library_.size(); ++k) {
    if (library_[k].family == family && round.blocks[k].test.testable) atoms.push_back(k);
  }
  std::ranges::stable_sort(atoms, [&](std::size_t a, std::size_t b) {
    return round.blocks[a].test.score > round.blocks[b].test.score;
  });
  if (atoms.size() > kAtomsTried) atoms.resize(kAtomsTried);
  Candidate best;
  best.family = family;
  best.gain.nats = -1e300;
  for (const std::size_t k : atoms) {
    const Eigen::MatrixXd x =
        beside(state.x, round.columns.middleCols(static_cast<Eigen::Index>(blocks_[k].first),
                                                 static_cast<Eigen::Index>(blocks_[k].count)));
    Eigen::VectorXd losses = held_out_losses(x, state.residual, clusters_, state.noise);
    const Gain gain = paired_gain(state.losses, losses);
    if (gain.nats > best.gain.nats) best = {family, k, gain, std::move(losses), false};
  }
  return best;
}

// How many independent pieces of data carry an atom, as an effective number: movements where it
// differs between them rather than within them, else stretches.
double Search::carriers(const Round& round, std::size_t atom, const FittedModel& state) const {
  const Eigen::MatrixXd z =
      project_off(round.columns.middleCols(static_cast<Eigen::Index>(blocks_[atom].first),
                                           static_cast<Eigen::Index>(blocks_[atom].count)),
                  state.basis);
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

// The rescue rule. What is carried by few movements cannot reach a small p by flipping their signs,
// but it can explain their offsets: its gain counts what it leaves of their spread.
std::optional<Candidate> Search::rescue(std::size_t family, const Round& round,
                                        const FittedModel& state) const {
  std::optional<Candidate> best;
  // All atoms: with few carriers their scores tell next to nothing.
  for (std::size_t k = 0; k < library_.size(); ++k) {
    if (library_[k].family != family || !round.blocks[k].test.testable) continue;
    if (!(carriers(round, k, state) < kFewClusters)) continue;
    LoopModel model = state.model;
    model.add(library_[k]);
    const FittedModel with = fit(std::move(model), FitScope::linear);
    Noise noise = state.noise;
    noise.between_sd = with.noise.between_sd;
    const Eigen::VectorXd y =
        whitened(target_vector(data_) - predict(with.model, data_), clusters_, noise);
    const Eigen::MatrixXd x = whitened(tangent(with.model, data_), clusters_, noise);
    Eigen::VectorXd losses = held_out_losses(x, y, clusters_, noise);
    const Gain gain = paired_gain(state.losses + offset_nats(clusters_, state.noise),
                                  losses + offset_nats(clusters_, noise));
    if (!(gain.nats > kRescueGain && gain.nats > 2 * gain.error)) continue;
    if (!best || gain.nats > best->gain.nats) best = {family, k, gain, std::move(losses), true};
  }
  return best;
}

std::vector<Candidate> Search::admitted(const Round& round, const FittedModel& state,
                                        const std::vector<std::size_t>& skip) const {
  std::vector<Candidate> all;
  for (std::size_t f = 0; f < families_.size(); ++f) {
    if (std::ranges::count(skip, f) > 0 || !(round.family_score[f] > 0)) continue;
    const bool significant = round.family_p[f] <= options_.alpha_library;
    if (!significant && round.family_p[f] >= kRescueP) continue;
    if (significant) {
      all.push_back(best_atom(f, round, state));
    } else if (std::optional<Candidate> one = rescue(f, round, state)) {
      all.push_back(std::move(*one));
    }
  }
  std::ranges::stable_sort(
      all, [](const Candidate& a, const Candidate& b) { return a.gain.nats > b.gain.nats; });
  return all;
}

void Search::list_untestable(const Round& round) {
  for (std::size_t f = 0; f < families_.size(); ++f) {
    double share = 0;
    std::size_t carrying = 0;
    bool present = false;
    bool testable = false;
    for (std::size_t k = 0; k < library_.size(); ++k) {
      if (library_[k].family != f) continue;
      present = true;
      testable = testable || round.blocks[k].test.testable;
      share = std::max(share, round.blocks[k].test.share);
      carrying = std::max(carrying, round.blocks[k].test.carrying);
    }
    if (!present || testable) continue;
    const bool collinear = share * share < 1e-3;
    untestable.push_back(
        {families_[f].name,
         collinear
             ? std::string("these data show nothing of it that the base does not have already")
             : fmt::format("only {} stretches of movement carry it; {} are needed", carrying,
                           kFewestClusters),
         share, carrying, families_[f].separate_by.empty() ? "" : families_[f].separate_by[0]});
  }
}

void Search::list_coinciding(const Round& round) {
  const Eigen::MatrixXd projected = project_off(round.columns, base_fit_.basis);
  Eigen::MatrixXf unit = projected.cast<float>();
  for (Eigen::Index j = 0; j < unit.cols(); ++j) {
    const float norm = unit.col(j).norm();
    if (norm > 0) unit.col(j) /= norm;
  }
  const Eigen::MatrixXf correlations = unit.transpose() * unit;
  map_aliases(correlations, round);
  for (std::size_t a = 0; a < library_.size(); ++a) {
    for (std::size_t b = a + 1; b < library_.size(); ++b) {
      if (library_[a].family == library_[b].family || !round.blocks[a].test.testable ||
          !round.blocks[b].test.testable) {
        continue;
      }
      const auto cross = correlations.block(
          static_cast<Eigen::Index>(blocks_[a].first), static_cast<Eigen::Index>(blocks_[b].first),
          static_cast<Eigen::Index>(blocks_[a].count), static_cast<Eigen::Index>(blocks_[b].count));
      if (cross.cwiseAbs().maxCoeff() < 0.5F) continue;
      const auto block = [&](std::size_t k) {
        return projected.middleCols(static_cast<Eigen::Index>(blocks_[k].first),
                                    static_cast<Eigen::Index>(blocks_[k].count));
      };
      if (blocks_[a].count == 1 && blocks_[b].count == 1 &&
          std::abs(cross(0, 0)) < static_cast<float>(kExactCorrelation)) {
        continue;
      }
      const double r = canonical_correlation(block(a), block(b));
      if (r < kExactCorrelation) continue;
      const EffectFamily& first = families_[library_[a].family];
      const EffectFamily& second = families_[library_[b].family];
      const bool known = std::ranges::any_of(aliased, [&](const CoincidingFamilies& pair) {
        return pair.first == first.name && pair.second == second.name;
      });
      if (known) continue;
      aliased.push_back(
          {first.name, second.name, r, first.separate_by.empty() ? "" : first.separate_by[0]});
    }
  }
}

void Search::map_aliases(const Eigen::MatrixXf& correlations, const Round& round) {
  std::vector<std::size_t> place(families_.size(), families_.size());
  for (std::size_t f = 0; f < families_.size(); ++f) {
    if (!(round.family_score[f] > 0)) continue;
    place[f] = alias_map.families.size();
    alias_map.families.push_back(families_[f].name);
  }
  const auto count = static_cast<Eigen::Index>(alias_map.families.size());
  alias_map.correlation = Eigen::MatrixXd::Identity(count, count);
  for (std::size_t a = 0; a < library_.size(); ++a) {
    for (std::size_t b = 0; b < library_.size(); ++b) {
      const std::size_t i = place[library_[a].family];
      const std::size_t j = place[library_[b].family];
      if (i == j || i == families_.size() || j == families_.size()) continue;
      if (!round.blocks[a].test.testable || !round.blocks[b].test.testable) continue;
      const double r = correlations
                           .block(static_cast<Eigen::Index>(blocks_[a].first),
                                  static_cast<Eigen::Index>(blocks_[b].first),
                                  static_cast<Eigen::Index>(blocks_[a].count),
                                  static_cast<Eigen::Index>(blocks_[b].count))
                           .cwiseAbs()
                           .maxCoeff();
      double& entry =
          alias_map.correlation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      entry = std::max(entry, r);
    }
  }
}

void Search::list_candidates(const Round& round) {
  for (std::size_t f = 0; f < families_.size(); ++f) {
    if (!(round.family_score[f] > 0)) continue;
    CandidateFinding finding;
    finding.family = families_[f].name;
    finding.adjusted_p = round.family_p[f];
    finding.score = round.family_score[f];
    for (std::size_t k = 0; k < library_.size(); ++k) {
      if (library_[k].family == f && round.blocks[k].test.testable &&
          round.blocks[k].test.score == finding.score) {
        finding.atom = library_[k].label;
        break;
      }
    }
    if (finding.adjusted_p < kNearAliasP) {
      finding.gain = best_atom(f, round, base_fit_).gain.nats;
    }
    candidates.push_back(std::move(finding));
  }
  std::ranges::stable_sort(candidates,
                           [](const auto& a, const auto& b) { return a.score > b.score; });
}

std::size_t Search::atoms_of(std::size_t family) const {
  return static_cast<std::size_t>(std::ranges::count(current_.model.atoms, family, &Atom::family));
}

void Search::remove_family(LoopModel& model, std::size_t family) const {
  for (std::size_t k = model.atoms.size(); k-- > 0;) {
    if (model.atoms[k].family == family) model.remove(k);
  }
}

std::vector<AliasFinding> Search::aliases_of(const Candidate& winner, const Round& round) const {
  std::vector<AliasFinding> aliases;
  const auto columns = [&](std::size_t atom) {
    return project_off(round.columns.middleCols(static_cast<Eigen::Index>(blocks_[atom].first),
                                                static_cast<Eigen::Index>(blocks_[atom].count)),
                       current_.basis);
  };
  for (std::size_t f = 0; f < families_.size(); ++f) {
    if (f == winner.family || round.family_p[f] > (winner.rescued ? kRescueP : kNearAliasP))
      continue;
    const Candidate rival = best_atom(f, round, current_);
    const double r = canonical_correlation(columns(winner.atom), columns(rival.atom));
    const Gain lead = paired_gain(rival.losses, winner.losses);
    const bool exact = r > kExactCorrelation;
    if (!exact && lead.nats >= 2 * lead.error) continue;
    aliases.push_back({families_[f].name, r, lead.nats, lead.error, exact,
                       families_[winner.family].separate_by.empty()
                           ? ""
                           : families_[winner.family].separate_by[0]});
  }
  for (const KnownAlias& known : families_[winner.family].known_aliases) {
    aliases.push_back({known.name, 1, 0, 0, true, known.separate_by});
  }
  return aliases;
}

bool Search::add_best(const Round& round) {
  const std::vector<Candidate> all = admitted(round, current_, rejected_);
  if (all.empty()) return false;
  const Candidate& winner = all.front();
  if (!(winner.gain.nats > winner.gain.error)) return false;
  const bool again = atoms_of(winner.family) > 0;
  if (atoms_of(winner.family) >= kMostAtoms) {
    notes.push_back(fmt::format(
        "more than {} columns of '{}' are asked for: a sign of something that only looks like it",
        kMostAtoms, families_[winner.family].name));
    return false;
  }
  if (!again) {
    found.push_back({winner.family, round.family_p[winner.family], winner.gain, winner.rescued,
                     aliases_of(winner, round)});
  }
  LoopModel model = current_.model;
  model.add(library_[winner.atom]);
  FittedModel extended = fit(std::move(model), FitScope::everything);
  if (again && cancels_itself(extended.model, winner.family)) {
    notes.push_back(fmt::format("a second column of '{}' only cancels the first: left out",
                                families_[winner.family].name));
    return false;
  }
  current_ = std::move(extended);
  return true;
}

// Two columns that grew together and stand against each other say nothing but their difference.
bool Search::cancels_itself(const LoopModel& model, std::size_t family) const {
  double sum = 0;
  Eigen::VectorXd together = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(data_.rows()));
  for (std::size_t k = 0; k < model.atoms.size(); ++k) {
    const Atom& atom = model.atoms[k];
    if (atom.family != family) continue;
    const Eigen::VectorXd one =
        evaluate_columns(atom.columns, data_) *
        model.coefficients.segment(static_cast<Eigen::Index>(model.first_column(k)),
                                   static_cast<Eigen::Index>(atom.columns.size()));
    together += one;
    sum += one.squaredNorm();
  }
  return together.squaredNorm() < kCancelling * sum;
}

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

bool Search::swap_or_drop(std::size_t family) {
  LoopModel without = current_.model;
  remove_family(without, family);
  const FittedModel rest = fit(std::move(without), FitScope::linear);
  const Round round = test_all(rest);
  const auto entry = std::ranges::find(found, family, &Found::family);
  const double p = family_p_given_rest(family, rest, round, current_);
  if (p > (entry->few ? kRescueP : options_.alpha_library)) {
    notes.push_back(
        fmt::format("'{}' is not significant given the rest: removed", families_[family].name));
    found.erase(entry);
    current_ = fit(rest.model, FitScope::everything);
    return true;
  }
  std::vector<std::size_t> skip;
  for (const Found& one : found) skip.push_back(one.family);
  const std::vector<Candidate> rivals = admitted(round, rest, skip);
  if (rivals.empty()) return false;
  LoopModel swapped = rest.model;
  swapped.add(library_[rivals.front().atom]);
  FittedModel other = fit(std::move(swapped), FitScope::everything);
  // Both in the coordinates of the present noise.
  const Eigen::VectorXd y =
      whitened(target_vector(data_) - predict(other.model, data_), clusters_, current_.noise);
  const Eigen::MatrixXd x = whitened(tangent(other.model, data_), clusters_, current_.noise);
  const Gain lead = paired_gain(current_.losses, held_out_losses(x, y, clusters_, current_.noise));
  if (!(lead.nats > lead.error)) return false;
  const Candidate& rival = rivals.front();
  notes.push_back(fmt::format("'{}' replaced by '{}', which predicts better by {:.1f} nats",
                              families_[family].name, families_[rival.family].name, lead.nats));
  *entry = {rival.family, round.family_p[rival.family], rival.gain, rival.rescued,
            aliases_of(rival, round)};
  current_ = std::move(other);
  return true;
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

void Search::run() {
  const Eigen::VectorXd raw = target_vector(data_) - predict(base_fit_.model, data_);
  const double scale = target_vector(data_).norm();
  if (!(raw.norm() > 1e-9 * scale)) {
    notes.push_back("the base model leaves no residual");
    return;
  }
  Round round = test_all(base_fit_);
  list_untestable(round);
  list_coinciding(round);
  list_candidates(round);
  for (int addition = 0; addition < options_.max_additions; ++addition) {
    const std::vector<Found> before = found;
    if (!add_best(round)) break;
    const bool grew = found.size() > before.size();
    const std::size_t added = found.back().family;
    reconsider();
    const bool stayed = std::ranges::count(found, added, &Found::family) > 0;
    if (!grew || stayed) {
      rejected_.clear();
    } else {
      rejected_.push_back(added);
    }
    round = test_all(current_);
  }
  if (!found.empty()) check_exhaustively();
  test_leftover();
}

}  // namespace tribench::loop
