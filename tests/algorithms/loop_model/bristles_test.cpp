// SPDX-License-Identifier: MIT
//
// The truth here is integrated in steps of a fifth of a millisecond along a sum of sines whose
// strokes are often too short to bend the bristles all the way.
#include "algorithms/loop_model/bristles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "algorithms/states/state_column.hpp"
#include "foundation/random.hpp"

namespace tribench::loop {
namespace {

constexpr double kStep_s = 2e-4;

struct Recording {
  Dataset data;
  std::vector<double> clean;
};

// Friction after kStep_s more at v, called in order.
using Force = std::function<double(double v)>;

enum class Between { relaxed, as_left };

// One movement from rest after the other, every row_s a row.
Recording record(const Force& fresh, double noise, double row_s, Between between = Between::relaxed,
                 const std::string& draw = "bristles") {
  constexpr int kMovements = 12;
  Force force = fresh;
  RandomStream random(key_of(draw));
  std::vector<std::vector<double>> columns(6);
  Recording out;
  for (int m = 0; m < kMovements; ++m) {
    if (between == Between::relaxed) force = fresh;
    out.data.movement_names.push_back("m" + std::to_string(m));
    std::array<double, 3> amplitude{};
    std::array<double, 3> rate{};
    for (int k = 0; k < 3; ++k) {
      rate[k] = random.uniform(0.6, 5);
      amplitude[k] = random.uniform(0.03, 0.2) / rate[k];
    }
    double q = random.uniform(-1, 1);
    const auto stride = std::lround(row_s / kStep_s);
    for (long i = 0; i < 50'000; ++i) {
      const double t = static_cast<double>(i) * kStep_s;
      double v = 0;
      double a = 0;
      for (int k = 0; k < 3; ++k) {  // from standstill
        v += amplitude[k] * rate[k] * std::sin(rate[k] * t);
        a += amplitude[k] * rate[k] * rate[k] * std::cos(rate[k] * t);
      }
      q += v * kStep_s;
      const double friction = force(v);
      if (i % stride != 0 || v == 0) continue;
      out.clean.push_back(friction);
      const double seen = friction + noise * random.normal();
      const std::array<double, 5> row = {20.0 * m + t, q, v, a, seen};
      for (std::size_t k = 0; k < row.size(); ++k) columns[k].push_back(row[k]);
      out.data.movement.push_back(m);
    }
  }
  out.data.name = "bristles";
  out.data.channels = {{"time_s", "s", Role::time, columns[0]},
                       {"position_rad", "rad", Role::position, columns[1]},
                       {"velocity_rad_s", "rad/s", Role::velocity, columns[2]},
                       {"acceleration_rad_s2", "rad/s^2", Role::acceleration, columns[3]},
                       {"friction_torque_Nm", "N m", Role::friction_torque, columns[4]}};
  return out;
}

double sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

// Bristles of 60 N m/rad that slide from 0.03 rad on, beside Coulomb and viscous friction.
Force dahl(double damping = 0) {
  return [damping, z = 0.0](double v) mutable {
    const double rate = v - std::abs(v) * z / 0.03;
    z += rate * kStep_s;
    return 60 * z + damping * rate + 2 * sign(v) + 3 * v;
  };
}

// 50 N m/rad together; the last slides from 0.08 rad on.
Force four_elements() {
  return [z = std::array<double, 4>{}](double v) mutable {
    constexpr std::array<double, 4> kLimits = {0.012, 0.02, 0.045, 0.08};
    constexpr std::array<double, 4> kStiffness = {20, 14, 10, 6};
    double force = 2 * sign(v) + 3 * v;
    for (std::size_t k = 0; k < 4; ++k) {
      z[k] = std::clamp(z[k] + v * kStep_s, -kLimits[k], kLimits[k]);
      force += kStiffness[k] * z[k];
    }
    return force;
  };
}

// As the loop finds it.
LoopModel with_presliding(const Observations& data) {
  LoopModel model;
  model.base = coulomb_viscous_base(data);
  model.coefficients =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model.base.linear_terms.size()));
  const std::vector<EffectFamily>& all = builtin_effects();
  const auto family = static_cast<std::size_t>(
      std::ranges::find(all, "hysteresis", &EffectFamily::name) - all.begin());
  std::vector<std::string> missing;
  model.add(instantiate(all[family], family, data, {}, missing).at(2));
  return model;
}

std::optional<Bristles> fitted(const Observations& data) {
  const LoopModel model = with_presliding(data);
  return fit_bristles(model, presliding_family(model, data).value(), data,
                      std::vector<char>(data.rows(), 1), false);
}

TEST(Bristles, OfDahlHaveTheirStiffnessThoughStrokesAreShort) {
  const Observations data = observe(record(dahl(), 0.2, 0.02).data, {.min_speed = 0});
  const std::optional<Bristles> found = fitted(data);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->law, BristleLaw::dahl);
  EXPECT_EQ(found->start, BristleStart::relaxed);
  EXPECT_NEAR(found->stiffness, 60, 3);
  EXPECT_NEAR(found->sliding, 0.03, 0.0015);
  EXPECT_LT(found->low, 60);
  EXPECT_GT(found->high, 60);
  EXPECT_LT(found->high / found->low, 1.2);
}

