// SPDX-License-Identifier: MIT
//
// The series behind the pictures of a closed loop (reports/record/loop_pictures.hpp), computed from
// every row that took part: nothing is thinned, rows are averaged in bins. Internal to the folder.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "harness/loop/judged_diagnosis.hpp"
#include "reports/record/loop_record.hpp"

namespace tribench::loop {

// What all pictures look at. Rows of bursts are not among `rows`.
struct LoopRows {
  const JudgedDiagnosis& diagnosis;
  const Observations& data;
  std::vector<std::size_t> rows;
  Eigen::VectorXd before;  // predictions, of every row of the data
  Eigen::VectorXd after;
  Eigen::VectorXd rigid;  // the rigid body's part of the new model
  bool has_rigid = false;
  double rows_of_noise = 1;  // how many rows the noise lasts: what a mean's error counts by
};

LoopRows loop_rows(const JudgedDiagnosis& diagnosis, const Observations& data);

// 1 or -1 a row; all 1 where the data have no direction.
Eigen::VectorXd direction(const Observations& data);

// What a family adds, row by row, and half of its 95 % interval from its coefficients'.
struct EffectShare {
  Eigen::VectorXd value;
  Eigen::VectorXd half;
};
EffectShare effect_share(const LoopRows& rows, const EffectFinding& effect);

// Friction torque's root mean square, the rigid body's part taken off.
double friction_rms(const LoopRows& rows);

// A signal of its own: no sign, no filtered copy of another.
bool worth_a_look(const Signal& signal);

LoopAxis axis_of(const Observations& data, std::string_view signal);

LoopFrictionPicture friction_picture(const LoopRows& rows);
LoopEffectPicture effect_picture(const LoopRows& rows, const EffectFinding& effect);
std::vector<LoopInputPicture> input_pictures(const LoopRows& rows);
std::vector<LoopMapPicture> leftover_maps(const LoopRows& rows);
std::vector<LoopTrace> traces(const LoopRows& rows);

// All pictures of the record, and its friction_rms.
void add_series(LoopRecord& record, const JudgedDiagnosis& diagnosis, const Observations& data);

inline constexpr std::size_t kFewestRowsOfBin = 5;

// Means of rows in bins of `x`. by: the bin of each of the chosen rows, as cut_bins gives it.
struct Bins {
  std::vector<std::vector<std::size_t>> rows;  // in the order of x
};

// About `most` bins with equally many rows, none with fewer than `fewest`; rows with the same x
// stay together. Empty where there are fewer rows than that.
Bins equal_counts(std::vector<std::size_t> rows, const Eigen::VectorXd& x, std::size_t most,
                  std::size_t fewest);
// `most` bins of the same width; those with fewer rows than `fewest` are left out.
Bins equal_widths(const std::vector<std::size_t>& rows, const Eigen::VectorXd& x, std::size_t most,
                  std::size_t fewest);

std::vector<double> means(const Bins& bins, const Eigen::VectorXd& values);
std::vector<double> deviations(const Bins& bins, const Eigen::VectorXd& values);
std::vector<double> counts(const Bins& bins);
// Half of the 95 % interval of the bins' means.
std::vector<double> mean_errors(const Bins& bins, const Eigen::VectorXd& values,
                                double rows_of_noise);

}  // namespace tribench::loop
