// SPDX-License-Identifier: MIT
//
// The story of singularities and physics in numbers, from records alone: per operator set and
// method how many formulas are proved free, refuted (and how many of those a grid of points would
// have missed) or undecided, how many are proved dissipative, monotone and odd, and what admitting
// only formulas proved free costs or gains in error.
#pragma once

#include <string>
#include <vector>

#include "reports/record.hpp"

namespace tribench {

// Markdown, with its heading; empty where no record has a verdict.
std::string proofs_section(const std::vector<Record>& records);

}  // namespace tribench
