// SPDX-License-Identifier: MIT
#include "problems/preparation/observations.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "foundation/error.hpp"

namespace tribench::loop {
namespace {

Channel channel(const char* name, const char* unit, Role role) { return {name, unit, role, {}}; }

// Movements of `rows` rows; velocity(m, i) is their speed, friction 2 sgn(v) + v.
template <typename Velocity>
Dataset movements_of(int movements, int rows, Velocity velocity) {
  Dataset data;
  data.name = "test";
  data.channels = {channel("v", "rad/s", Role::velocity),
                   channel("tau", "N m", Role::friction_torque),
                   channel("q", "rad", Role::position), channel("t", "s", Role::time)};
  for (int m = 0; m < movements; ++m) {
    data.movement_names.push_back("m" + std::to_string(m));
    double q = 0;
    for (int i = 0; i < rows; ++i) {
      const double v = velocity(m, i);
      q += 0.01 * v;
      data.channels[0].values.push_back(v);
      data.channels[1].values.push_back((v > 0 ? 2 : -2) + v);
      data.channels[2].values.push_back(q);
      data.channels[3].values.push_back(0.01 * i);
      data.movement.push_back(m);
    }
  }
  return data;
}

double steady_speed(int m, int i) { return (m % 2 == 0 ? 1 : -1) * (1 + m + 0.5 * std::sin(i)); }

// Every second row of each movement, the first among them.
Dataset at_half_the_rate(const Dataset& data, int rows) {
  Dataset half;
  half.name = data.name;
  half.movement_names = data.movement_names;
  for (const Channel& one : data.channels)
    half.channels.push_back({one.name, one.unit, one.role, {}});
  for (std::size_t i = 0; i < data.rows(); ++i) {
    if (static_cast<int>(i) % rows % 2 != 0) continue;
    half.movement.push_back(data.movement[i]);
    for (std::size_t c = 0; c < data.channels.size(); ++c) {
      half.channels[c].values.push_back(data.channels[c].values[i]);
    }
  }
  return half;
}

TEST(Observations, ARecordingAtHalfTheRateIsThinnedToTheSameRows) {
  constexpr int kRows = 501;
  const auto turning = [](int m, int i) { return (2 + m) * std::sin(0.013 * i + 0.3 * m); };
  const Dataset data = movements_of(6, kRows, turning);
  // Rows are left out first, so that the rows kept stand anywhere on the clock.
  const ObservationOptions moving{.min_speed = 0.7};
  const Observations whole = observe(data, moving).thinned(700);
  const Observations half = observe(at_half_the_rate(data, kRows), moving).thinned(700);
  EXPECT_LE(whole.rows(), 700U);
  EXPECT_GT(whole.rows(), 300U);
  EXPECT_EQ(whole.target, half.target);
  EXPECT_EQ(whole.time, half.time);
  EXPECT_EQ(whole.movement, half.movement);
}

TEST(Observations, SteadyMovementsAreAveragedInEqualPartsOfWholeMovements) {
  const Dataset data = movements_of(6, 50, steady_speed);
  const Observations means = observe(data, {.steady = true});
  ASSERT_EQ(means.rows(), 6 * kRowsOfSteadyMovement);
  EXPECT_EQ(means.movements().size(), 6U);
  for (std::size_t k = 0; k < means.rows(); ++k) {
    double speed = 0;
    double friction = 0;
    for (std::size_t i = 10 * k; i < 10 * (k + 1); ++i) {
      speed += data.channels[0].values[i] / 10;
      friction += data.channels[1].values[i] / 10;
    }
    EXPECT_DOUBLE_EQ(means.find("v")->values[k], speed);
    EXPECT_DOUBLE_EQ(means.target[k], friction);
    EXPECT_EQ(means.find("sgn_v")->values[k], speed > 0 ? 1 : -1);
  }
}

// The sign that settles is that of no signal: it is averaged as it is.
TEST(Observations, SteadyMovementsAverageTheSignThatSettles) {
  Dataset data = movements_of(6, 500, steady_speed);
  data.channels.push_back(channel("a", "rad/s^2", Role::acceleration));
  for (std::size_t i = 0; i < data.rows(); ++i) {
    data.channels.back().values.push_back(std::cos(static_cast<double>(i)));
  }
  const Observations means = observe(data, {.steady = true});
  std::size_t settling = 0;
  for (const Signal& one : means.signals) {
    if (!one.name.starts_with("sgn_v_lag")) continue;
    ++settling;
    EXPECT_EQ(one.values, means.find("sgn_v")->values)
        << "in a movement of one speed it has settled";
  }
  EXPECT_GT(settling, 0U);
}

TEST(Observations, AMovementThatTurnsIsNotTakenForSteady) {
  const Dataset data = movements_of(6, 50, [](int, int i) { return i < 25 ? 1.0 : -1.0; });
  try {
    observe(data, {.steady = true});
    FAIL() << "a movement that turns was averaged";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("movement 'm0' changes its direction"));
  }
}

// Path since the velocity crossed zero, found again from the sine it is the integral of.
TEST(Observations, TheDistanceSinceAReversalIsThePathTravelledSince) {
  constexpr double kRate = 0.05;  // rad a row
  const Dataset data = movements_of(2, 400, [](int, int i) { return std::cos(kRate * i); });
  const Observations out = observe(data);
  const Signal* d = out.find("d");
  ASSERT_NE(d, nullptr);
  const std::vector<double>& q = out.find("q")->values;
  double turn = q[0];  // a movement starts at distance 0
  for (std::size_t i = 1; i < 400; ++i) {
    const double before = out.find("v")->values[i - 1];
    const double now = out.find("v")->values[i];
    // The turning point: the position's extremum, between the two rows.
    if (before * now < 0) turn = q[i] - 0.005 * now * std::abs(now) / (std::abs(now - before));
    EXPECT_NEAR(d->values[i], std::abs(q[i] - turn), 1e-12) << i;
  }
  EXPECT_EQ(d->values[400], 0);
}

// Gravity of a joint whose axis is free of it: a model's rounding, and no load.
TEST(Observations, TheTimeSinceAMovementBeganIsTheMovementsOwn) {
  Dataset data = movements_of(3, 40, steady_speed);
  for (double& t : data.channels[3].values) t += 1.7e9;
  const Observations timed = observe(data);
  const Signal* since = timed.find(Signal::kSinceStart);
  ASSERT_NE(since, nullptr);
  EXPECT_EQ(since->unit, "s");
  for (std::size_t i = 0; i < since->values.size(); ++i) {
    EXPECT_NEAR(since->values[i], 0.01 * static_cast<double>(i % 40), 1e-6) << i;
  }
  EXPECT_EQ(observe(data, {.steady = true}).find(Signal::kSinceStart), nullptr);
  EXPECT_EQ(observe(movements_of(1, 40, steady_speed)).find(Signal::kSinceStart), nullptr);
  data.channels.pop_back();
  EXPECT_EQ(observe(data).find(Signal::kSinceStart), nullptr);
}

TEST(Observations, ALoadBelowWhatTheRowsCanShowIsLeftOutAndSaid) {
  Dataset data = movements_of(6, 50, steady_speed);
  data.channels[1].role = Role::motor_torque;
  data.channels.push_back(channel("g", "N m", Role::gravity_torque));
  for (std::size_t i = 0; i < data.rows(); ++i) {
    data.channels.back().values.push_back(1e-3 * std::sin(0.1 * static_cast<double>(i)));
  }
  const Observations out = observe(data);
  EXPECT_EQ(out.find("g"), nullptr);
  ASSERT_EQ(out.withheld.size(), 2U);
  EXPECT_EQ(out.withheld[0].name, "g");
  EXPECT_THAT(out.warnings, ::testing::Contains(::testing::HasSubstr("never exceeds 0.001 N m")));
  for (double& g : data.channels.back().values) g *= 1000;
  EXPECT_NE(observe(data).find("g"), nullptr);
}

// In one direction the mean tells friction's sign, however it varies with the speed.
TEST(Observations, FrictionThatFallsWithSpeedInOneDirectionIsNotTakenForAWrongSign) {
  Dataset data = movements_of(6, 50, [](int m, int) { return 1.0 + m; });
  for (double& tau : data.channels[1].values) tau = 20 - tau;
  EXPECT_EQ(observe(data).rows(), 300U);
  for (double& tau : data.channels[1].values) tau = -tau;
  EXPECT_THROW(observe(data), Error);
}

// A sine, and a hold of the same length in which the measured velocity is noise below 0.005 rad/s.
double sine_and_hold(int m, int i) {
  if (i >= 100) return 0.005 * std::cos(2.3 * i + m);
  return std::sin(0.1 * (i + 0.5) + m);
}

// A column that is stuck, or that holds something else than the velocity.
TEST(Observations, AVelocityThatNeverChangesIsBelievedOnlyIfThePositionSaysTheSame) {
  Dataset data = movements_of(6, 50, steady_speed);
  const auto stuck_at = [&](double value) {
    Dataset stuck = data;
    stuck.channels[0].values.assign(data.rows(), value);
    return stuck;
  };
  EXPECT_THAT([&] { observe(stuck_at(0.5), {}); },
              ::testing::ThrowsMessage<Error>(::testing::HasSubstr(
                  "the velocity is 0.5 in every row, while 'q' moves against it")));
  EXPECT_THAT([&] { observe(stuck_at(0), {}); },
              ::testing::ThrowsMessage<Error>(::testing::HasSubstr("0 in every row")));
  // Forward only, with a position that trembles by less than a tenth of the way.
  Dataset one_speed = movements_of(6, 50, [](int, int) { return 1.0; });
  for (std::size_t i = 0; i < one_speed.rows(); ++i) {
    one_speed.channels[2].values[i] += 0.01 * std::sin(3.0 * static_cast<double>(i));
    one_speed.channels[1].values[i] += 0.1 * std::sin(static_cast<double>(i));
  }
  EXPECT_EQ(observe(one_speed, {}).rows(), one_speed.rows());
}

TEST(Observations, RowsAtRestAreFoundAndLeftOutWithAWord) {
  const Dataset data = movements_of(10, 200, sine_and_hold);
  const Observations moving = observe(data);
  EXPECT_LT(moving.rows(), 1010U);
  EXPECT_GT(moving.rows(), 980U);
  EXPECT_THAT(moving.warnings, ::testing::Contains(::testing::HasSubstr("50 % of the rows")));
  // The user knows better.
  EXPECT_EQ(observe(data, {.min_speed = 0.0}).rows(), 2000U);
  const Observations told = observe(data, {.min_speed = 0.5});
  EXPECT_THAT(told.warnings,
              ::testing::Not(::testing::Contains(::testing::HasSubstr("stands still"))));
}

TEST(Observations, ReversalsAndSlowMovementsAreNoRest) {
  const Dataset sines = movements_of(10, 200, [](int m, int i) { return std::sin(0.1 * i + m); });
  EXPECT_EQ(observe(sines).rows(), 2000U);
  const Dataset slow = movements_of(
      10, 200, [](int m, int i) { return (i % 40 < 20 ? 1 : -1) * (m < 9 ? 0.02 : 1.0); });
  EXPECT_EQ(observe(slow).rows(), 2000U);
}

// A joint that goes up on one side of where it hangs and down on the other, under a gravity that
// nobody declared.
TEST(Observations, ATorqueThatHoldsGravityIsNotToldToBeTurned) {
  const auto complaint = [](double sign, double gravity) {
    Dataset data = movements_of(20, 100, [](int m, int i) {
      return (m % 2 == 0 ? 0.6 : -0.6) * (1 + 0.2 * std::sin(0.7 * i + m));
    });
    data.channels[1].role = Role::motor_torque;
    for (std::size_t i = 0; i < data.rows(); ++i) {
      double& q = data.channels[2].values[i];
      q += data.movement[i] % 2 == 0 ? -0.7 : 0.7;
      data.channels[1].values[i] = sign * data.channels[1].values[i] + gravity * std::sin(q);
    }
    try {
      observe(data);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(complaint(1, 40), ::testing::HasSubstr("--gravity fit"));
  EXPECT_THAT(complaint(-1, 3), ::testing::HasSubstr("--flip-sign"));
  EXPECT_EQ(complaint(1, 0), "no error");
}

}  // namespace
}  // namespace tribench::loop
