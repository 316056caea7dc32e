// SPDX-License-Identifier: MIT
#include "algorithms/states/state_column.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "foundation/random.hpp"

namespace tribench {
namespace {

struct Motion {
  std::vector<double> time;
  std::vector<double> velocity;
  std::vector<double> load;
  std::vector<std::size_t> starts;
  std::vector<const double*> columns;

  MotionRows rows() {
    columns = {velocity.data(), load.data()};
    return {columns, time, starts};
  }
};

// Uneven steps, reversals, a break.
Motion make_motion(std::size_t rows) {
  Motion motion;
  RandomStream random(3);
  double t = 0;
  for (std::size_t r = 0; r < rows; ++r) {
    t += 0.004 + 0.002 * random.uniform() + (r == rows / 2 ? 3.0 : 0.0);
    motion.time.push_back(t);
    motion.velocity.push_back(0.02 * std::sin(5 * t) + 0.002 * random.normal());
    motion.load.push_back(std::cos(t));
  }
  motion.starts = {0, rows / 2};
  return motion;
}

std::vector<StateDeclaration> all_states() {
  return {{"a", StateLaw::lag, {0}, {0.02}},
          {"b", StateLaw::dahl, {0}, {3e-4}},
          {"c", StateLaw::lugre, {0}, {2e-4, 3e-4, 0.01}},
          {"d", StateLaw::slip, {0}, {4e-4}},
          {"e", StateLaw::gms, {0}, {2e-4, 3e-4, 0.01, 0.02}},
          {"f", StateLaw::backlash, {0, 1}, {1e-3, 0.003}},
          {"g", StateLaw::warmth, {0, 1}, {1.5}}};
}

TEST(StateColumn, HasTheBitsOfTheSingleSteps) {
  Motion motion = make_motion(2000);
  ASSERT_EQ(motion.starts.size(), 2U);
  const MotionRows rows = motion.rows();
  for (const StateDeclaration& state : all_states()) {
    SCOPED_TRACE(state_law_info(state.law).name);
    std::vector<double> column(rows.rows());
    state_column(state, rows, column);
    const auto drive = [&](std::size_t r) {
      return StateDrive{motion.velocity[r], state.drives.size() > 1 ? motion.load[r] : 1.0};
    };
    StateMemory memory;
    for (std::size_t r = 0; r < rows.rows(); ++r) {
      if (r == motion.starts[0] || r == motion.starts[1]) {
        memory = state_at_rest(state.law, drive(r));
      } else {
        advance(state.law, std::span<const double>(state.parameters), memory, drive(r - 1),
                drive(r), motion.time[r] - motion.time[r - 1]);
      }
      ASSERT_EQ(column[r], memory.z) << "row " << r;
    }
  }
}

TEST(StateColumn, SensitivitiesAreTheSlopesOfTheColumn) {
  Motion motion = make_motion(600);
  const MotionRows rows = motion.rows();
  for (const StateDeclaration& state : all_states()) {
    SCOPED_TRACE(state_law_info(state.law).name);
    const StateSensitivities found = state_sensitivities(state, rows);
    std::vector<double> column(rows.rows());
    state_column(state, rows, column);
    EXPECT_EQ(found.z, column);
    for (std::size_t k = 0; k < state.parameters.size(); ++k) {
      const double h = 1e-6 * state.parameters[k];
      std::vector<double> up(rows.rows());
      std::vector<double> down(rows.rows());
      StateDeclaration moved = state;
      moved.parameters[k] = state.parameters[k] + h;
      state_column(moved, rows, up);
      moved.parameters[k] = state.parameters[k] - h;
      state_column(moved, rows, down);
      double largest = 0;
      for (const double slope : found.by_parameter[k]) largest = std::max(largest, std::abs(slope));
      ASSERT_GT(largest, 0);
      // Where a step holds or lets go only between the two, the difference has no slope.
      std::size_t off = 0;
      for (std::size_t r = 0; r < rows.rows(); ++r) {
        const double slope = (up[r] - down[r]) / (2 * h);
        off += std::abs(slope - found.by_parameter[k][r]) > 1e-4 * largest ? 1U : 0U;
      }
      EXPECT_LE(off, rows.rows() / 100) << state_law_info(state.law).parameters[k].name;
    }
  }
}

TEST(StateColumn, ForgetsItsStartWithTheDistance) {
  Motion motion;
  for (int r = 0; r < 100; ++r) {
    motion.time.push_back(0.01 * r);
    motion.velocity.push_back(0.01);
    motion.load.push_back(1);
  }
  motion.starts = {0};
  const auto found = state_sensitivities({"z", StateLaw::dahl, {0}, {1e-3}}, motion.rows());
  EXPECT_EQ(found.start_influence[0], 1);
  EXPECT_NEAR(found.start_influence[99], std::exp(-0.0099 / 1e-3), 1e-12);
}

}  // namespace
}  // namespace tribench
