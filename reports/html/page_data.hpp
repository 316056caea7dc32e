// SPDX-License-Identifier: MIT
//
// What the page of a run shows, condensed from its folder: the page gets aggregates and a bounded
// number of rows, so that a run of hundreds of thousands of cells stays a page of a few megabytes.
// front.csv and trace.csv are streamed, never held.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "reports/published.hpp"
#include "reports/run_folder.hpp"
#include "reports/summary.hpp"

namespace tribench {

// Keys: name, made_with, counts, problems, operators, tables, rankings, fronts, traces, profiles,
// ecdf, curves, singular, failures, missing, complaints, reference, records, provenance.
nlohmann::ordered_json page_data(const RunFolder& run, const RunSummary& summary,
                                 const std::vector<PublishedProblem>& published);

}  // namespace tribench
