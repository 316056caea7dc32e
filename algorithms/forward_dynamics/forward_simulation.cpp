// SPDX-License-Identifier: MIT
#include "algorithms/forward_dynamics/forward_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "foundation/order_statistics.hpp"

namespace tribench::forward {
namespace {

constexpr double kFarOff = 1000;  // movement's ranges: no sensible motion goes there

struct Scales {
  double range = 0;
  double top_speed = 0;
  double reach = 0;
};

Scales scales_of(const MovementRows& rows) {
  const auto [low, high] = std::ranges::minmax(rows.position);
  Scales scales;
  scales.range = high - low;
  for (const double v : rows.velocity) scales.top_speed = std::max(scales.top_speed, std::abs(v));
  const double seconds = rows.time.back() - rows.time.front();
  // A movement that hardly moves: what its speed would make of its time.
  if (scales.range <= 0) scales.range = scales.top_speed * seconds;
  if (scales.top_speed <= 0) scales.top_speed = seconds > 0 ? scales.range / seconds : 0;
  if (scales.range <= 0) scales.range = 1;
  if (scales.top_speed <= 0) scales.top_speed = 1;
  scales.reach = kFarOff * (scales.range + std::max(std::abs(low), std::abs(high)));
  return scales;
}

// One movement being simulated.
class Run {
 public:
  Run(const JointModel& model, const Controller* controller, const MovementRows& rows,
      const SimulationOptions& options)
      : rows_(rows),
        options_(options),
        scales_(scales_of(rows)),
        equation_(model, "the model"),
        integrator_(equation_, tolerances()),
        recorded_(rows.recorded.size()) {
    if (controller != nullptr) control_.emplace(*controller, rows.control);
    around_ = [this](double since_begin_s, JointInstant& at) { surround(since_begin_s, at); };
  }

  SimulatedMotion go() {
    const std::size_t count = rows_.time.size();
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    motion_.position.assign(count, nothing);
    motion_.velocity.assign(count, nothing);
    motion_.drive.assign(count, nothing);
    for (std::size_t row = 0; row < count; ++row) {
      if (row == 0 || is_due(row)) {
        start_at(row);
      } else {
        drive(row, integrator_.state().position, integrator_.state().velocity);
      }
      motion_.position[row] = integrator_.state().position;
      motion_.velocity[row] = integrator_.state().velocity;
      motion_.drive[row] = now_;
      if (row + 1 == count) break;
      motion_.status = integrator_.advance(interval(), around_, scales_.reach);
      if (motion_.status != MotionStatus::complete) break;
    }
    motion_.counts = integrator_.counts();
    return std::move(motion_);
  }

 private:
  Tolerances tolerances() const {
    return {options_.tolerance * scales_.range, options_.tolerance * scales_.top_speed,
            options_.longest_step_s};
  }

  double interval() const { return rows_.time[row_ + 1] - rows_.time[row_]; }

  bool is_due(std::size_t row) const {
    return options_.horizon_s > 0 &&
           rows_.time[row] - rows_.time[motion_.starts.back()] >= options_.horizon_s * (1 - 1e-9);
  }

  void start_at(std::size_t row) {
    motion_.starts.push_back(row);
    if (control_) {
      const std::size_t next = std::min(row + 1, rows_.time.size() - 1);
      control_->begin(row, rows_.position[row], rows_.velocity[row],
                      rows_.time[next] - rows_.time[next - 1]);
    }
    drive(row, rows_.position[row], rows_.velocity[row]);
    integrator_.begin(rows_.time[row], rows_.position[row], rows_.velocity[row], around_);
  }

  // What drives the joint from this row on.
  void drive(std::size_t row, double position, double velocity) {
    row_ = row;
    now_ = control_ ? control_->next(row, position, velocity) : rows_.drive[row];
  }

  void surround(double since_begin_s, JointInstant& at) {
    const std::size_t next = row_ + 1 < rows_.time.size() ? row_ + 1 : row_;
    const double part = options_.hold || next == row_ ? 0 : since_begin_s / interval();
    const auto between = [&](std::span<const double> column) {
      return column[row_] + part * (column[next] - column[row_]);
    };
    at.drive = control_ ? now_ : between(rows_.drive);
    at.is_connected = rows_.connected.empty() || rows_.connected[row_] != 0;
    for (std::size_t j = 0; j < recorded_.size(); ++j) recorded_[j] = between(rows_.recorded[j]);
    at.recorded = recorded_;
  }

  const MovementRows& rows_;
  const SimulationOptions& options_;
  Scales scales_;
  JointEquation equation_;
  JointIntegrator integrator_;
  std::optional<ControlRun> control_;
  JointIntegrator::Surroundings around_;
  std::vector<double> recorded_;
  SimulatedMotion motion_;
  std::size_t row_ = 0;
  double now_ = 0;
};

}  // namespace

SimulatedMotion simulate_motion(const JointModel& model, const Controller* controller,
                                const MovementRows& rows, const SimulationOptions& options) {
  return Run(model, controller, rows, options).go();
}

MotionErrors motion_errors(const MovementRows& rows, const SimulatedMotion& motion) {
  MotionErrors errors;
  if (motion.status != MotionStatus::complete) return errors;
  double sum_q = 0, squares_q = 0, largest = 0, sum_v = 0, squares_v = 0;
  std::size_t next_start = 0;
  for (std::size_t row = 0; row < rows.time.size(); ++row) {
    if (next_start < motion.starts.size() && motion.starts[next_start] == row) {
      ++next_start;
      continue;
    }
    const double of_q = std::abs(motion.position[row] - rows.position[row]);
    const double of_v = std::abs(motion.velocity[row] - rows.velocity[row]);
    sum_q += of_q;
    squares_q += of_q * of_q;
    largest = std::max(largest, of_q);
    sum_v += of_v;
    squares_v += of_v * of_v;
    ++errors.rows;
  }
  if (errors.rows == 0) return errors;
  const auto n = static_cast<double>(errors.rows);
  errors.mean_position = sum_q / n;
  errors.rms_position = std::sqrt(squares_q / n);
  errors.largest_position = largest;
  errors.mean_velocity = sum_v / n;
  errors.rms_velocity = std::sqrt(squares_v / n);
  return errors;
}

std::vector<RowStretch> stretches_without_gaps(std::span<const double> time, double factor) {
  std::vector<RowStretch> stretches;
  if (time.size() < 2) return stretches;
  std::vector<double> steps;
  for (std::size_t i = 1; i < time.size(); ++i) steps.push_back(time[i] - time[i - 1]);
  const double usual = median(steps);
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= time.size(); ++i) {
    if (i < time.size() && steps[i - 1] > 0 && steps[i - 1] <= factor * usual) continue;
    if (i - begin >= 2) stretches.push_back({begin, i});
    begin = i;
  }
  return stretches;
}

}  // namespace tribench::forward
