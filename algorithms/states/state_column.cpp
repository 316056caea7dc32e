// SPDX-License-Identifier: MIT
#include "algorithms/states/state_column.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "algorithms/expression/column_kernels.hpp"
#include "algorithms/states/dual.hpp"
#include "algorithms/states/law_step.hpp"

namespace tribench {
namespace {

using namespace states;

constexpr std::size_t kBlock = 256;

// The drives of a state, one row after the other.
class Drives {
 public:
  Drives(const StateDeclaration& state, const MotionRows& rows)
      : velocity_(rows.columns[state.drives[0]]),
        load_(state.drives.size() > 1 ? rows.columns[state.drives[1]] : nullptr) {}

  StateDrive at(std::size_t row) const {
    return {velocity_[row], load_ == nullptr ? 1.0 : load_[row]};
  }
  const double* velocity() const { return velocity_; }

 private:
  const double* velocity_;
  const double* load_;
};

std::size_t run_end(const MotionRows& rows, std::size_t run) {
  return run + 1 < rows.starts.size() ? rows.starts[run + 1] : rows.rows();
}

// Row by row: for the laws whose step is cheap.
void column_by_steps(const StateDeclaration& state, const MotionRows& rows, const Drives& drives,
                     std::span<double> out) {
  for (std::size_t run = 0; run < rows.starts.size(); ++run) {
    const std::size_t first = rows.starts[run];
    StateMemory memory = state_at_rest(state.law, drives.at(first));
    out[first] = memory.z;
    for (std::size_t r = first + 1; r < run_end(rows, run); ++r) {
      advance_by_law<double, double>(state.law, state.parameters, memory, drives.at(r - 1),
                                     drives.at(r), rows.time[r] - rows.time[r - 1]);
      out[r] = memory.z;
    }
  }
}

// Bristles with exponentials: what does not depend on z is computed for a block of rows at once.
// Bits are those of law_step.hpp, since each row takes the same operations.
class BristleColumn {
 public:
  BristleColumn(const StateDeclaration& state, const MotionRows& rows, const Drives& drives)
      : law_(state.law), p_(state.parameters), rows_(rows), v_(drives.velocity()) {}

  void write(std::span<double> out) {
    for (std::size_t run = 0; run < rows_.starts.size(); ++run) {
      const std::size_t end = run_end(rows_, run);
      StateMemory memory;
      out[rows_.starts[run]] = memory.z;
      for (std::size_t first = rows_.starts[run] + 1; first < end; first += kBlock) {
        const std::size_t count = std::min(kBlock, end - first);
        prepare(first, count);
        for (std::size_t i = 0; i < count; ++i) {
          step(first + i, i, memory);
          out[first + i] = memory.z;
        }
      }
    }
  }

 private:
  void prepare(std::size_t first, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t r = first + i;
      const double seconds = rows_.time[r] - rows_.time[r - 1];
      const double speed = 0.5 * (v_[r - 1] + v_[r]);
      travel_[i] = speed * seconds;
      if (law_ != StateLaw::dahl) {
        const double ratio = speed / p_[2];
        level_[i] = -(ratio * ratio);
      }
      decay_[i] = seconds;
    }
    if (law_ == StateLaw::dahl) {
      std::fill_n(level_.data(), count, p_[0]);
    } else {
      columns::exp(level_.data(), level_.data(), count);
      for (std::size_t i = 0; i < count; ++i) level_[i] = p_[0] + (p_[1] - p_[0]) * level_[i];
    }
    if (law_ == StateLaw::gms) {
      for (std::size_t i = 0; i < count; ++i) {
        decay_[i] = -(decay_[i] * p_[0] / (level_[i] * p_[3]));
      }
    } else {
      for (std::size_t i = 0; i < count; ++i) decay_[i] = -(std::abs(travel_[i]) / level_[i]);
    }
    columns::exp(decay_.data(), decay_.data(), count);
    if (law_ == StateLaw::gms) return;
    for (std::size_t i = 0; i < count; ++i) {
      pull_[i] = sign_of(travel_[i]) * level_[i] * (1.0 - decay_[i]);
    }
  }

  void step(std::size_t row, std::size_t i, StateMemory& memory) const {
    const double v0 = v_[row - 1];
    const double v1 = v_[row];
    if ((v0 < 0 && v1 > 0) || (v0 > 0 && v1 < 0)) [[unlikely]] {
      advance_by_law<double, double>(law_, p_, memory, {v0, 1}, {v1, 1},
                                     rows_.time[row] - rows_.time[row - 1]);
      return;
    }
    const double most = law_ == StateLaw::dahl ? p_[0] : std::max(p_[0], p_[1]);
    if (law_ == StateLaw::gms) {
      advance_gms_part(most, memory, travel_[i], level_[i], [&] { return decay_[i]; });
    } else {
      memory.z = held(decay_[i] * memory.z + pull_[i], most);
    }
  }

