// SPDX-License-Identifier: MIT
//
// The explanations of what has been recorded: sets of families (nothing, one, two, more where the
// rows ask for it; something that no library has, with effects beside it or alone) and their
// evidence.
//
// A family's evidence is the mean of its blocks' Bayes factors (evidence.hpp). Every family is laid
// beside the likeliest single ones, all of its blocks anew, since what it shows alone is hidden by
// them; beside the likeliest pairs; and beside what is likeliest of all as long as that helps. A
// pair of which neither is among them counts as if the two were independent.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "algorithms/exploration/explanations.hpp"
#include "algorithms/inference/evidence.hpp"

namespace tribench::loop {

inline constexpr std::string_view kUnknownVerdict = "UNKNOWN";

struct Explanation {
  std::vector<std::size_t> families;       // of the space, in its order; empty: nothing is missing
  std::vector<const EffectBlock*> blocks;  // the best of each; the assessment's
  double log_evidence = 0;                 // over nothing missing
  double log_prior = 0;
  double weight = 0;       // posterior
  double log_e_value = 0;  // against it
  std::string verdict;     // "NONE", "stribeck", "load_coulomb+stribeck", "UNKNOWN", ...
};

struct WeighedVerdict {
  std::string verdict;
  double weight = 0;
};

struct FoundExplanations {
  std::vector<Explanation> explanations;
  // Per family, of columns that rows were near: what the explanations point to.
  std::vector<std::vector<EffectBlock>> blocks;
};

// Weights and e-values are left to the caller. Cost: some 5 000 small systems of equations.
FoundExplanations find_explanations(const ExplanationSpace& space, const EvidenceTable& table);

// What an explanation says: the families' names in order, "UNKNOWN" for what no library has. What
// lives in what is characteristic of an effect named beside it is that effect in another shape.
std::string verdict_of(const ExplanationSpace& space, const std::vector<std::size_t>& families);
// Names in order, each once; "NONE" where there is nothing.
std::string verdict_text(std::vector<std::string> names, bool unknown);

// ln of the sum of the exponentials; -infinity of nothing.
double log_sum(std::span<const double> logs);

}  // namespace tribench::loop
