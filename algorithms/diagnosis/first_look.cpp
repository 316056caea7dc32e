// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/first_look.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "algorithms/diagnosis/candidates.hpp"
#include "algorithms/inference/canonical_correlation.hpp"
#include "algorithms/inference/column_products.hpp"

namespace tribench::loop {
namespace {

// Two blocks of several columns whose columns correlate by less have no direction in common.
constexpr double kWorthALook = 0.5;
constexpr double kNineInTen = 1.2816;  // quantile of the normal law

std::vector<UntestableFinding> untestable_families(const Round& round, const Campaign& campaign) {
  std::vector<UntestableFinding> all = campaign.library.missing;
  const std::vector<Atom>& atoms = campaign.library.atoms;
  for (std::size_t f = 0; f < campaign.families.size(); ++f) {
    double share = 0;
    std::size_t carrying = 0;
    bool present = false;
    bool testable = false;
    for (std::size_t k = 0; k < atoms.size(); ++k) {
      if (atoms[k].family != f) continue;
      present = true;
      testable = testable || round.blocks[k].test.testable;
      share = std::max(share, round.blocks[k].test.share);
      carrying = std::max(carrying, round.blocks[k].test.carrying);
    }
    if (!present || (testable && round.rescue_only[f] == 0)) continue;
    const bool collinear = share * share < 1e-3;
    all.push_back(
        {campaign.families[f].name,
         collinear
             ? std::string("these data show nothing of it that the base does not have already")
             : fmt::format("only {} stretches of movement carry it; {} are needed", carrying,
                           kFewestClusters),
         share, carrying, campaign.families[f].first_experiment()});
  }
  return all;
}

// How alike the library's columns are, beside the base.
class Likeness {
 public:
  Likeness(const Round& round, const FittedModel& base, const Campaign& campaign)
      : round_(round), campaign_(campaign), columns_(project_off(round.columns, base.basis)) {
    correlations_ = gram_of(columns_);
    const Eigen::VectorXd norms = correlations_.diagonal().cwiseSqrt();
    const Eigen::VectorXd unit = (norms.array() > 0).select(norms.cwiseInverse(), 0);
    correlations_ = unit.asDiagonal() * correlations_ * unit.asDiagonal();
  }

  // The largest of any two columns of two atoms; 0 where one of them cannot be tested.
  double correlation(std::size_t a, std::size_t b) const {
    if (!round_.blocks[a].test.testable || !round_.blocks[b].test.testable) return 0;
    const std::vector<Block>& blocks = campaign_.library.blocks;
    return correlations_
        .block(
            static_cast<Eigen::Index>(blocks[a].first), static_cast<Eigen::Index>(blocks[b].first),
            static_cast<Eigen::Index>(blocks[a].count), static_cast<Eigen::Index>(blocks[b].count))
        .cwiseAbs()
        .maxCoeff();
  }

  // The canonical correlation where it may reach what cannot be told apart, else 0.
  double canonical(std::size_t a, std::size_t b, double correlation) const {
    const std::vector<Block>& blocks = campaign_.library.blocks;
    const bool single = blocks[a].count == 1 && blocks[b].count == 1;
    if (correlation < (single ? kExactCorrelation : kWorthALook)) return 0;
    return canonical_correlation(campaign_.library.block_of(columns_, a),
                                 campaign_.library.block_of(columns_, b));
  }

