// SPDX-License-Identifier: MIT
//
// The laws against an integration of their differential equations that shares nothing with them:
// Runge and Kutta's fourth-order step, ten thousand to a second.
#include "algorithms/states/state_law.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "foundation/error.hpp"
#include "foundation/random.hpp"

namespace tribench {
namespace {

// A velocity that turns, stands still for a while and runs in one direction with ripples.
double velocity_at(double t) {
  const double moving = std::clamp((std::abs(t - 2.1) - 0.1) / 0.05, 0.0, 1.0);
  const double drift = 0.012 * std::clamp((t - 3) / 0.1, 0.0, 1.0);
  return moving * (0.02 * std::sin(2.1 * t) + 0.011 * std::sin(13 * t) + drift);
}

double load_at(double t) { return 3 * std::cos(0.7 * t); }

using Rate = std::function<double(double z, double v, double load)>;

// z at the ends of `steps` steps of dt, by small steps of RK4; `limit` is applied after each.
std::vector<double> reference(double z, const Rate& rate, double dt, std::size_t steps,
                              double limit = INFINITY) {
  constexpr int kSmall = 50;
  std::vector<double> ends;
  for (std::size_t k = 0; k < steps; ++k) {
    for (int i = 0; i < kSmall; ++i) {
      const double h = dt / kSmall;
      const double t = static_cast<double>(k) * dt + i * h;
      const auto f = [&](double at, double x) { return rate(x, velocity_at(at), load_at(at)); };
      const double k1 = f(t, z);
      const double k2 = f(t + h / 2, z + h / 2 * k1);
      const double k3 = f(t + h / 2, z + h / 2 * k2);
      const double k4 = f(t + h, z + h * k3);
      z = std::clamp(z + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), -limit, limit);
    }
    ends.push_back(z);
  }
  return ends;
}

std::vector<double> ours(StateLaw law, const std::vector<double>& parameters, double dt,
                         std::size_t steps) {
  StateDrive from{velocity_at(0), load_at(0)};
  StateMemory memory = state_at_rest(law, from);
  std::vector<double> ends;
  for (std::size_t k = 1; k <= steps; ++k) {
    const double t = static_cast<double>(k) * dt;
    const StateDrive to{velocity_at(t), load_at(t)};
    advance(law, std::span<const double>(parameters), memory, from, to, dt);
    ends.push_back(memory.z);
    from = to;
  }
  return ends;
}

double worst(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

constexpr double kStep = 0.002;
constexpr std::size_t kSteps = 2500;  // 5 s

TEST(StateLaw, LagAgreesWithRungeKutta) {
  const auto rate = [](double z, double v, double) { return (v - z) / 0.03; };
  EXPECT_LT(worst(ours(StateLaw::lag, {0.03}, kStep, kSteps),
                  reference(velocity_at(0), rate, kStep, kSteps)),
            2e-4 * 0.03);
}

TEST(StateLaw, DahlAgreesWithRungeKutta) {
  const double d = 4e-4;
  const auto rate = [d](double z, double v, double) { return v - std::abs(v) * z / d; };
  EXPECT_LT(worst(ours(StateLaw::dahl, {d}, kStep, kSteps), reference(0, rate, kStep, kSteps)),
            2e-3 * d);
}

TEST(StateLaw, LuGreAgreesWithRungeKutta) {
  const auto rate = [](double z, double v, double) {
    const double g = 3e-4 + 2e-4 * std::exp(-(v / 0.008) * (v / 0.008));
    return v - std::abs(v) * z / g;
  };
  EXPECT_LT(worst(ours(StateLaw::lugre, {3e-4, 5e-4, 0.008}, kStep, kSteps),
                  reference(0, rate, kStep, kSteps)),
            5e-3 * 5e-4);
}

TEST(StateLaw, MaxwellSlipAgreesWithRungeKutta) {
  const auto rate = [](double, double v, double) { return v; };
  EXPECT_LT(
      worst(ours(StateLaw::slip, {6e-4}, kStep, kSteps), reference(0, rate, kStep, kSteps, 6e-4)),
      2e-3 * 6e-4);
}

TEST(StateLaw, BacklashIsPushedByItsLoad) {
  const auto rate = [](double, double v, double load) { return v + 0.004 * load; };
  EXPECT_LT(worst(ours(StateLaw::backlash, {1e-3, 0.004}, kStep, kSteps),
                  reference(0, rate, kStep, kSteps, 1e-3)),
            2e-3 * 1e-3);
}

TEST(StateLaw, WarmthFollowsThePower) {
  const auto rate = [](double z, double v, double load) { return (std::abs(v * load) - z) / 0.8; };
  EXPECT_LT(worst(ours(StateLaw::warmth, {0.8}, kStep, kSteps), reference(0, rate, kStep, kSteps)),
            1e-5);
}

// Written down as the paper has it: an element sticks (F' = k v) until |F| reaches its share of the
// Stribeck curve, then F' = sgn(v) C (1 - F / s(v)), until v turns.
TEST(StateLaw, GeneralisedMaxwellSlipAgreesWithItsTwoRegimes) {
  const double limit = 3e-4;
  const double attraction = 0.02;
  const auto level = [&](double v) { return limit + 2e-4 * std::exp(-(v / 0.01) * (v / 0.01)); };
  std::vector<double> ends;
  double z = 0;
  bool slips = false;
  constexpr int kSmall = 200;
  for (std::size_t k = 0; k < kSteps; ++k) {
    for (int i = 0; i < kSmall; ++i) {
      const double h = kStep / kSmall;
      const double v = velocity_at(static_cast<double>(k) * kStep + (i + 0.5) * h);
      if (v == 0) continue;
      const double s = v > 0 ? 1 : -1;
      if (slips && z * s < 0) slips = false;
      if (!slips && (z + v * h) * s >= level(v)) slips = true;
      z += h * (slips ? s * (limit / attraction) * (1 - z * s / level(v)) : v);
    }
    ends.push_back(z);
  }
  const auto found = ours(StateLaw::gms, {limit, 5e-4, 0.01, attraction}, kStep, kSteps);
  // A step in which the element starts to slip is taken at one speed: a hundredth of its limit.
  EXPECT_LT(worst(found, ends), 0.02 * 5e-4);
}

// Whatever the step and the velocity, in double and in float.
template <typename T>
void expect_range_is_kept(StateLaw law, const std::vector<T>& parameters) {
  RandomStream random(17);
  const std::vector<double> wide(parameters.begin(), parameters.end());
  const std::vector<StateRange> drives(state_law_info(law).most_drives, StateRange{-1, 1});
  const StateRange range = state_range(law, wide, drives);
  const auto draw = [&] {
    const double size = std::pow(10.0, -12 * random.uniform());
    return BasicDrive<T>{static_cast<T>(random.chance(0.5) ? size : -size),
                         static_cast<T>(2 * random.uniform() - 1)};
  };
  BasicDrive<T> from = draw();
  BasicStateMemory<T> memory = state_at_rest(law, from);
  for (int k = 0; k < 20000; ++k) {
    const BasicDrive<T> to = draw();
    const auto dt = static_cast<T>(std::pow(10.0, 3 - 9 * random.uniform()));
    advance(law, std::span<const T>(parameters), memory, from, to, dt);
    ASSERT_GE(memory.z, static_cast<T>(range.low));
    ASSERT_LE(memory.z, static_cast<T>(range.high));
    from = to;
  }
}

TEST(StateLaw, NeverLeavesItsRange) {
  const std::vector<std::vector<double>> parameters = {
      {0.01}, {1e-4}, {1e-4, 3e-4, 0.01}, {1e-4}, {1e-4, 3e-4, 0.01, 0.02}, {1e-3, -0.1}, {5}};
  for (const StateLawInfo& law : state_laws()) {
    const std::vector<double>& p = parameters.at(static_cast<std::size_t>(law.law));
    SCOPED_TRACE(law.name);
    expect_range_is_kept<double>(law.law, p);
    expect_range_is_kept<float>(law.law, std::vector<float>(p.begin(), p.end()));
  }
}

TEST(StateLaw, SlidesSteadilyOnItsCurve) {
  const std::vector<double> p = {2e-4, 3e-4, 0.01};
  StateMemory memory;
  const StateDrive slow{0.005, 1};
  for (int k = 0; k < 1000; ++k) {
    advance(StateLaw::lugre, std::span<const double>(p), memory, slow, slow, 0.01);
  }
  EXPECT_NEAR(memory.z, 2e-4 + 1e-4 * std::exp(-0.25), 1e-15);
  EXPECT_NEAR(state_rate(StateLaw::lugre, p, memory, slow), 0, 1e-12);
}

TEST(StateLaw, RefusesWhatIsNoState) {
  EXPECT_THROW(find_state_law("lugra"), Error);
  EXPECT_THROW(check_state({"z", StateLaw::dahl, {0}, {-1e-4}}, 1), Error);
  EXPECT_THROW(check_state({"z", StateLaw::dahl, {1}, {1e-4}}, 1), Error);
  EXPECT_THROW(check_state({"z", StateLaw::lugre, {0}, {1e-4}}, 1), Error);
  EXPECT_THROW(check_state({"z", StateLaw::backlash, {0}, {1e-4, 0.1}}, 1), Error);
  EXPECT_NO_THROW(check_state({"z", StateLaw::backlash, {0, 1}, {1e-4, -0.1}}, 2));
}

}  // namespace
}  // namespace tribench
