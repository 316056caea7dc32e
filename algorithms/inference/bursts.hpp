// SPDX-License-Identifier: MIT
//
// Bursts in a residual: a collision, a contact, a glitch. No model explains them; they are listed
// and left out of the fits.
//
// A burst is a pulse that lasts some rows; a single wild row of heavy-tailed noise, which fades
// away by the noise's own correlation, is none. So the test looks at innovations (each row less
// what the row before foretells, in units of its speed's and its movement's own noise) under a
// Student t law fitted to them, and asks at every row how much likelier a pulse makes them: the
// likelihood ratio, averaged over the lengths, heights (some, and the one that fits best) and sides
// a pulse may have. How large the noise is, the movement's other rows say, how often it comes in
// loud spells all rows do, and both likelihoods are averaged over what they leave open: a burst
// does not hide in noise that it has made larger itself, nor is noise that is larger than was
// thought a burst. The tail of that average under the null comes from importance sampling (Siegmund
// 1976), the union over all rows keeps false bursts in a whole recording at kFalseBursts. The
// specification's rule (section 4, four rows beyond four robust standard deviations) finds fewer
// and raises more: heavy tails and correlation make such runs by themselves.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "foundation/random.hpp"

namespace tribench::loop {

// Expected in a recording without any.
inline constexpr double kFalseBursts = 0.01;

// Rows [begin, end) of one movement.
struct Burst {
  std::size_t begin = 0;
  std::size_t end = 0;
  double peak = 0;       // magnitude, from the movement's middle
  double log_ratio = 0;  // how much likelier a pulse is than noise
};

// In the order of their rows. movement: a number a row, equal ones together; speed: what the width
// of the noise may hang on, a magnitude a row, or empty; residual: a row each, from a rich model in
// which no repeatable structure is left; finite. More than one row in twenty is no burst but a
// wrong model: none is found then. Deterministic given random. Cost: some 20 pulses at the rows
// whose innovations stand out, and 512 draws.
std::vector<Burst> find_bursts(std::span<const int> movement, std::span<const double> speed,
                               const Eigen::VectorXd& residual, RandomStream random);

// 1 for the rows of a burst and five on either side, within its movement.
std::vector<char> rows_about(std::span<const Burst> bursts, std::span<const int> movement);

}  // namespace tribench::loop
