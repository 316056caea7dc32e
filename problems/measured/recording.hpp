// SPDX-License-Identifier: MIT
//
// A measured file as a recording, the way its manifest says: roles and units, rows kept, channels
// derived, movements cut, decimated or averaged. In this order.
#pragma once

#include <filesystem>

#include "problems/dataset.hpp"
#include "problems/measured/manifest.hpp"

namespace tribench::measured {

// Throws Error (bad_input) where the file does not hold what the plan needs.
Dataset read_recording(const ProblemPlan& plan, const std::filesystem::path& file);

}  // namespace tribench::measured
