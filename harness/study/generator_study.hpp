// SPDX-License-Identifier: MIT
//
// Does the generator of datasets A and B give the errors it was made to give? Simple exact fits on
// fresh data of each seed, set beside the table of the specification (closed loop, section 8.2).
// The fits are the study's own yardsticks, not methods: least squares for what is linear, a scan of
// the two shape parameters for the Stribeck form.
//
// Averaged figures are fitted and judged on all 90 movements, as that table's are; raw figures are
// fitted on 80 movements and judged on the other 10.
#pragma once

#include <string>
#include <vector>

namespace tribench {

struct GeneratorFigure {
  int joint = 0;
  std::string name;     // "averaged set, symmetric"
  std::string unit;     // of the figure
  double expected = 0;  // the specification's synthetic figure
  std::string paper;    // as printed in the paper, "-" where nothing is
  double mean = 0;      // ours, over the seeds
  double spread = 0;    // sample standard deviation over the seeds; 0 for one seed
  bool within = false;  // mean within 10 % of expected
};

// seeds 1 .. seeds; about 0.1 s a seed and joint. seeds >= 1.
std::vector<GeneratorFigure> run_generator_study(int seeds);

}  // namespace tribench
