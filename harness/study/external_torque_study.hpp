// SPDX-License-Identifier: MIT
//
// How well the friction models of a finished run estimate the external torque in dataset B with
// load: the paper's last experiment. The estimator knows the arm, not the payload; what the motor
// gives beyond the arm's gravity and the predicted friction is taken for external torque.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tribench {

struct ExternalTorqueFigure {
  int joint = 0;
  std::string model;    // method, or "(no friction model)", "(true law and shift)"
  std::string problem;  // what it was fitted as; empty for the two yardsticks
  std::string operators;
  std::size_t seeds = 0;
  double mae_nm = 0;  // median over the seeds
  double low_nm = 0;  // smallest and largest over the seeds
  double high_nm = 0;
  // Share of the rows whose load lies beyond what the adaptation's movement has seen, and the
  // median error there; 0 where there are none.
  double outside_share = 0;
  double mae_outside_nm = 0;
};

// From the records of B/jN/load (adapted or not) in the run's results.csv; sorted by joint, then
// error. Throws Error (bad_input) where the folder has no such record.
std::vector<ExternalTorqueFigure> run_external_torque_study(const std::filesystem::path& run);

// As a table for people.
std::string external_torque_markdown(const std::vector<ExternalTorqueFigure>& figures);

// With a heading, for a page about the run; empty where the run has no cell of B/jN/load.
std::string external_torque_section(const std::filesystem::path& run);

}  // namespace tribench
