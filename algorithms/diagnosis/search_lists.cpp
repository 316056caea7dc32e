// SPDX-License-Identifier: MIT
//
// What the search lists beside its choice: candidates, families that cannot be tested, families
// that these data cannot tell apart.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "algorithms/fitting/symmetric_system.hpp"

#include "algorithms/diagnosis/search.hpp"

namespace tribench::loop {
namespace {

constexpr double kNearAliasP = 0.05;
constexpr double kExactCorrelation = 0.995;

// The largest canonical correlation of two column spaces.
double canonical_correlation(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const Eigen::MatrixXd qa = orthonormal_basis(a);
  const Eigen::MatrixXd qb = orthonormal_basis(b);
  if (qa.cols() == 0 || qb.cols() == 0) return 0;
  const Eigen::MatrixXd cross = qa.transpose() * qb;
  const Eigen::MatrixXd gram = cross.transpose() * cross;
  return std::sqrt(std::min(1.0, spectral_norm_symmetric(gram)));
}

}  // namespace

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
    if (!present || (testable && round.rescue_only[f] == 0)) continue;
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
      const auto block = [&](std::size_t k) { return block_of(projected, k); };
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

// The root mean square of an effect of the family that would be found nine times in ten: its shift
// of the score's root reaches the critical value, and the noise's spread beyond.
double Search::detectable(std::size_t family, const Round& round, double critical) const {
  constexpr double kNineInTen = 1.2816;  // of the normal law
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < library_.size(); ++k) {
    const BlockScores& block = round.blocks[k];
    if (library_[k].family != family || !block.test.testable) continue;
    const auto columns = static_cast<double>(block.whitened_sums.cols());
    const double spread = std::sqrt(block.whitened_sums.cast<double>().squaredNorm() / columns);
    const double needed = std::sqrt(block.gamma.statistic_of(critical)) + kNineInTen * spread;
    least = std::min(least, needed / std::sqrt(block.test.information));
  }
  return least;
}

void Search::list_candidates(const Round& round) {
  const double critical = critical_score(round.maxima, options_.alpha_library);
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
      if (const std::optional<Candidate> best = best_atom(f, round, base_fit_)) {
        finding.gain = best->gain.nats;
      }
    }
    finding.detectable = detectable(f, round, critical);
    candidates.push_back(std::move(finding));
  }
  std::ranges::stable_sort(candidates,
                           [](const auto& a, const auto& b) { return a.score > b.score; });
}

std::vector<AliasFinding> Search::aliases_of(const Candidate& winner, const Round& round) const {
  std::vector<AliasFinding> aliases;
  const auto columns = [&](std::size_t atom) {
    return project_off(block_of(round.columns, atom), current_.basis);
  };
  for (std::size_t f = 0; f < families_.size(); ++f) {
    if (f == winner.family || round.family_p[f] > (winner.rescued ? kRescueP : kNearAliasP))
      continue;
    const std::optional<Candidate> rival = best_atom(f, round, current_);
    if (!rival) continue;
    const double r = canonical_correlation(columns(winner.atom), columns(rival->atom));
    const Gain lead = paired_gain(rival->losses, winner.losses);
    const bool exact = r > kExactCorrelation;
    if (!exact && lead.nats >= 2 * lead.error) continue;
    aliases.push_back({families_[f].name, r, lead.nats, lead.error, exact,
                       families_[winner.family].separate_by.empty()
                           ? ""
                           : families_[winner.family].separate_by[0]});
  }
  const std::vector<std::string>& coefficients = library_[winner.atom].coefficients;
  for (const KnownAlias& known : families_[winner.family].known_aliases) {
    const bool applies =
        known.coefficient.empty() || std::ranges::count(coefficients, known.coefficient) > 0;
    if (!applies) continue;
    aliases.push_back({known.name, 1, 0, 0, true, known.separate_by});
  }
  return aliases;
}

}  // namespace tribench::loop
