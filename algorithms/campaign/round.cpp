// SPDX-License-Identifier: MIT
#include "algorithms/campaign/round.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "algorithms/inference/whitening.hpp"

namespace tribench::loop {
namespace {

// Down to so many clusters a family may still be rescued by its gain: below, flips do not even
// reach the p from which on that is looked at.
constexpr std::size_t kFewestToRescue = 10;

// Atoms that too few clusters carry cannot be tested. A family that has no others may be rescued.
void count_carriers(Round& round, const Campaign& campaign) {
  const std::vector<Atom>& atoms = campaign.library.atoms;
  std::vector<std::size_t> most(campaign.families.size(), 0);
  for (std::size_t k = 0; k < atoms.size(); ++k) {
    const BlockTest& test = round.blocks[k].test;
    std::size_t& count = most[atoms[k].family];
    if (test.testable) count = std::max(count, test.carrying);
  }
  round.rescue_only.assign(campaign.families.size(), 0);
  for (std::size_t f = 0; f < campaign.families.size(); ++f) {
    round.rescue_only[f] = most[f] < kFewestClusters ? 1 : 0;
  }
  // Its gain has to be one on whole movements: pieces of a few say too little of each other.
  const bool enough = campaign.clusters.movements.size() >= kFewestClusters;
  for (std::size_t k = 0; k < atoms.size(); ++k) {
    BlockTest& test = round.blocks[k].test;
    const bool rescue_only = enough && round.rescue_only[atoms[k].family] != 0;
    if (test.carrying < (rescue_only ? kFewestToRescue : kFewestClusters)) test.testable = false;
  }
}

bool few_carry(const BlockTest& test) { return test.effective_clusters < kFewClusters; }

// Tests of atoms, several of one atom among them.
struct Tests {
  std::vector<BlockScores> scores;
  std::vector<std::size_t> atoms;
};

// Every atom once more with all stretches counting alike where few carry it: the many may tell what
// the signs of those few cannot.
Tests all_tests(const Round& round, const FittedModel& model, const Campaign& campaign) {
  Tests tests{round.blocks, std::vector<std::size_t>(round.blocks.size())};
  std::iota(tests.atoms.begin(), tests.atoms.end(), std::size_t{0});
  for (std::size_t k = 0; k < round.blocks.size(); ++k) {
    const BlockTest& test = round.blocks[k].test;
    if (!test.testable || !few_carry(test)) continue;
    tests.scores.push_back(score_block_evenly(campaign.library.block_of(round.columns, k),
                                              model.basis, model.residual, campaign.clusters));
    tests.atoms.push_back(k);
  }
  return tests;
}

// What the best test of each family says, among all of them.
void score_families(Round& round, Tests tests, const Campaign& campaign) {
  round.maxima = flip_maxima(tests.scores, campaign.flips);
  round.family_p.assign(campaign.families.size(), 1);
  round.family_score.assign(campaign.families.size(), 0);
  round.family_atom.assign(campaign.families.size(), 0);
  round.counted_alike.assign(campaign.families.size(), 0);
  for (std::size_t i = 0; i < tests.atoms.size(); ++i) {
    const BlockTest& test = tests.scores[i].test;
    const std::size_t family = campaign.library.atoms[tests.atoms[i]].family;
    if (!test.testable || !(test.score > round.family_score[family])) continue;
    round.family_score[family] = test.score;
    round.family_atom[family] = tests.atoms[i];
    round.counted_alike[family] = i < round.blocks.size() ? 0 : 1;
  }
  for (std::size_t f = 0; f < campaign.families.size(); ++f) {
    if (round.family_score[f] > 0) {
      round.family_p[f] = adjusted_p(round.family_score[f], round.maxima);
    }
  }
}

}  // namespace

Round test_library(const FittedModel& model, const Campaign& campaign) {
  const Library& library = campaign.library;
  Round round;
  round.columns = whitened(library.columns, campaign.clusters, model.noise);
  round.blocks =
      score_blocks(round.columns, library.blocks, model.basis, model.residual, campaign.clusters);
  for (std::size_t k = 0; k < library.atoms.size(); ++k) {
    const Atom& atom = library.atoms[k];
    const bool lonely = atom.beside_another && model.model.atoms_of(atom.family) == 0;
    if (library.usable[k] == 0 || lonely) round.blocks[k].test.testable = false;
  }
  count_carriers(round, campaign);
  score_families(round, all_tests(round, model, campaign), campaign);
  return round;
}

bool tells_beside(const FittedModel& rest, std::size_t family, const FittedModel& with,
                  const Campaign& campaign) {
  std::vector<Expression> formulas;
  for (const Atom& atom : with.model.atoms) {
    if (atom.family != family) continue;
    formulas.insert(formulas.end(), atom.columns.begin(), atom.columns.end());
  }
  const double alpha = campaign.options.alpha_library;
  const Eigen::MatrixXd z =
      whitened(evaluate_columns(formulas, campaign.data), campaign.clusters, rest.noise);
  std::vector<BlockScores> tests;
  tests.push_back(score_block(z, rest.basis, rest.residual, campaign.clusters));
  if (!tests.front().test.testable) return false;
  if (few_carry(tests.front().test)) {
    tests.push_back(score_block_evenly(z, rest.basis, rest.residual, campaign.clusters));
  }
  // What is not told by itself is not told among the whole library, which costs a hundred times as
  // much to look at.
  double score = 0;
  for (const BlockScores& one : tests) score = std::max(score, one.test.score);
  const auto stop =
      static_cast<std::size_t>(std::ceil(alpha * static_cast<double>(campaign.flips.count() + 1)));
  if (adjusted_p(score, flip_maxima(tests, campaign.flips, score, stop)) > alpha) return false;
  return adjusted_p(score, test_library(rest, campaign).maxima) <= alpha;
}

}  // namespace tribench::loop
