// SPDX-License-Identifier: MIT
//
// leaderboard.md: one screen first (who wins where, how sure, what failed, what is missing), then
// a table per problem and operator set. The file and the terminal get the same text.
//
// Without the columns of time it depends on the records alone: the same cells give the same bytes.
#pragma once

#include <string>

#include "reports/run_folder.hpp"
#include "reports/sensitivity.hpp"
#include "reports/summary.hpp"

namespace tribench {

// changed: what `compare` says against a base run, Markdown; empty where there is none.
std::string leaderboard(const RunFolder& run, const RunSummary& summary,
                        const std::vector<Sensitivity>& sensitivity,
                        const std::string& changed = {});

// The first screen alone.
std::string leaderboard_head(const RunFolder& run, const RunSummary& summary,
                             const std::string& changed = {});

}  // namespace tribench
