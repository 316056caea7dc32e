// SPDX-License-Identifier: MIT
//
// A run as LaTeX tables for a paper: per operator set, methods down, problems across, each with the
// median error over the seeds, its range and the median complexity; published figures beside ours
// where the run has them. Needs the packages booktabs and graphicx, no more.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "reports/published.hpp"
#include "reports/summary.hpp"

namespace tribench {

// `name`: of the run, for captions and labels. Bold: the best of its column; a dagger marks what is
// within 1 % of it or not distinguishable from it.
std::string latex_tables(std::string_view name, const RunSummary& summary,
                         const std::vector<PublishedProblem>& published);

// Text as LaTeX prints it: # $ % & _ { } ~ ^ \ escaped.
std::string latex_text(std::string_view text);

}  // namespace tribench
