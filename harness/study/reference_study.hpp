// SPDX-License-Identifier: MIT
//
// Do the measured sets, read as their manifests say, give the errors that were published for them?
// The published models are fitted by least squares on the whole file, as they were; the figures
// are errors of the fit, not of held-out movements.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tribench {

struct ReferenceFigure {
  std::string problem;
  std::string model;
  std::string summary;   // the model's terms
  double published = 0;  // 100 |y - f| / |y|
  double ours = 0;
  std::size_t rows = 0;
  bool within = false;  // within 0.1 (percentage points)
};

// Throws Error (bad_input) where the data are not there.
std::vector<ReferenceFigure> run_reference_study(const std::optional<std::filesystem::path>& data);

}  // namespace tribench
