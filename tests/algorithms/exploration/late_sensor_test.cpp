// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "algorithms/exploration/assessment.hpp"
#include "algorithms/exploration/explorer.hpp"
#include "algorithms/exploration/foresight.hpp"
#include "foundation/sign.hpp"
#include "problems/joint_simulation/world.hpp"

namespace tribench::loop {
namespace {

// A joint that lacks nothing, in movements with a rest after each.
Observations movements_with_rests() {
  simulation::World world({8, simulation::WorldLevel::easy, simulation::WorldKind::none});
  const double speed = world.limits().speed_rad_s;
  Dataset all;
  for (int round = 0; round < 6; ++round) {
    for (const double part : {0.4, 0.9}) {
      for (const double direction : {1.0, -1.0}) {
        PlannedMovement one = constant_movement(direction * part * speed, -0.8, 0.8, 1);
        one.rest = 2;
        append_movement(all, world.execute(one, "the plan"));
      }
    }
  }
  return observe(all);
}

double weight_of(const Observations& rows, const std::string& verdict) {
  const ExplanationSpace space(rows.thinned(300), {}, 1);
  Assessor assessor(space, 0.01);
  assessor.add(rows);
  assessor.look();
  return assessor.look().weight_of(verdict);
}

// The oil warms and cools, the thermometer on the housing follows in tenths of a degree.
TEST(Assessor, WhatLivesInAnOilAheadOfItsThermometerIsATemperature) {
  constexpr double kLate_s = 30;
  Observations rows = movements_with_rests();
  const std::vector<double>& v = rows.find("v")->values;
  Signal* sensor = nullptr;
  for (Signal& signal : rows.signals) {
    if (signal.name == "T") sensor = &signal;
  }
  ASSERT_NE(sensor, nullptr);
  double housing = 30;
  for (std::size_t i = 0; i < rows.rows(); ++i) {
    const double oil = 30 + 8 * std::sin(rows.time[i] / 25);
    const double since = i == 0 ? 0 : rows.time[i] - rows.time[i - 1];
    housing += (oil - housing) * -std::expm1(-since / kLate_s);
    sensor->values[i] = std::round(10 * housing) / 10;
    rows.target[i] += 0.1 * (oil - 30) * sign(v[i]);
  }
  add_warming(rows, EarlierMovements::remembered);
  EXPECT_GT(weight_of(rows, "temperature"), 0.8);
}

}  // namespace
}  // namespace tribench::loop
