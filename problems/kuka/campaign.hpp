// SPDX-License-Identifier: MIT
//
// Datasets A and B as experiments: what the robot does and what it records.
//
// A: 90 movements at constant velocity (45 speeds, both directions) over the whole stroke, in
// random order. Raw rows are instants of the 1 kHz record; averaged rows are one movement each, the
// mean over all its samples, in which the load cancels.
// B: movements of 43 s, dwell segments of 1.5 to 5 s at low speeds in both directions while the
// other joints move, without or with a payload at the flange. Its friction differs from A's law by
// a shift that no channel declares.
//
// Channels: time_s (runs through the campaign), q, qd, sgn_qd, g, sgn_g, tau_f (friction, positive
// with velocity); B has g_arm (the arm alone), tau_ext (the payload's part) and tau_m too, with
// g = g_arm + tau_ext and tau_m = g + tau_f.
//
// Source: the specification of the closed loop, sections 8.2 and 8.3.
#pragma once

#include <cstddef>
#include <cstdint>

#include "problems/kuka/joint.hpp"
#include "problems/table.hpp"

namespace tribench::kuka {

inline constexpr double kPauseBetweenMovements_s = 2;

// Rows: 90 x samples_per_movement, one instant drawn from each of as many equal parts of a
// movement. Truth: the law, without ripple and noise.
KnownDataset make_a_raw(const Joint& joint, std::uint64_t seed, std::size_t samples_per_movement);

// Rows: 90, with channels qd, sgn_qd and tau_f. Truth: the mean of the law and of the ripple over
// the stroke. The mean noise of n samples is drawn as one normal number of sd sw / sqrt(n), which
// is its distribution; the mean over position is computed at up to 6000 instants.
KnownDataset make_a_averaged(const Joint& joint, std::uint64_t seed);

// movements: how many; payload_kg >= 0. Truth: law and shift, without ripple and noise.
KnownDataset make_b(const Joint& joint, std::uint64_t seed, double payload_kg, int movements,
                    std::size_t samples_per_movement);

// Place in commanded_speeds() of each movement of A, and its direction.
struct Setting {
  int speed = 0;
  int direction = 1;
};
// The 90 settings in the campaign's random order; movement i of A runs at settings[i].
std::vector<Setting> campaign_order(const Joint& joint, std::uint64_t seed);

}  // namespace tribench::kuka
