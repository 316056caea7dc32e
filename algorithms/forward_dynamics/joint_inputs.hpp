// SPDX-License-Identifier: MIT
//
// What each name in a formula means while a joint is simulated. The simulated motion stands where
// the data have a measured one; everything else is taken as it was recorded.
//
//   q v a sgn_v     position, velocity, acceleration, direction of motion
//   sin_q cos_q     of the position
//   t               time (s)
//   tau_m           torque of the motor
//   g sgn_g         gravity torque of the model, at the simulated position
//   d v_lag30 ...   what follows from the motion before (memory.hpp), states declared beside it
//   sgn_X           the sign of a recorded column X
//   a column's name by its role one of the above, else the column as recorded
//
// A column that a name above would hide is meant where the data have one of that name and role.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "problems/dataset.hpp"

namespace tribench::forward {

enum class Source {
  position,
  velocity,
  direction,
  sine,  // of the position
  cosine,
  acceleration,
  time,
  motor_torque,
  gravity,
  gravity_sign,
  recorded,
  recorded_sign,
  memory,
};

struct Binding {
  Source source = Source::recorded;
  std::size_t place = 0;  // of a recorded column among `recorded`, of a memory among the memories
};

// The names of a formula, bound.
struct JointInputs {
  std::vector<Binding> bindings;      // one a name
  std::vector<std::string> recorded;  // columns of the data that are needed, each once
  std::vector<std::string> memories;  // names

  bool uses(Source source) const;
};

// What binds names: the data's columns, and whether the model knows its gravity.
struct NamedColumns {
  struct Column {
    std::string name;
    Role role = Role::none;
  };
  std::vector<Column> columns;
  bool has_gravity = false;
  // Names that are memories beside those of memory.hpp: states that the formula declares.
  std::vector<std::string> states;
};

// Throws Error (bad_input) at `place` for a name that is nothing, with the nearest that is.
JointInputs bind_inputs(std::span<const std::string> names, const NamedColumns& columns,
                        std::string_view place);

}  // namespace tribench::forward
