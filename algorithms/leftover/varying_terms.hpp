// SPDX-License-Identifier: MIT
//
// What differs from movement to movement though no signal says why: a load that was changed and not
// written down, friction that another grease or an unknown temperature made higher. The last thing
// that is asked: whatever follows a signal is found and named before.
#pragma once

#include <Eigen/Core>

#include "algorithms/campaign/search_state.hpp"
#include "algorithms/leftover/leftover_finding.hpp"

namespace tribench::loop {

// Where nothing is left over in any signal: the term of the base's friction or of the library whose
// coefficient differs most, if one does at the level of what is left over, or by so much that it
// may stand behind all else (varying without inputs). Effects that may stand for it are marked, and
// it is told beside them however small it is. rich_residual: what the rich model leaves of the
// campaign's rows.
void find_varying_term(SearchState& state, LeftoverFinding& leftover,
                       const Eigen::VectorXd& rich_residual, const Campaign& campaign,
                       const RandomStream& random);

}  // namespace tribench::loop
