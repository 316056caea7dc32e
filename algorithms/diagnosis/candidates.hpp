// SPDX-License-Identifier: MIT
//
// Which effects a round of tests admits beside the present model, and what else they could be.
// Internal to the room.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "algorithms/campaign/round.hpp"

namespace tribench::loop {

// Up to this p a family carried by few clusters may be rescued by a gain of so many standard errors
// (specification, 6.4), whatever its p by one that is so many where no cluster counts for much.
inline constexpr double kRescueP = 0.15;
inline constexpr double kRescueErrors = 2;
inline constexpr double kRescueBoundedZ = 3;
// Up to this p a family is a rival of the one that was taken.
inline constexpr double kNearAliasP = 0.05;
inline constexpr double kExactCorrelation = 0.995;

struct Candidate {
  std::size_t family = 0;
  std::size_t atom = 0;
  Gain gain;
  Eigen::VectorXd losses;
  bool rescued = false;  // carried by few clusters, admitted by its gain
};

// Whether its gain alone may admit what few movements carry.
inline bool is_steady(const Gain& gain) { return gain.bounded_z > kRescueBoundedZ; }
inline bool is_more_than_error(const Gain& gain) {
  return gain.nats > kRescueErrors * gain.error || is_steady(gain);
}

// The family's atom that predicts best beside the model. None where none can be judged: none is
// testable, or the folds of the cross-validation do not know its columns.
std::optional<Candidate> best_atom(std::size_t family, const Round& round, const FittedModel& model,
                                   const Campaign& campaign);

// Families whose p and gain, or rescue, admit them beside the model; best gain first.
std::vector<Candidate> admitted(const Round& round, const FittedModel& model,
                                const Campaign& campaign);

// Which of a family's atoms is the first is told while others are missing that come later, and
// where the joint does not turn far enough many waves look alike: as many atoms of the family that
// predict better beside the rest as it stands, or fewer that predict no worse. Empty: none do, or
// one that it has, and that may stand alone, has a shape of its own.
std::vector<std::size_t> better_atoms(std::size_t family, const Round& round,
                                      const FittedModel& model, const Campaign& campaign);

// The families that look like the winner and explain nearly the same, and the causes that always
// do. extended: the model with the winner, fitted.
std::vector<AliasFinding> aliases_of(const Candidate& winner, const FittedModel& extended,
                                     const Round& round, const FittedModel& model,
                                     const Campaign& campaign);

}  // namespace tribench::loop
