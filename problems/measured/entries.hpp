// SPDX-License-Identifier: MIT
//
// The measured sets' problems in the catalogue. They are listed without the data; making one needs
// them, and checks the hash of the files it reads.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "problems/measured/manifest.hpp"
#include "problems/problem.hpp"

namespace tribench::measured {

void add_entries(std::vector<ProblemEntry>& entries,
                 const std::optional<std::filesystem::path>& data);

// The problem that a plan of `manifest` describes; the seed draws the movements held out.
Problem make_measured_problem(const Manifest& manifest, const ProblemPlan& plan,
                              const std::optional<std::filesystem::path>& data, std::uint64_t seed);

}  // namespace tribench::measured
