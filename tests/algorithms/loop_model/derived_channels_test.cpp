// SPDX-License-Identifier: MIT
#include "problems/preparation/derived_channels.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <vector>

#include "algorithms/expression/export.hpp"
#include "algorithms/expression/text.hpp"
#include "algorithms/loop_model/loop_model.hpp"
#include "problems/kuka/planted.hpp"
#include "tests/support/paths.hpp"

namespace tribench::loop {
namespace {

namespace fs = std::filesystem;

// More than any history holds.
struct History {
  double storage[16] = {};
};

using Start = void (*)(History*);

// The exported code of a formula with its history, compiled and loaded.
class Compiled {
 public:
  Compiled(const std::string& formula, PathFrom from) {
    std::vector<std::string> names;
    const Expression parsed = parse_collecting_names(formula, names);
    const std::string code = export_code(parsed, names, CodeForm::c) +
                             c_history_code("friction", export_arguments(parsed, names), from);
    const fs::path folder = testing::scratch_folder() / "tribench_history";
    fs::create_directories(folder);
    std::ofstream(folder / "f.c") << code;
    const fs::path library = folder / fmt::format("f{}.so", static_cast<int>(from));
    const std::string command = fmt::format(
        "cc -std=c99 -O2 -ffp-contract=off -Wall -Wextra -Werror -shared -fPIC -o '{}' '{}' -lm",
        library.string(), (folder / "f.c").string());
    if (std::system(command.c_str()) != 0) return;
    handle_ = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  }
  ~Compiled() {
    if (handle_ != nullptr) dlclose(handle_);
  }
  Compiled(const Compiled&) = delete;
  Compiled& operator=(const Compiled&) = delete;

  template <typename Function>
  Function function(const char* name) const {
    return handle_ == nullptr ? nullptr : std::bit_cast<Function>(dlsym(handle_, name));
  }

