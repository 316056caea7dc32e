// SPDX-License-Identifier: MIT
//
// How likely each explanation is given the rows so far, and which cannot be excluded yet.
//
// An explanation is a set of up to three families: none, one, two, something that no library has,
// with an effect beside it or alone. Its evidence is the mean of its blocks' Bayes factors
// (evidence.hpp). The e-value against an explanation is the prior mean of all explanations'
// evidence over its own: were it true, the e-value would exceed 1/alpha with a probability of alpha
// at most, at whatever time one stops and however the movements were chosen (Ville 1939). So the
// explanations whose e-value is below 1/alpha are a confidence set that may be looked at after
// every movement; when all in it say the same, that is the verdict.
//
// What the guarantee rests on: that the truth is nearly in one of the families, and noise that is
// independent once rows are whitened. `tribench study explore` measures what is left of it.
//
// Cost: rows x columns^2 (some 700 columns), 50 to 200 ms.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "algorithms/exploration/explanations.hpp"
#include "algorithms/inference/clusters.hpp"

namespace tribench::loop {

inline constexpr std::string_view kUnknownVerdict = "UNKNOWN";

struct Explanation {
  std::vector<std::size_t> families;       // of the space, in its order; empty: nothing is missing
  std::vector<const ColumnBlock*> blocks;  // the best of each
  double log_evidence = 0;                 // over nothing missing
  double log_prior = 0;
  double weight = 0;       // posterior
  double log_e_value = 0;  // against it
  std::string verdict;     // "NONE", "stribeck", "load_coulomb+stribeck", "UNKNOWN", ...
};

struct Assessment {
  std::vector<Explanation> explanations;  // the most likely first
  std::vector<std::size_t> alive;         // those in the confidence set, the most likely first
  Noise noise;
  double variance = 0;  // of a whitened row
  // Rows as the evidence saw them.
  Eigen::MatrixXd base;
  Eigen::MatrixXd columns;
  EvidenceTable table;
  // The same of the foreseen rows, not whitened.
  Eigen::MatrixXd foreseen_base;
  Eigen::MatrixXd foreseen_columns;

  const Explanation& best() const { return explanations.front(); }
  // All in the confidence set say the same.
  bool sure() const;
  // Posterior of all explanations that say so.
  double weight_of(const std::string& verdict) const;
};

// rows: with the signals of the space's reference. 0 < alpha < 1. before: the likeliest explanation
// of the look before, which says what is noise; at the first look nothing missing. foreseen: rows
// of movements to choose from, signals alike; may have no row.
Assessment assess(const ExplanationSpace& space, const Observations& rows,
                  const Observations& foreseen, double alpha, const Explanation& before);

// What an explanation says: the families' names in order, "UNKNOWN" for what no library has. What
// lives in nothing but the inputs of effects named beside it is one of them in another shape.
std::string verdict_of(const ExplanationSpace& space, const std::vector<std::size_t>& families);

}  // namespace tribench::loop
