// SPDX-License-Identifier: MIT
//
// What other commands take of a loop.json: gravity that no column declared, and the box.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "foundation/random.hpp"
#include "tests/harness/cli/loop_runs.hpp"
#include "tests/support/paths.hpp"

namespace tribench {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::run_tribench;

// Sines of a pendulum of inertia 1.5, a fifth of its gravity torque 9 sin q lost as friction.
std::string pendulum(const testing::TemporaryFolder& folder) {
  std::string text = "movement,time_s,position_rad,velocity_rad_s,acceleration_rad_s2,drive\n";
  RandomStream random(key_of("pendulum"));
  for (int m = 0; m < 20; ++m) {
    const double rate = 1.2 + 0.05 * m;
    const double size = 0.6 + 0.04 * m;
    for (int i = 0; i < 250; ++i) {
      const double t = 0.02 * i;
      const double q = 0.5 - size * std::cos(rate * t);
      const double v = size * rate * std::sin(rate * t);
      const double a = size * rate * rate * std::cos(rate * t);
      const double g = 9 * std::sin(q);
      const double sign = v > 0 ? 1 : v < 0 ? -1 : 0;
      const double torque =
          1.5 * a + 3 * v + (2 + 0.2 * std::abs(g)) * sign + g + 0.1 * random.normal();
      text += fmt::format("{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", m, t, q, v, a, torque);
    }
  }
  testing::write_text(folder / "pendulum.csv", text);
  return (folder / "pendulum.csv").string();
}

TEST(LoopFormula, GravityThatWasFittedGoesWithTheModel) {
  const testing::TemporaryFolder folder;
  const std::string data = pendulum(folder);
  const std::string out = (folder / "out").string();
  const testing::ProgramRun run =
      run_tribench({"loop", data, "--roles", "drive=motor_torque[N m]", "--out", out, "--json"});
  ASSERT_EQ(run.status, 0) << run.errors;
  const Json loop = Json::parse(run.output);
  EXPECT_EQ(testing::families(loop), std::vector<std::string>{"load_coulomb"});
  const std::string model = out + "/loop.json";

  // For a controller: over what it measures.
  const testing::ProgramRun code = run_tribench({"export", model, "--as", "c"});
  ASSERT_EQ(code.status, 0) << code.errors;
  EXPECT_THAT(code.output, HasSubstr("double friction(double v, double a, double q)"));
  EXPECT_THAT(code.output, HasSubstr("v in [-"));
  EXPECT_THAT(testing::read_text(out + "/loop.html"),
              HasSubstr("double friction(double v, double a, double q)"));
  // An input that a box names stays one.
  const testing::ProgramRun given =
      run_tribench({"export", model, "--as", "c", "--box", "v=-2:2,a=-4:4,q=-3:3,g=-9:9"});
  EXPECT_THAT(given.output, HasSubstr("double q, double g)")) << given.errors;
  const testing::ProgramRun mujoco = run_tribench({"export", model, "--as", "mujoco"});
  EXPECT_THAT(mujoco.output, HasSubstr("frictionloss=")) << mujoco.errors;

  const testing::ProgramRun motion =
      run_tribench({"simulate", model, data, "--roles", "drive=motor_torque[N m]", "--horizon",
                    "0.5", "--json"});
  ASSERT_EQ(motion.status, 0) << motion.errors;
  EXPECT_THAT(motion.output, HasSubstr("*sin(q)"));
  EXPECT_LT(Json::parse(motion.output)["training"]["mean_position"].get<double>(), 0.01);
}

TEST(LoopFormula, AModelInAmpereIsNoSimulatorsTorque) {
  const testing::TemporaryFolder folder;
  testing::write_text(folder / "loop.json",
                      R"({"formula": "2*sgn_v + v", "target": {"name": "i", "unit": "A"},
"symbols": [{"name": "v", "low": -1, "high": 1}, {"name": "sgn_v", "low": -1, "high": 1}]})");
  const std::string model = (folder / "loop.json").string();
  EXPECT_EQ(run_tribench({"export", model, "--as", "c"}).status, 0);
  const testing::ProgramRun urdf = run_tribench({"export", model, "--as", "urdf"});
  EXPECT_EQ(urdf.status, 2);
  EXPECT_THAT(urdf.errors, HasSubstr("--torque-constant"));
}

}  // namespace
}  // namespace tribench
