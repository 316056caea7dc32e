// SPDX-License-Identifier: MIT
#include "algorithms/exploration/forecasts.hpp"

#include <algorithm>

#include "foundation/elementary.hpp"

namespace tribench::loop {
namespace {

constexpr double kAwake = -18.4;      // ln of the least weight, 1e-8
constexpr double kLeastShare = 1e-9;  // of all, that is told from nothing

std::vector<std::size_t> sorted_families(const Explanation& one) {
  std::vector<std::size_t> key = one.families;
  std::ranges::sort(key);
  return key;
}

}  // namespace

// Weights and priors have the same sum.
void Forecasts::hear(const std::vector<Explanation>& all) {
  const bool opening = forecasters_.empty();
  std::vector<double> priors;
  std::vector<double> weights;
  for (const Explanation& one : all) {
    const double log_weight = one.log_prior + (opening ? one.log_evidence : 0);
    forecasters_.try_emplace(sorted_families(one),
                             Forecaster{one.verdict, one.log_prior, log_weight});
    priors.push_back(one.log_prior);
    weights.push_back(log_weight);
  }
  if (!opening) return;
  const double shift = log_sum(priors) - log_sum(weights);
  for (auto& [families, one] : forecasters_) one.log_weight += shift;
}

void Forecasts::add(const std::vector<Explanation>& all, const EvidenceTable& before,
                    const EvidenceTable& after) {
  std::vector<Forecaster*> awake;
  std::vector<double> said;
  std::vector<double> weights;
  for (const Explanation& one : all) {
    Forecaster& own = forecasters_.at(sorted_families(one));
    if (own.log_weight < kAwake) continue;
    awake.push_back(&own);
    said.push_back(after.log_factor(one.blocks) - before.log_factor(one.blocks));
    weights.push_back(own.log_weight);
  }
  std::vector<double> came = weights;
  for (std::size_t k = 0; k < awake.size(); ++k) came[k] += said[k];
  const double mixture = log_sum(came) - log_sum(weights);
  for (std::size_t k = 0; k < awake.size(); ++k) awake[k]->log_weight += said[k] - mixture;
}

std::vector<ForecastVerdict> Forecasts::verdicts() const {
  struct Share {
    double prior = 0;
    double weight = 0;
  };
  std::map<std::string, Share> shares;
  Share all;
  for (const auto& [families, one] : forecasters_) {
    for (Share* share : {&shares[one.verdict], &all}) {
      share->prior += elementary::exp(one.log_prior);
      share->weight += elementary::exp(one.log_weight);
    }
  }
  const auto log_odds = [](double part, double whole) {
    return elementary::log(part / std::max(whole - part, kLeastShare * whole));
  };
  std::vector<ForecastVerdict> out;
  for (const auto& [verdict, share] : shares) {
    out.push_back({verdict, share.weight / all.weight,
                   log_odds(share.weight, all.weight) - log_odds(share.prior, all.prior)});
  }
  std::ranges::stable_sort(out, [](const auto& a, const auto& b) { return a.weight > b.weight; });
  return out;
}

}  // namespace tribench::loop
