// SPDX-License-Identifier: MIT
//
// A ripple whose period nobody has named: waves of any length along the position in what a model
// leaves over.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "algorithms/campaign/fitted_model.hpp"
#include "algorithms/inference/wave_scan.hpp"

namespace tribench::loop {

// Whether a family has its period from the gear's ratio.
bool repeats_with_the_gear(const EffectFamily& family);

// The waves that unknown_ripple looks at. None where it looks at none: no position, too few
// stretches of movement, or no family of the library would repeat with the gear.
std::optional<WaveRange> ripples_looked_for(const Campaign& campaign);

// The largest of what repeats, shorter than the output's own ripples. None where nothing repeats
// at the level of what is left over, or none is looked at.
std::optional<Wave> unknown_ripple(const FittedModel& model, const Campaign& campaign,
                                   RandomStream random);

// Its columns, cos and sin.
Eigen::MatrixXd wave_columns(const Wave& wave, const Observations& data);

}  // namespace tribench::loop
