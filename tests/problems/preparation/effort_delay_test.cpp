// SPDX-License-Identifier: MIT
#include "problems/preparation/effort_delay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "foundation/random.hpp"
#include "problems/preparation/recording.hpp"
#include "problems/preparation/segments.hpp"
#include "problems/reading/csv.hpp"
#include "tests/problems/preparation/raw_log.hpp"

namespace tribench {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::RawLogPlan;
using testing::RawSample;

// The torque of `rows` before (later where negative) in each row.
std::vector<RawSample> late(std::vector<RawSample> samples, int rows) {
  const std::vector<RawSample> truth = samples;
  const auto last = static_cast<int>(truth.size()) - 1;
  for (int i = 0; i <= last; ++i) {
    samples[static_cast<std::size_t>(i)].torque =
        truth[static_cast<std::size_t>(std::clamp(i - rows, 0, last))].torque;
  }
  return samples;
}

Dataset table_of(const std::vector<RawSample>& samples) {
  Dataset data;
  data.movement_names = {"run"};
  data.channels = {{"t", "s", Role::time, {}},
                   {"q", "rad", Role::position, {}},
                   {"v", "rad/s", Role::velocity, {}},
                   {"a", "rad/s^2", Role::acceleration, {}},
                   {"tau", "N m", Role::motor_torque, {}}};
  for (const RawSample& sample : samples) {
    const double row[] = {sample.time, sample.position, sample.velocity, sample.acceleration,
                          sample.torque};
    for (std::size_t k = 0; k < 5; ++k) data.channels[k].values.push_back(row[k]);
    data.movement.push_back(0);
  }
  return data;
}

std::optional<EffortDelay> delay_in(const std::vector<RawSample>& samples) {
  const Dataset data = table_of(samples);
  return effort_delay(data, pieces_of(data.channels[0].values, data.movement, {}));
}

TEST(EffortDelay, IsFoundWhereTheTorqueComesLate) {
  RawLogPlan plan;
  plan.load = 0.08;
  plan.seconds = 400;
  for (const int rows : {10, 3, -4}) {
    const std::optional<EffortDelay> delay = delay_in(late(simulate(plan), rows));
    ASSERT_TRUE(delay) << rows;
    EXPECT_NEAR(delay->value, rows * plan.step, std::max(4 * delay->error, 5e-4)) << rows;
    EXPECT_LT(delay->error, 1e-3);
  }
}

// A joint without gravity that moves gently tells a delay of 4 ms by its gear's ripple.
TEST(EffortDelay, IsToldByTheGearsRipple) {
  std::vector<double> errors;
  std::vector<double> blind_errors;
  for (std::uint64_t seed = 1; seed <= 7; ++seed) {
    RawLogPlan plan;
    plan.seed = seed;
    plan.gravity = 0;
    plan.ripple = 0.4;
    const Dataset data = table_of(late(simulate(plan), 2));
    const std::vector<RowRange> pieces = pieces_of(data.channels[0].values, data.movement, {});
    const std::optional<EffortDelay> delay = effort_delay(data, pieces, 100);
    ASSERT_TRUE(delay) << seed;
    EXPECT_NEAR(delay->value, 0.004, 4 * delay->error) << seed;
    errors.push_back(delay->error);
    const std::optional<EffortDelay> blind = effort_delay(data, pieces);
    blind_errors.push_back(blind ? blind->error : INFINITY);
  }
  const auto median = [](std::vector<double> values) {
    std::ranges::nth_element(values, values.begin() + 3);
    return values[3];
  };
  EXPECT_LT(median(errors), 5e-4);
  EXPECT_GT(median(blind_errors), 2 * median(errors));
}

// The torque as a first-order filter of so many seconds records it.
std::vector<RawSample> filtered(std::vector<RawSample> samples, double seconds) {
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double share = 1 - std::exp((samples[i - 1].time - samples[i].time) / seconds);
    samples[i].torque = samples[i - 1].torque + share * (samples[i].torque - samples[i - 1].torque);
  }
  return samples;
}

struct Kinematics {
  double position = 0;
  double velocity = 0;
  double acceleration = 0;
};

// A joint with gravity at 500 Hz that follows a smooth motion.
template <typename Path>
std::vector<RawSample> follow(std::uint64_t seed, const Path& path) {
  RandomStream random = RandomStream(seed).split("smooth motion");
  std::vector<RawSample> samples(40'000);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    RawSample& sample = samples[i];
    sample.time = 0.002 * static_cast<double>(i);
    const Kinematics motion = path(sample.time);
    sample.position = motion.position;
    sample.velocity = motion.velocity;
    sample.acceleration = motion.acceleration;
    sample.torque = 1.2 * motion.acceleration + 15 * std::sin(motion.position + 0.3) +
                    (motion.velocity > 0 ? 5 : -5) + 8 * motion.velocity + 0.15 * random.normal();
  }
  return samples;
}

