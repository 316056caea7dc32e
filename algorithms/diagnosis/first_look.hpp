// SPDX-License-Identifier: MIT
//
// What the first round of tests says of every family, whatever the search then takes: how near it
// came to being taken, what could not be tested, and which families these data cannot tell apart.
// Internal to the room.
#pragma once

#include <vector>

#include "algorithms/campaign/round.hpp"
#include "algorithms/diagnosis/diagnosis.hpp"

namespace tribench::loop {

struct FirstLook {
  std::vector<CandidateFinding> candidates;  // best score first
  std::vector<UntestableFinding> untestable;
  std::vector<CoincidingFamilies> coinciding;
  AliasMap alias_map;
};

FirstLook first_look(const Round& round, const FittedModel& base, const Campaign& campaign);

}  // namespace tribench::loop
