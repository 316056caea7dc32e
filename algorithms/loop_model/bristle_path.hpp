// SPDX-License-Identifier: MIT
//
// The way that bristles see between the rows of a recording, and how they bend along it. Internal
// to bristles.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "algorithms/loop_model/bristles.hpp"

namespace tribench::loop {

// What the joint did between the row before and this one: a way back, and a way on.
struct PathStep {
  double back = 0;
  double on = 0;
  double sign = 0;
  bool starts = false;  // a movement
};

// data: with v and d, better with q.
std::vector<PathStep> path_of(const Observations& data);

// z, row by row, of an element that slides from `sliding` on.
Eigen::VectorXd deflection(BristleLaw law, BristleStart start, double sliding,
                           const std::vector<PathStep>& path);

// z' = v - |v| z / sliding.
Eigen::VectorXd deflection_rate(const Eigen::VectorXd& z, double sliding, const Observations& data);

}  // namespace tribench::loop