  StateLaw law_;
  std::span<const double> p_;
  const MotionRows& rows_;
  const double* v_;
  std::array<double, kBlock> travel_;
  std::array<double, kBlock> level_;  // the curve
  std::array<double, kBlock> decay_;
  std::array<double, kBlock> pull_;
};

// Lag and warmth, the same way.
class LagColumn {
 public:
  LagColumn(const StateDeclaration& state, const MotionRows& rows, const Drives& drives)
      : law_(state.law), time_constant_(state.parameters[0]), rows_(rows), drives_(drives) {}

  void write(std::span<double> out) {
    for (std::size_t run = 0; run < rows_.starts.size(); ++run) {
      const std::size_t start = rows_.starts[run];
      const std::size_t end = run_end(rows_, run);
      double z = state_at_rest(law_, drives_.at(start)).z;
      out[start] = z;
      for (std::size_t first = start + 1; first < end; first += kBlock) {
        const std::size_t count = std::min(kBlock, end - first);
        prepare(first, count);
        for (std::size_t i = 0; i < count; ++i) out[first + i] = z = next(i, z);
      }
    }
  }

 private:
  double followed(std::size_t row) const {
    const StateDrive drive = drives_.at(row);
    return law_ == StateLaw::warmth ? power_of(drive) : drive.velocity;
  }

  void prepare(std::size_t first, std::size_t count) {
    x_[0] = followed(first - 1);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t r = first + i;
      x_[i + 1] = followed(r);
      steps_[i] = (rows_.time[r] - rows_.time[r - 1]) / time_constant_;
      decay_[i] = -steps_[i];
    }
    columns::exp(decay_.data(), decay_.data(), count);
    for (std::size_t i = 0; i < count; ++i) {
      ramp_[i] = (x_[i + 1] - x_[i]) * ((1.0 - decay_[i]) / steps_[i]);
    }
  }

  double next(std::size_t i, double z) const {
    if (!(steps_[i] > 0)) return z;
    return between(x_[i + 1] + decay_[i] * (z - x_[i]) - ramp_[i], z, x_[i], x_[i + 1]);
  }

  StateLaw law_;
  double time_constant_;
  const MotionRows& rows_;
  const Drives& drives_;
  std::array<double, kBlock + 1> x_;  // what is followed, from the row before the block on
  std::array<double, kBlock> steps_;  // in time constants
  std::array<double, kBlock> decay_;
  std::array<double, kBlock> ramp_;
};

}  // namespace

void state_column(const StateDeclaration& state, const MotionRows& rows, std::span<double> out) {
  const Drives drives(state, rows);
  switch (state.law) {
    case StateLaw::dahl:
    case StateLaw::lugre:
    case StateLaw::gms:
      return BristleColumn(state, rows, drives).write(out);
    case StateLaw::lag:
    case StateLaw::warmth:
      return LagColumn(state, rows, drives).write(out);
    default:
      return column_by_steps(state, rows, drives, out);
  }
}

StateSensitivities state_sensitivities(const StateDeclaration& state, const MotionRows& rows) {
  constexpr std::size_t kMost = 4;  // parameters of a law; one more place is the start's
  using Number = Dual<kMost + 1>;
  const std::size_t count = state.parameters.size();
  std::vector<Number> p(state.parameters.begin(), state.parameters.end());
  for (std::size_t k = 0; k < count; ++k) p[k].by[k] = 1;
  StateSensitivities result;
  result.z.resize(rows.rows());
  result.start_influence.resize(rows.rows());
  result.by_parameter.assign(count, std::vector<double>(rows.rows()));
  const Drives drives(state, rows);
  for (std::size_t run = 0; run < rows.starts.size(); ++run) {
    BasicStateMemory<Number> memory;
    memory.z = state_at_rest(state.law, drives.at(rows.starts[run])).z;
    memory.z.by[kMost] = 1;
    for (std::size_t r = rows.starts[run]; r < run_end(rows, run); ++r) {
      if (r > rows.starts[run]) {
        advance_by_law<Number, double>(state.law, p, memory, drives.at(r - 1), drives.at(r),
                                       rows.time[r] - rows.time[r - 1]);
      }
      result.z[r] = memory.z.value;
      result.start_influence[r] = memory.z.by[kMost];
      for (std::size_t k = 0; k < count; ++k) result.by_parameter[k][r] = memory.z.by[k];
    }
  }
  return result;
}

}  // namespace tribench
