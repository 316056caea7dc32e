// SPDX-License-Identifier: MIT
//
// Bursts: a collision, a contact, a glitch. They are events, listed by movement and time and left
// out of the fits; no friction model explains them. Internal to the room.
//
// A burst is a pulse that lasts some rows; a single wild row of heavy-tailed noise, which fades
// away by the noise's own correlation, is none. So the test looks at innovations (each row less
// what the row before foretells, in units of its speed's and its movement's own noise) under a
// Student t law fitted to them, and asks at every row how much likelier a pulse makes them: the
// likelihood ratio, averaged over the lengths, heights and sides a pulse may have. How large the
// noise is, the movement's other rows say, and both likelihoods are averaged over what they leave
// open: a burst does not hide in noise that it has made larger itself, nor is noise that is larger
// than was thought a burst. The tail of that average under the null comes from importance sampling
// (Siegmund 1976), the union over all rows keeps false bursts in a whole recording at kFalseBursts.
// The specification's rule (section 4, four rows beyond four robust standard deviations) finds
// fewer and raises more: heavy tails and correlation make such runs by themselves.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "algorithms/diagnosis/diagnosis.hpp"

namespace tribench::loop {

// Expected in a recording without any.
inline constexpr double kFalseBursts = 0.01;

// residual: of all rows, from a rich model fitted to the training movements, in which no
// repeatable structure is left. masked: 1 for the rows of a burst and five on either side. More
// than one row in twenty is no event but a wrong model: nothing is listed then.
std::vector<EventFinding> find_events(const Observations& data, const Eigen::VectorXd& residual,
                                      std::vector<char>& masked, RandomStream random);

}  // namespace tribench::loop