 private:
  void* handle_ = nullptr;
};

bool has_compiler() { return std::system("command -v cc >/dev/null 2>&1") == 0; }

const std::string kFormula = "8*sgn_v + 14*v - 5*sgn_v*exp(-d/0.05) + 0.1*a";

// Two-tone trajectories with reversals: what the loop has found is evaluated on the channels it
// computed itself; the controller has only position, velocity, acceleration and its clock.
TEST(DerivedChannels, CCodeGivesTheLoopsOwnValuesOnMovementsWithReversals) {
  if (!has_compiler()) GTEST_SKIP() << "no C compiler";
  const Observations data = observe(kuka::make_planted({}, 3).data);
  const Eigen::MatrixXd expected =
      evaluate_columns(std::vector{parse(kFormula, data.names())}, data);
  const Compiled code(kFormula, PathFrom::position);
  const auto start = code.function<Start>("friction_start");
  const auto step =
      code.function<double (*)(History*, double, double, double, double)>("friction_step");
  ASSERT_NE(start, nullptr);
  ASSERT_NE(step, nullptr);
  History history;
  int reversals = 0;
  const std::vector<double>& v = data.find("v")->values;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    const bool starts = i == 0 || data.movement[i] != data.movement[i - 1];
    if (starts) start(&history);
    if (!starts && v[i] * v[i - 1] < 0) ++reversals;
    const double dt = starts ? 0 : data.time[i] - data.time[i - 1];
    const double friction =
        step(&history, v[i], data.find("q")->values[i], data.find("a")->values[i], dt);
    ASSERT_NEAR(friction, expected(static_cast<Eigen::Index>(i), 0), 1e-12 * 30) << "row " << i;
  }
  EXPECT_GT(reversals, 50);
}

TEST(DerivedChannels, CCodeKeepsTheSameDistanceToTheLastBitByEitherPath) {
  if (!has_compiler()) GTEST_SKIP() << "no C compiler";
  for (const PathFrom from : {PathFrom::position, PathFrom::velocity}) {
    const Compiled code("d + 0*v", from);
    const auto start = code.function<Start>("friction_start");
    const auto by_position =
        code.function<double (*)(History*, double, double, double)>("friction_step");
    const auto by_velocity = code.function<double (*)(History*, double, double)>("friction_step");
    ASSERT_NE(start, nullptr);
    History history;
    DistanceSinceReversal distance(from);
    start(&history);
    double q = 0.3;
    for (int i = 0; i < 500; ++i) {
      // Turns, standstill and exact zeros.
      const double v = i % 60 < 5 ? 0 : std::sin(0.11 * i) + 0.4 * std::cos(0.37 * i);
      const double dt = 0.001 * (1 + i % 3);
      q += v * dt;
      const double c = from == PathFrom::position ? by_position(&history, v, q, dt)
                                                  : by_velocity(&history, v, dt);
      EXPECT_EQ(c, distance.next(v, q, dt)) << i;
    }
  }
}

// However far apart the rows are, and where more come within the lag than are remembered.
TEST(DerivedChannels, AVelocityOfBeforeIsThatOfItsTime) {
  for (const double dt : {0.00002, 0.001, 0.045, 0.1, 1.0}) {
    TimeLag lag(0.06);
    double t = 0;
    EXPECT_EQ(lag.next(0.7, 0), 0.7);
    const auto rows = static_cast<int>(3 + 0.5 / dt);
    for (int i = 0; i < rows; ++i) {
      t += dt;
      EXPECT_NEAR(lag.next(0.7 + 2 * t, dt), 0.7 + 2 * std::max(0.0, t - 0.06), 1e-9) << dt;
    }
    lag.start_movement();
    EXPECT_EQ(lag.next(-0.4, dt), -0.4);
  }
}

// A reversal is seen that much later; where not every row is remembered, two rows beside.
TEST(DerivedChannels, AStepOfTheVelocityComesItsLagLater) {
  TimeLag lag(0.06);
  for (int i = 0; i < 200; ++i) {
    const double late = lag.next(i < 100 ? -1 : 1, 0.001);
    if (i < 157) EXPECT_EQ(late, -1) << i;
    if (i > 162) EXPECT_EQ(late, 1) << i;
  }
}

// A step of a first-order filter, whatever the rows' spacing.
TEST(DerivedChannels, ASignSettlesExponentiallyAfterAReversal) {
  for (const double dt : {0.001, 0.01, 0.05}) {
    SettlingSign settling(0.04);
    EXPECT_EQ(settling.next(-0.3, 0), -1) << dt;
    double t = 0;
    for (int i = 0; i < 5; ++i) {
      t += dt;
      EXPECT_NEAR(settling.next(0.2, dt), 1 - 2 * std::exp(-t / 0.04), 1e-12) << dt;
    }
    settling.start_movement();
    EXPECT_EQ(settling.next(0.5, dt), 1);
  }
}

TEST(DerivedChannels, LateChannelsAreKnownByTheirNames) {
  for (const LateChannel& late : LateChannel::all()) {
    const auto same = LateChannel::of(late.name());
    ASSERT_TRUE(same);
    EXPECT_EQ(same->recipe(), late.recipe());
  }
  EXPECT_EQ(LateChannel::of("sgn_v_lag7")->unit("rad/s"), "-");
  EXPECT_EQ(LateChannel::of("v_lag7")->unit("rad/s"), "rad/s");
  for (const char* name : {"v_lag", "v_lag0", "v_lag30_", "sgn_v_lag-20", "sgn_v", "d"}) {
    EXPECT_FALSE(LateChannel::of(name)) << name;
  }
}

TEST(DerivedChannels, VelocitiesOfBeforeAreTheSameForAClockThatCountsFrom1970) {
  const Dataset early = kuka::make_planted({}, 3).data;
  Dataset late = early;
  for (Channel& channel : late.channels) {
    if (channel.role != Role::time) continue;
    for (double& t : channel.values) t += 1.7e9;
  }
  const Observations one = observe(early);
  const Observations other = observe(late);
  for (const LateChannel& late : LateChannel::all()) {
    const std::string name = late.name();
    ASSERT_NE(one.find(name), nullptr);
    EXPECT_EQ(one.find(name)->values, other.find(name)->values) << name;
  }
}

}  // namespace
}  // namespace tribench::loop
