// SPDX-License-Identifier: MIT
//
// The noise in which bursts are looked for: what is left of each row when its movement's offset and
// what the row before foretells are taken off, in units of the noise at its level and in its
// movement, and the law of that. Internal to the room. Residuals are finite, in any unit.
//
// Levels are of Student's law by maximum likelihood: a burst hardly counts in them, and the level
// of its movement can be had without its rows.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "algorithms/inference/clusters.hpp"
#include "algorithms/inference/student_law.hpp"

namespace tribench::loop {

class BurstNoise {
 public:
  // movement: a number a row, equal ones together. speed: what the width of the noise may hang on,
  // a magnitude a row; empty where nothing is known of it. residual: a row each.
  BurstNoise(std::span<const int> movement, std::span<const double> speed,
             const Eigen::VectorXd& residual);

  // Of the deviations; 0 where there is no noise, and then there is nothing else either.
  double robust_sd() const { return robust_sd_; }
  const std::vector<RowRange>& movements() const { return movements_; }
  std::size_t movement_at(std::size_t row) const;

  // Per row: from the movement's offset; the innovation in units of its noise; those units.
  const std::vector<double>& deviation() const { return deviation_; }
  const std::vector<double>& innovation() const { return innovation_; }
  const std::vector<double>& unit() const { return unit_; }
  double rho() const { return rho_; }             // of neighbouring rows
  const StudentLaw& law() const { return law_; }  // of the innovations

  // A movement's noise as its other rows than [first, first + rows) have it, as a multiple of what
  // its units are in; and the standard deviation of the logarithm of that.
  double level_without(std::size_t movement, std::size_t first, std::size_t rows) const;
  double level_error(std::size_t movement, std::size_t rows) const;

 private:
  void centre(const Eigen::VectorXd& residual);
  void innovate();
  void scale_by_movement();
  void divide_by_levels();
  struct Level {
    double factor;
    double variance;  // of the logarithm
  };
  Level shrunk_level(double own, double rows) const;

  std::vector<RowRange> movements_;
  std::vector<double> deviation_;
  std::vector<double> innovation_;
  std::vector<double> unit_;
  std::vector<double> level_;  // per movement, part of unit_
  double robust_sd_ = 0;
  double rho_ = 0;
  double mean_log_level_ = 0;
  double speed_variance_ = 0;
  double spread_ = 0;  // of the movements' log levels: variance
  StudentLaw law_;
};

}  // namespace tribench::loop