Kinematics sines(double t) {
  Kinematics motion;
  for (const auto& [size, pace, phase] : {std::tuple(0.5, 0.41, 0.2), std::tuple(0.3, 1.13, 1.0),
                                          std::tuple(0.2, 2.7, 2.2), std::tuple(0.08, 5.3, 0.7)}) {
    motion.position += size * std::sin(pace * t + phase);
    motion.velocity += size * pace * std::cos(pace * t + phase);
    motion.acceleration -= size * pace * pace * std::sin(pace * t + phase);
  }
  return motion;
}

// From 0.03 to 0.5 Hz, ever smaller.
Kinematics sweep(double t) {
  const auto place = [](double time) {
    const double phase = 2 * std::numbers::pi * (0.03 * time + 0.47 / 160 * time * time);
    return 1.08 / (1 + time / 40) * std::sin(phase);
  };
  constexpr double kStep = 1e-3;
  return {place(t), (place(t + kStep) - place(t - kStep)) / (2 * kStep),
          (place(t + kStep) - 2 * place(t) + place(t - kStep)) / (kStep * kStep)};
}

TEST(EffortDelay, AFilterIsToldFromABusAndWithItsTime) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const std::vector<RawSample> samples = follow(seed, sines);
    const std::optional<EffortDelay> filter = delay_in(filtered(samples, 0.02));
    ASSERT_TRUE(filter) << seed;
    EXPECT_TRUE(filter->is_filter) << seed;
    EXPECT_NEAR(filter->value, 0.019, 0.0005) << seed;  // the rows' half step is not the filter's
    const std::optional<EffortDelay> bus = delay_in(late(samples, 10));
    ASSERT_TRUE(bus) << seed;
    EXPECT_FALSE(bus->is_filter) << seed;
    EXPECT_NEAR(bus->value, 0.02, 0.0005) << seed;
  }
}

// Where the motion itself changes through the recording, friction that does so explains a late
// torque nearly as well.
TEST(EffortDelay, ASweepTellsAFilterThatExplainsItAlone) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const std::vector<RawSample> samples = follow(seed, sweep);
    const std::optional<EffortDelay> none = delay_in(samples);
    EXPECT_FALSE(none && is_surely_late(*none)) << seed;
    const std::optional<EffortDelay> filter = delay_in(filtered(samples, 0.02));
    ASSERT_TRUE(filter) << seed;
    EXPECT_NEAR(filter->value, 0.019, 0.002) << seed;
  }
}

// Bristles of 0.004 rad that lag behind each reversal are no delay of the torque.
TEST(EffortDelay, IsNoneWhereFrictionAloneLags) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    RawLogPlan plan;
    plan.seed = seed;
    plan.stribeck = 1;
    const std::optional<EffortDelay> delay = delay_in(simulate(plan));
    if (delay) {
      EXPECT_LT(delay->value, std::max(5 * delay->error, 0.5 * plan.step)) << seed;
    }
  }
}

// Friction that is half as large again at first, as that of cold grease.
std::vector<RawSample> running_in(std::vector<RawSample> samples) {
  for (RawSample& sample : samples) {
    const double more = 4 * std::exp(-sample.time / 60);
    const double sign = (sample.velocity > 0 ? 1 : 0) - (sample.velocity < 0 ? 1 : 0);
    sample.torque += more * (sign + 2 * sample.velocity);
  }
  return samples;
}

TEST(EffortDelay, IsToldBesideFrictionThatChangesThroughTheRecording) {
  for (const std::uint64_t seed : {2U, 3U, 4U}) {
    RawLogPlan plan;
    plan.seed = seed;
    plan.seconds = 200;
    for (const int rows : {0, 3}) {
      const std::optional<EffortDelay> delay = delay_in(late(running_in(simulate(plan)), rows));
      ASSERT_TRUE(delay) << seed;
      EXPECT_NEAR(delay->value, rows * plan.step, 4 * delay->error) << seed;
      EXPECT_LT(delay->error, 1e-3) << seed;
    }
  }
}

TEST(EffortDelay, NothingWithoutAnAcceleration) {
  Dataset data = table_of(simulate(RawLogPlan()));
  std::erase_if(data.channels, [](const Channel& one) { return one.role == Role::acceleration; });
  EXPECT_FALSE(effort_delay(data, pieces_of(data.channels[0].values, data.movement, {})));
}

