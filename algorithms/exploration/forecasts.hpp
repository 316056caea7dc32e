// SPDX-License-Identifier: MIT
//
// What each explanation said of the next movements before they were made, held against what came.
//
// Before a movement is executed every explanation has a predictive density of it, from the rows,
// the noise and the choice of its block by then. The weight of an explanation is its share of the
// prior times the Bayes factor of the opening times the product of these densities: what is judged
// by rows was not fitted to them, so that no number of looks, no choice of movements and no
// refitting makes a wrong explanation look good. The e-value of a verdict is what its explanations
// said of all rows over what the mixture of all others said. Were one of the others true as the
// prior has them, it would be a test martingale: above 1/alpha at any time with a probability of
// alpha at most.
//
// Explanations come and go as the search finds them. One that was not there yet, or whose weight is
// next to nothing, is asleep: it is taken to have said what the mixture said.
//
// Source: Dawid 1984 (prequential principle); Grunwald, de Heide and Koolen 2024 (e-values, plug-in
// predictions); Freund, Schapire, Singer and Warmuth 1997 (forecasters that sleep).
#pragma once

#include <map>
#include <string>
#include <vector>

#include "algorithms/exploration/explanation_search.hpp"
#include "algorithms/inference/evidence.hpp"

namespace tribench::loop {

struct ForecastVerdict {
  std::string verdict;
  double weight = 0;       // posterior of all explanations that say so
  double log_e_value = 0;  // of what it said over what the mixture of all others said
};

class Forecasts {
 public:
  // Those that nobody has heard yet: the first ones enter with what all rows so far, the opening,
  // made of them, later ones with their prior. Nothing happens to those that are known.
  void hear(const std::vector<Explanation>& all);

  // all: the explanations as they stood, and were heard, before the further rows. before, after:
  // without and with these, under the noise that was known before them.
  void add(const std::vector<Explanation>& all, const EvidenceTable& before,
           const EvidenceTable& after);

  // The likeliest first; empty before any were heard.
  std::vector<ForecastVerdict> verdicts() const;

 private:
  struct Forecaster {
    std::string verdict;
    double log_prior = 0;
    double log_weight = 0;
  };
  std::map<std::vector<std::size_t>, Forecaster> forecasters_;  // by sorted families
};

}  // namespace tribench::loop
