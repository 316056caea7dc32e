// SPDX-License-Identifier: MIT
//
// A joint from texts, and a movement of made-up rows, for the tests of the room.
#pragma once

#include <string>
#include <vector>

#include "algorithms/forward_dynamics/forward_simulation.hpp"

namespace tribench::forward::testing {

inline JointModel joint(double inertia, const std::string& friction,
                        const std::string& gravity = {}, const NamedColumns& columns = {}) {
  JointModel model = parse_joint(friction, gravity, columns, "--formula");
  model.inertia = inertia;
  return model;
}

// `rows` rows a step of `step_s` apart, at rest at `position` unless said otherwise.
struct Movement {
  std::vector<double> time, position, velocity, drive, connected;
  std::vector<std::vector<double>> recorded, control;

  Movement(std::size_t rows, double step_s, double at = 0, double speed = 0) {
    for (std::size_t i = 0; i < rows; ++i) time.push_back(static_cast<double>(i) * step_s);
    position.assign(rows, at);
    velocity.assign(rows, speed);
    drive.assign(rows, 0);
  }
  MovementRows rows() const {
    MovementRows all{time, position, velocity, drive, connected, {}, {}};
    for (const auto& column : recorded) all.recorded.emplace_back(column);
    for (const auto& column : control) all.control.emplace_back(column);
    return all;
  }
};

}  // namespace tribench::forward::testing