TEST(Bristles, LeaveNoMoreThanTheNoise) {
  const Recording recording = record(dahl(), 0.2, 0.02);
  const Observations data = observe(recording.data, {.min_speed = 0});
  const Eigen::VectorXd predicted = predict(fitted(data).value(), data);
  double sum = 0;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    sum += std::abs(predicted[static_cast<Eigen::Index>(i)] - recording.clean[i]);
  }
  EXPECT_LT(sum / static_cast<double>(data.rows()), 0.02);
}

// The joint's brake holds them bent from one movement to the next.
TEST(Bristles, StandWhereTheMovementBeforeLeftThem) {
  const Observations data =
      observe(record(dahl(), 0.2, 0.02, Between::as_left).data, {.min_speed = 0});
  const std::optional<Bristles> found = fitted(data);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->start, BristleStart::as_left);
  EXPECT_NEAR(found->stiffness, 60, 3);
}

// Only the way counts: eight rows of nine lost say the same.
TEST(Bristles, AreTheSameWhereRowsAreLeftOut) {
  const Observations all = observe(record(dahl(), 0.1, 0.01).data, {.min_speed = 0});
  std::vector<char> keep(all.rows(), 0);
  for (std::size_t i = 0; i < keep.size(); i += 9) keep[i] = 1;
  const Observations few = all.select(keep);  // with the distances as they were
  const double whole = fitted(all).value().stiffness;
  EXPECT_NEAR(fitted(few).value().stiffness, whole, 0.06 * whole);
}

TEST(Bristles, OfLuGreHaveADampingBeside) {
  const Observations data = observe(record(dahl(4), 0.05, 0.01).data, {.min_speed = 0});
  const std::optional<Bristles> found = fitted(data);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->law, BristleLaw::lugre);
  EXPECT_NEAR(found->stiffness, 60, 3);
  EXPECT_NEAR(found->damping, 4, 0.6);
}

TEST(Bristles, OfFourElementsAreToldFromDahls) {
  const Observations data = observe(record(four_elements(), 0.1, 0.02).data, {.min_speed = 0});
  const std::optional<Bristles> found = fitted(data);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->law, BristleLaw::maxwell_slip);
  EXPECT_NEAR(found->stiffness, 50, 5);
  EXPECT_GT(found->elements.size(), 1U);
}

// Under loud noise several laws say nearly the same of the rows and not of the stiffness.
TEST(Bristles, HaveAnIntervalThatCountsWhichLawItIs) {
  constexpr int kDraws = 16;
  int covered = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const Recording recording =
        record(four_elements(), 2, 0.02, Between::relaxed, "draw " + std::to_string(draw));
    const Observations data = observe(recording.data, {.min_speed = 0});
    const std::optional<Bristles> found = fitted(data);
    ASSERT_TRUE(found);
    covered += found->low < 50 && 50 < found->high ? 1 : 0;
  }
  EXPECT_GE(covered, kDraws - 1);
}

// A joint that dwelt needs more to break away, and less after: no spring does that.
TEST(Bristles, AreNotSaidWhereFrictionFallsAfterAReversal) {
  const auto sticky = [way = 0.0, before = 0.0](double v) mutable {
    way = v * before < 0 ? 0 : way + std::abs(v) * kStep_s;
    before = v;
    return sign(v) * (2 + 1.5 * std::exp(-way / 0.02));
  };
  const Observations data = observe(record(sticky, 0.1, 0.02).data, {.min_speed = 0});
  EXPECT_FALSE(fitted(data));
}

// What is printed, exported and simulated is what was fitted.
TEST(Bristles, AreTheSameAsAFormulaWithAState) {
  const Observations data = observe(record(dahl(), 0.1, 0.01).data, {.min_speed = 0});
  const Bristles found = fitted(data).value();
  const StatefulFormula formula = formula_of(found, data);
  ASSERT_EQ(formula.states.size(), 1U);
  const std::vector<std::string> names = data.names();
  EXPECT_TRUE(print_stateful(formula, names).starts_with("z = dahl(v, sliding=0.0"));
  std::vector<const double*> columns;
  for (const Signal& signal : data.signals) columns.push_back(signal.values.data());
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    if (i == 0 || data.movement[i] != data.movement[i - 1]) starts.push_back(i);
  }
  std::vector<double> z(data.rows());
  state_column(formula.states[0], {columns, data.find("t")->values, starts}, z);
  Bristles alone = found;
  alone.others.coefficients.setZero();
  const Eigen::VectorXd force = predict(alone, data);
  for (std::size_t i = 0; i < data.rows(); ++i) {
    ASSERT_NEAR(found.stiffness * z[i], force[static_cast<Eigen::Index>(i)], 0.03);
  }
}

}  // namespace
}  // namespace tribench::loop
