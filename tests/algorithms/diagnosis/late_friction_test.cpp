// SPDX-License-Identifier: MIT
//
// Friction that settles on its value late, as behind a first-order filter.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "foundation/random.hpp"
#include "problems/preparation/observations.hpp"
#include "problems/reading/csv.hpp"
#include "tests/algorithms/diagnosis/planted_diagnosis.hpp"

namespace tribench::loop {
namespace {

constexpr double kRowStep_s = 0.01;
constexpr double kLateNoise = 0.3;

// 24 movements of two tones each, 8 s; 5 N m of Coulomb and 2 of viscous friction.
Observations late_friction(double time_constant_s, std::uint64_t seed) {
  RandomStream random(seed);
  std::string text = "movement,time_s,position_rad,velocity_rad_s,acceleration_rad_s2,";
  text += "friction_torque_Nm\n";
  for (int m = 0; m < 24; ++m) {
    const double w = random.uniform(0.8, 2);
    const double w2 = w * random.uniform(1.3, 2.2);
    const double phase = random.uniform(0, 2 * std::numbers::pi);
    double late = 0;
    for (int i = 0; i < 800; ++i) {
      const double t = i * kRowStep_s;
      const double q = std::sin(w * t + phase) + 0.4 * std::sin(w2 * t);
      const double v = w * std::cos(w * t + phase) + 0.4 * w2 * std::cos(w2 * t);
      const double a = -w * w * std::sin(w * t + phase) - 0.4 * w2 * w2 * std::sin(w2 * t);
      const double friction = (v > 0 ? 5 : -5) + 2 * v;
      late = i == 0 ? friction
                    : friction + (late - friction) * std::exp(-kRowStep_s / time_constant_s);
      text += fmt::format("{},{},{},{},{},{}\n", m, 10 * m + t, q, v, a,
                          late + kLateNoise * random.normal());
    }
  }
  return observe(parse_csv(text, "late.csv").data);
}

// By times alone it was lag and presliding, which had to draw what no fixed time has.
TEST(LateFriction, OfAFilterIsALagAndNoPreslidingBeside) {
  for (const double time_constant_s : {0.03, 0.05, 0.08}) {
    const Diagnosis diagnosis =
        diagnose(late_friction(time_constant_s, 17), coulomb_viscous_base, {});
    EXPECT_EQ(families(diagnosis), std::vector<std::string>{"lag"}) << time_constant_s;
    EXPECT_EQ(diagnosis.verdict, Verdict::effects) << time_constant_s;
  }
}

// Strokes of half a sine one way and the other, every third of three halves, as one motion.
Observations late_strokes(std::uint64_t seed) {
  constexpr double kStroke_s = 0.004;
  constexpr double kTimeConstant_s = 0.03;
  RandomStream random(seed);
  std::string text = "movement,time_s,position_rad,velocity_rad_s,acceleration_rad_s2,";
  text += "friction_torque_Nm\n";
  double begin = 0;
  for (int m = 0; m < 60; ++m) {
    const double s = m % 2 == 0 ? 1 : -1;
    const double w = random.uniform(1, 3);
    const double size = random.uniform(0.2, 0.5);
    const int rows = static_cast<int>((m % 3 == 0 ? 3 : 1) * std::numbers::pi / w / kStroke_s);
    double late = -11 * s;
    for (int i = 1; i < rows; ++i) {
      const double t = i * kStroke_s;
      const double v = s * size * w * std::sin(w * t);
      const double friction = (v > 0 ? 11 : -11) + 6 * v;
      late = friction + (late - friction) * std::exp(-kStroke_s / kTimeConstant_s);
      text += fmt::format("{},{},{},{},{},{}\n", m, begin + t, -s * size * std::cos(w * t), v,
                          s * size * w * w * std::cos(w * t), late + 0.4 * random.normal());
    }
    begin += rows * kStroke_s;
  }
  return observe(parse_csv(text, "late.csv").data);
}

// Late friction of strokes is where they begin: with a memory that began anew there it was
// presliding in another shape, a lag and a curve of the speed.
TEST(LateFriction, GoesOnFromStrokeToStroke) {
  for (const std::uint64_t seed : {17U, 18U}) {
    const Diagnosis diagnosis = diagnose(late_strokes(seed), coulomb_viscous_base, {});
    EXPECT_EQ(families(diagnosis), std::vector<std::string>{"lag"}) << seed;
    EXPECT_EQ(diagnosis.verdict, Verdict::effects) << seed;
  }
}

}  // namespace
}  // namespace tribench::loop
