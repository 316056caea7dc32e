// SPDX-License-Identifier: MIT
//
// The judge of a closed loop: the errors of the models before and after on rows that neither of
// them has seen, by movement, with the interval of their difference. Which rows those are is
// judged_diagnosis's to say.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "foundation/random.hpp"
#include "problems/preparation/observations.hpp"

namespace tribench::loop {

struct MovementError {
  int movement = 0;
  double before = 0;  // mean absolute error
  double after = 0;
  std::size_t rows = 0;
  double mean_before = 0;  // of the error with its sign
  double mean_after = 0;
};

enum class JudgedOn { other_movements, pieces_of_movements, rows_of_the_fit };

struct ErrorFinding {
  std::size_t test_movements = 0;
  JudgedOn judged_on = JudgedOn::other_movements;
  std::string how;  // in words: "held out", "each movement left out in turn"
  double mae_before = std::numeric_limits<double>::quiet_NaN();
  double mae_after = std::numeric_limits<double>::quiet_NaN();
  // As mae_after, found presliding as bristles with a state; NaN where none was found.
  double mae_state = std::numeric_limits<double>::quiet_NaN();
  double rmse_before = std::numeric_limits<double>::quiet_NaN();
  double rmse_after = std::numeric_limits<double>::quiet_NaN();
  double max_before = std::numeric_limits<double>::quiet_NaN();
  double max_after = std::numeric_limits<double>::quiet_NaN();
  // Root mean square of the movements' mean errors: what noise within them does not hide.
  double means_before = std::numeric_limits<double>::quiet_NaN();
  double means_after = std::numeric_limits<double>::quiet_NaN();
  double difference_low = std::numeric_limits<double>::quiet_NaN();  // before - after, 95 %
  double difference_high = std::numeric_limits<double>::quiet_NaN();
  // Where asked for (JudgingOptions::bounds): the noise lies between `ceiling`, which no model
  // does better than, and `attainable`, which a smooth one reaches; the share of the gap that was
  // closed between the two figures that follow from them, the first with its 95 % interval.
  double ceiling = std::numeric_limits<double>::quiet_NaN();
  double attainable = std::numeric_limits<double>::quiet_NaN();
  double closed_fraction = std::numeric_limits<double>::quiet_NaN();
  double closed_low = std::numeric_limits<double>::quiet_NaN();
  double closed_high = std::numeric_limits<double>::quiet_NaN();
  double closed_fraction_high = std::numeric_limits<double>::quiet_NaN();
  std::string ceiling_note;  // why a figure is missing
  std::vector<MovementError> movements;
  bool confirmed = true;  // the effects' improvement holds on the test movements
};

// Errors of both models on `data`, movement by movement, with a bootstrap interval of the paired
// difference. unit: per row, what the bootstrap draws (movements, or pieces of them where they are
// few); equal numbers stand together. NaN throughout where there are no rows.
ErrorFinding judge(const Observations& data, const Eigen::VectorXd& before,
                   const Eigen::VectorXd& after, std::span<const int> unit, RandomStream random);

}  // namespace tribench::loop