TEST(EffortDelay, AChannelIsTakenFromBetweenItsRows) {
  const std::vector<double> time = {0, 1, 2, 3, 10, 11};
  const std::vector<double> values = {0, 10, 20, 40, 7, 9};
  const std::vector<RowRange> pieces = {{0, 4}, {4, 6}};
  const Shifted late = shifted_by(time, values, pieces, 0.5);
  EXPECT_THAT(late.lost, ::testing::ElementsAre(0, 0, 0, 1, 0, 1));
  EXPECT_DOUBLE_EQ(late.values[2], 30);
  EXPECT_DOUBLE_EQ(late.values[4], 8);
  const Shifted early = shifted_by(time, values, pieces, -0.5);
  EXPECT_THAT(early.lost, ::testing::ElementsAre(1, 0, 0, 0, 1, 0));
  EXPECT_DOUBLE_EQ(early.values[3], 30);
}

PreparedRecording prepared(const std::vector<RawSample>& samples, const RawLogPlan& plan,
                           std::optional<double> gear_ratio = {}) {
  DataOptions options;
  options.torque_constant = TorqueConstant{plan.torque_constant, false};
  options.drive.gear_ratio = gear_ratio;
  return prepare(parse_csv(raw_table(samples, plan, {}), "log.csv", {}), options);
}

// Root mean square of the prepared position less the true one of so many seconds before.
double misfit(const PreparedRecording& log, const std::vector<RawSample>& truth, double before) {
  const std::vector<double>& t = log.data.find(Role::time)->values;
  const std::vector<double>& q = log.data.find(Role::position)->values;
  const double step = truth[1].time - truth[0].time;
  double squares = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const auto row = static_cast<std::size_t>(std::lround((t[i] - truth[0].time - before) / step));
    squares += std::pow(q[i] - truth.at(row).position, 2);
  }
  return std::sqrt(squares / static_cast<double>(t.size()));
}

// The log of an encoder whose current comes 20 ms late says so: beside each current stands the
// motion that it belongs to.
TEST(EffortDelay, ARawLogsLateCurrentStandsBesideItsMotion) {
  RawLogPlan plan;
  plan.seconds = 400;
  const std::vector<RawSample> samples = simulate(plan);
  const PreparedRecording fine = prepared(samples, plan);
  EXPECT_THAT(fine.notes, Not(Contains(HasSubstr("the motion that it belongs to"))));
  const PreparedRecording mended = prepared(late(samples, 10), plan);
  EXPECT_THAT(mended.notes, Contains(HasSubstr("ms after the motion that it belongs to")));
  EXPECT_LT(misfit(mended, samples, 0.02), 0.3 * misfit(mended, samples, 0));
}

// Friction's step at a reversal is no longer one behind a filter.
TEST(EffortDelay, RowsOverWhichAFilterSmearsAReversalAreLeftOut) {
  constexpr double kFilter = 0.02;  // s
  const std::vector<RawSample> samples = filtered(follow(4, sines), kFilter);
  const PreparedRecording mended = prepared(samples, RawLogPlan());
  EXPECT_THAT(mended.notes, Contains(HasSubstr("as through a first-order filter")));
  EXPECT_THAT(mended.notes, Contains(HasSubstr("smear friction's step")));
  const std::vector<double>& t = mended.data.find(Role::time)->values;
  std::size_t row = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (samples[i].velocity * samples[i - 1].velocity > 0) continue;
    // The friction's step comes through from here on.
    while (row < t.size() && t[row] <= samples[i].time + 0.002) ++row;
    if (row < t.size()) {
      EXPECT_GT(t[row] - samples[i].time, 6 * kFilter) << samples[i].time;
    }
  }
}

std::vector<RawSample> every_fifth(const std::vector<RawSample>& samples) {
  std::vector<RawSample> some;
  for (std::size_t i = 0; i < samples.size(); i += 5) some.push_back(samples[i]);
  return some;
}

// A ripple is several rows long where the joint is fast: less than a step of delay turns it, and
// a torque taken from between its rows would lose of it.
TEST(EffortDelay, LessThanAStepCountsAndTheTorqueStaysAsItWasMeasured) {
  RawLogPlan plan;
  plan.seconds = 120;
  plan.ripple = 0.6;
  const std::vector<RawSample> samples = every_fifth(late(simulate(plan), 2));
  const PreparedRecording mended = prepared(samples, plan, 100);
  EXPECT_THAT(mended.notes, Contains(HasSubstr("ms after the motion that it belongs to")));
  const std::vector<double>& t = mended.data.find(Role::time)->values;
  const std::vector<double>& torque = mended.data.find(Role::motor_torque)->values;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const auto row = static_cast<std::size_t>(std::lround(t[i] / (5 * plan.step)));
    ASSERT_NEAR(torque[i], samples.at(row).torque, 1e-3);
  }
}

}  // namespace
}  // namespace tribench
