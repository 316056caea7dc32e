// SPDX-License-Identifier: MIT
//
// What drives the simulated joint, row by row of a recording: a torque or voltage as it was
// recorded or commanded, or a controller that sees the simulated motion.
//
// A controller is a formula over the position q and the velocity v at the row's instant and the
// columns of the data; NAME_1, NAME_2 ... is any of them one, two ... rows before. So a PD law is
// `kp*(reference - q) - kd*v`, and one that differences its encoder `kd*(q - q_1)/0.001`. Its
// output is held until the next row.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/expression.hpp"
#include "algorithms/forward_dynamics/joint_inputs.hpp"

namespace tribench::forward {

struct ControlInput {
  enum class Kind { position, velocity, column };
  Kind kind = Kind::column;
  std::size_t column = 0;     // among Controller::columns
  std::size_t rows_back = 0;  // 0: this row
};

struct Controller {
  Expression law;
  std::vector<ControlInput> inputs;
  std::optional<Expression> limit;  // the output lies between -limit and limit
  std::vector<ControlInput> limit_inputs;
  std::vector<std::string> columns;  // of the data, each once
};

// Throws Error (bad_input) with the text and the nearest name that there is. limit may be empty.
Controller parse_controller(std::string_view law, std::string_view limit,
                            const NamedColumns& columns, std::string_view place);

// One run of a controller along a recording. The controller and the columns must outlive it.
class ControlRun {
 public:
  // columns[j]: the rows of controller.columns[j].
  ControlRun(const Controller& controller, std::vector<std::span<const double>> columns);
  // The joint starts at this row; before it, it moved with this velocity.
  void begin(std::size_t row, double position, double velocity, double row_s);
  // The output at the next row in order; the first call is for the row it began at.
  double next(std::size_t row, double position, double velocity);

 private:
  double value(const Expression& formula, std::span<const ControlInput> inputs, std::size_t row);

  const Controller& controller_;
  std::vector<std::span<const double>> columns_;
  std::size_t kept_ = 1;           // rows of the past that are looked at, this one included
  std::vector<double> positions_;  // the newest first
  std::vector<double> velocities_;
  std::vector<double> point_;
  Evaluator evaluator_;
};

}  // namespace tribench::forward
