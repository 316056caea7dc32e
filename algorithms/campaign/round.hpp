// SPDX-License-Identifier: MIT
//
// The tests of the whole library beside one fitted model.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "algorithms/campaign/fitted_model.hpp"

namespace tribench::loop {

// A family excited in fewer clusters cannot reach a small p by sign flips (specification, 3.3).
inline constexpr std::size_t kFewestClusters = 20;
// Below so many effective clusters an atom is carried by few (specification, 6.4).
inline constexpr double kFewClusters = 25;

struct Round {
  Eigen::MatrixXd columns;          // the library's, whitened with the model's noise
  std::vector<BlockScores> blocks;  // per atom
  std::vector<double> maxima;       // over all tests, per flip
  std::vector<double> family_p;     // adjusted; 1 where untestable
  std::vector<double> family_score;
  std::vector<std::size_t> family_atom;  // that has this score, where it is above 0
  std::vector<char> counted_alike;       // the score is one of stretches that count alike
  std::vector<char> rescue_only;         // carried by fewer clusters than a test by flips needs
};

Round test_library(const FittedModel& model, const Campaign& campaign);

// Whether a family as it stands in `with` is told beside a model without it: its p, adjusted for
// the whole library, is at most alpha_library.
bool tells_beside(const FittedModel& rest, std::size_t family, const FittedModel& with,
                  const Campaign& campaign);

}  // namespace tribench::loop
