// SPDX-License-Identifier: MIT
//
// Would the ranking be another one, had it been made otherwise? Mean ranks over problems again
// with another error, with half of the seeds (and so of the splits), without one of the problems,
// and with less budget, each held against the ranking of the leaderboard.
//
// Budget: best training error so far (mean squared) where a share of the largest number of
// evaluations that any cell spent is used up; a method without a formula by then comes last. A
// training error is all that a trace knows, so the row of the whole budget is the one to compare
// with. Not by CPU time: the leaderboard depends on the records alone.
//
// Cost: one pass over trace.csv and a few over the records.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "reports/run_folder.hpp"
#include "reports/summary.hpp"

namespace tribench {

// Rankings of one kind, as "half of the seeds" has several.
struct RankingVariation {
  std::string what;
  std::size_t count = 0;                       // rankings
  std::map<std::string, std::size_t> leaders;  // how many each method leads
  double least_tau = kMissing;  // Kendall's tau-b with the leaderboard's mean ranks, 1: the same
};

struct Sensitivity {
  std::string operators;
  std::string leader;  // of the leaderboard
  std::vector<RankingVariation> variations;
};

// One an operator set that can be ranked: two methods and two problems at least.
std::vector<Sensitivity> ranking_sensitivity(const RunFolder& run, const RunSummary& summary);

// In words: who stays ahead, under what somebody else leads.
std::string reading_of(const Sensitivity& sensitivity);

// A section of the leaderboard; empty where nothing can be ranked.
std::string sensitivity_section(const std::vector<Sensitivity>& all);
nlohmann::ordered_json sensitivity_json(const std::vector<Sensitivity>& all);

}  // namespace tribench
