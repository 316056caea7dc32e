// SPDX-License-Identifier: MIT
//
// The judge's error in motion: where a problem declares what that needs, and nowhere else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "algorithms/expression/text.hpp"
#include "harness/cell_task.hpp"
#include "harness/judge.hpp"
#include "problems/measured/entries.hpp"
#include "problems/measured/manifest.hpp"
#include "reports/record/record_csv.hpp"
#include "tests/support/paths.hpp"

namespace tribench {
namespace {

// An inertia of 2 with a Coulomb friction of 3 under a torque of 5, from rest: v = t.
Problem parabola(bool declares_motion) {
  Dataset data;
  data.name = "parabola";
  data.movement_names = {"one"};
  data.channels = {{"t", "s", Role::time, {}},
                   {"q", "rad", Role::position, {}},
                   {"v", "rad/s", Role::velocity, {}},
                   {"a", "rad/s^2", Role::acceleration, {}},
                   {"tau", "N m", Role::motor_torque, {}}};
  Table table;
  table.columns.resize(3);
  for (int i = 0; i <= 100; ++i) {
    const double t = 0.01 * i;
    const double row[] = {t, t * t / 2, t, 1, 5};
    for (std::size_t c = 0; c < 5; ++c) data.channels[c].values.push_back(row[c]);
    data.movement.push_back(0);
    table.columns[0].push_back(t);
    table.columns[1].push_back(t > 0 ? 1 : 0);
    table.columns[2].push_back(1);
    table.target.push_back(5);
    table.movement.push_back(0);
  }
  Problem problem;
  problem.name = "test/parabola";
  problem.dataset = "test";
  problem.target = "tau";
  problem.inputs = {{"v", "rad/s", Role::velocity, 0, 1, {}},
                    {"sgn_v", "-", Role::velocity_sign, 0, 1, 0},
                    {"a", "rad/s^2", Role::acceleration, 0, 1, {}}};
  problem.stages = {{"fit", {0, 1, 2}, table}};
  problem.test = table;
  if (declares_motion) problem.motion = [data] { return MotionCase{data, {}}; };
  return problem;
}

Record judged(const Problem& problem, const char* formula) {
  Record record;
  judge_formula(problem, {parse(formula, problem.input_names()), {}}, record);
  return record;
}

TEST(MotionJudge, MeasuresHowFarTheFormulasMotionIsOff) {
  const Problem problem = parabola(true);
  EXPECT_LT(judged(problem, "3*sgn_v + 2*a").motion_error, 1e-9);
  // a = 1.5: 0.25 t^2 further, over rows 1 .. 100 at 0.01 s.
  EXPECT_NEAR(judged(problem, "2*sgn_v + 2*a").motion_error, 0.25 * 1e-4 * 338350 / 100, 1e-9);
  EXPECT_TRUE(std::isnan(judged(problem, "3*sgn_v + 2").motion_error));    // holds no inertia
  EXPECT_TRUE(std::isnan(judged(problem, "3*sgn_v - 2*a").motion_error));  // none that is positive
}

TEST(MotionJudge, AProblemWithoutItHasARecordAsBefore) {
  const Record without = judged(parabola(false), "2*sgn_v + 2*a");
  EXPECT_TRUE(std::isnan(without.motion_error));
  EXPECT_THAT(print_result({without, {}, {}}),
              ::testing::Not(::testing::HasSubstr("motion_error")));
  const Record with = judged(parabola(true), "2*sgn_v + 2*a");
  const CellResult back = parse_result(print_result({with, {}, {}}));
  EXPECT_EQ(back.record.motion_error, with.motion_error);
  EXPECT_THAT(results_csv({with}), ::testing::HasSubstr(",motion_error,"));
}

TEST(MotionJudge, MeasuredSetsDeclareItInTheirManifests) {
  const auto data = testing::shared_data();
  if (!data) GTEST_SKIP() << testing::kNoSharedData;
  const measured::Manifest& emps = measured::find_manifest(measured::shipped_manifests(), "emps");
  for (const measured::ProblemPlan& plan : emps.problems) {
    const Problem problem = measured::make_measured_problem(emps, plan, *data, 1);
    ASSERT_TRUE(problem.motion) << plan.name;
    const double published =
        judged(problem,
               "95.1089*acceleration_m_s2 + 203.5034*velocity_m_s + 20.3935*direction - 3.1648")
            .motion_error;
    const double frictionless = judged(problem, "95.1089*acceleration_m_s2").motion_error;
    // Of strokes of 0.24 m; with force pulses that took no part in the published fit, more.
    EXPECT_LT(published, plan.name == "emps/pulses" ? 6e-3 : 3e-3) << plan.name;
    EXPECT_GT(published, 1e-4) << plan.name;
    EXPECT_GT(frictionless, 10 * published) << plan.name;
  }
  const measured::Manifest& bam =
      measured::find_manifest(measured::shipped_manifests(), "bam-xl330");
  const Problem pendulum = measured::make_measured_problem(bam, bam.problems.front(), *data, 1);
  const double error =
      judged(pendulum,
             "0.0689*acceleration_rad_s2 + 0.42*velocity_rad_s + 0.2*sgn_velocity_rad_s + "
             "gravity_voltage_V + 0.12*sgn_velocity_rad_s*abs(gravity_voltage_V)")
          .motion_error;
  EXPECT_LT(error, 0.15);
  EXPECT_GT(error, 0.005);
}

}  // namespace
}  // namespace tribench