 private:
  const Round& round_;
  const Campaign& campaign_;
  Eigen::MatrixXd columns_;
  Eigen::MatrixXd correlations_;
};

// Family by family: how alike they are, and which cannot be told apart.
void compare_families(FirstLook& look, const Round& round, const FittedModel& base,
                      const Campaign& campaign) {
  const Likeness likeness(round, base, campaign);
  const std::vector<Atom>& atoms = campaign.library.atoms;
  std::vector<std::size_t> tested;
  for (std::size_t f = 0; f < campaign.families.size(); ++f) {
    if (!(round.family_score[f] > 0)) continue;
    tested.push_back(f);
    look.alias_map.families.push_back(campaign.families[f].name);
  }
  const auto count = static_cast<Eigen::Index>(tested.size());
  look.alias_map.correlation = Eigen::MatrixXd::Identity(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = i + 1; j < count; ++j) {
      const std::size_t f = tested[static_cast<std::size_t>(i)];
      const std::size_t g = tested[static_cast<std::size_t>(j)];
      double most = 0;
      double same = 0;
      for (std::size_t a = 0; a < atoms.size(); ++a) {
        for (std::size_t b = 0; atoms[a].family == f && b < atoms.size(); ++b) {
          if (atoms[b].family != g) continue;
          const double r = likeness.correlation(a, b);
          most = std::max(most, r);
          if (same < kExactCorrelation) same = likeness.canonical(a, b, r);
        }
      }
      look.alias_map.correlation(i, j) = look.alias_map.correlation(j, i) = most;
      if (same < kExactCorrelation) continue;
      look.coinciding.push_back({campaign.families[f].name, campaign.families[g].name, same,
                                 campaign.families[f].first_experiment()});
    }
  }
}

// A late velocity differs from the velocity where that changes.
bool shows_in_turns(std::size_t family, const Campaign& campaign) {
  LoopModel alone;
  for (const Atom& atom : campaign.library.atoms) {
    if (atom.family == family) alone.add(atom);
  }
  return std::ranges::any_of(signals_read(alone, family, campaign.data),
                             [](const Signal* signal) { return signal->is_late(); });
}

// How far an effect has to shift the score's root to be found nine times in ten: to the critical
// value and the noise's spread beyond. Flips move the effect's own sums, too: the fewer clusters
// hold it, the more it raises the critical value itself. Infinity where it outruns the shift.
double needed_shift(const BlockScores& block, double critical) {
  const auto columns = static_cast<double>(block.whitened_sums.cols());
  const double squares = block.whitened_sums.cast<double>().squaredNorm();
  const double beyond = kNineInTen * std::sqrt(squares / columns);
  const double statistic = block.gamma.statistic_of(critical);
  const double raised = squares > 0 ? statistic / (squares * block.test.effective_clusters) : 0;
  if (raised >= 1) return std::numeric_limits<double>::infinity();
  // (shift - beyond)^2 = statistic + raised shift^2
  const double rest = beyond * beyond - (1 - raised) * (beyond * beyond - statistic);
  return (beyond + std::sqrt(rest)) / (1 - raised);
}

// The root mean square from which on an effect of the family would be found nine times in ten, were
// it of half of the curves that the library has for it: of the one that shows best it would be
// less.
double detectable(std::size_t family, const Round& round, double critical,
                  const Campaign& campaign) {
  std::vector<double> sizes;
  for (std::size_t k = 0; k < campaign.library.atoms.size(); ++k) {
    const BlockScores& block = round.blocks[k];
    if (campaign.library.atoms[k].family != family || !block.test.testable) continue;
    sizes.push_back(needed_shift(block, critical) / std::sqrt(block.test.information));
  }
  if (sizes.empty()) return std::numeric_limits<double>::infinity();
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::ranges::nth_element(sizes, middle);  // no mean of two, of which one may be infinite
  return *middle;
}

std::vector<CandidateFinding> candidate_findings(const Round& round, const FittedModel& base,
                                                 const Campaign& campaign) {
  const double critical = critical_score(round.maxima, campaign.options.alpha_library);
  std::vector<CandidateFinding> all;
  for (std::size_t f = 0; f < campaign.families.size(); ++f) {
    if (!(round.family_score[f] > 0)) continue;
    CandidateFinding finding;
    finding.family = campaign.families[f].name;
    finding.adjusted_p = round.family_p[f];
    finding.score = round.family_score[f];
    finding.atom = campaign.library.atoms[round.family_atom[f]].label;
    if (finding.adjusted_p < kNearAliasP) {
      const std::optional<Candidate> best = best_atom(f, round, base, campaign);
      if (best) {
        finding.gain = best->gain.nats;
        const bool is_seen = best->gain.nats > best->gain.error;
        if (is_seen) finding.gain_share = best->gain.nats / base.losses.sum();
      }
    }
    if (!campaign.data.turns_left_out || !shows_in_turns(f, campaign)) {
      finding.detectable = detectable(f, round, critical, campaign);
    }
    all.push_back(std::move(finding));
  }
  std::ranges::stable_sort(all, [](const auto& a, const auto& b) { return a.score > b.score; });
  return all;
}

}  // namespace

FirstLook first_look(const Round& round, const FittedModel& base, const Campaign& campaign) {
  FirstLook look;
  look.untestable = untestable_families(round, campaign);
  if (campaign.options.compares_families) compare_families(look, round, base, campaign);
  look.candidates = candidate_findings(round, base, campaign);
  return look;
}

}  // namespace tribench::loop
