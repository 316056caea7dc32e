// SPDX-License-Identifier: MIT
//
// How likely neighbouring innovations are with a pulse and without one, where the level of the
// noise is known but for a factor and noise may come in loud spells. Internal to the room.
// Innovations are finite, in units of their movement's noise (burst_noise.hpp).
//
// A spell says nothing of shape or side, only that rows are louder for a while: what a pulse has to
// be told from. How often spells come is estimated, not supposed: where the rows away from likely
// pulses know of none, none are reckoned with, and a few collisions in even noise stay what they
// are.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "algorithms/inference/burst_noise.hpp"
#include "algorithms/inference/student_law.hpp"
#include "foundation/random.hpp"

namespace tribench::loop {

// Rows that a pulse touches at most, the one after it included.
inline constexpr std::size_t kLongestPulse = 15;

// What the noise's level may be as a multiple of what is supposed: five values and their weights
// (Gauss and Hermite's, of a normal logarithm).
struct NoiseLevels {
  static constexpr std::array<double, 5> kNodes = {-2.856970013872806, -1.355626179974266, 0,
                                                   1.355626179974266, 2.856970013872806};
  static constexpr std::array<double, 5> kWeights = {0.011257411327721, 0.222075922005613,
                                                     0.533333333333333, 0.222075922005613,
                                                     0.011257411327721};
  std::array<double, kNodes.size()> factor{};

  // error: the standard deviation of the level's logarithm.
  NoiseLevels(double middle, double error);
  NoiseLevels times(double loudness) const;
  double draw(RandomStream& random) const;
};

// Of `rows` innovations z less `height` times `unit`, over the levels, as a multiple of the product
// of the inverse of `inverse_kernels`. Pointers of `rows` values each; no allocation.
double pulse_likelihood(const StudentLaw& law, const double* z, const double* unit, double height,
                        std::size_t rows, const NoiseLevels& levels, const double* inverse_kernels);

// The same without a pulse: as the noise mostly is, and in a loud spell.
struct QuietLikelihood {
  double plain = 0;
  double loud = 0;
  // share: of rows in loud spells, 0 to 1.
  double mixed(double share) const { return (1 - share) * plain + share * loud; }
};
QuietLikelihood quiet_likelihood(const StudentLaw& law, const double* z, std::size_t rows,
                                 const NoiseLevels& levels, const double* inverse_kernels);

// The share of rows in loud spells by maximum likelihood (Dempster, Laird, Rubin 1977); 0 where the
// rows with left_out[i] == 0 do not speak for any. Cost: some 20 likelihoods every nine rows.
double share_of_loud_spells(const BurstNoise& noise, const std::vector<char>& left_out);

}  // namespace tribench::loop
