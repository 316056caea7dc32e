// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "tests/support/run_program.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using testing::ProgramRun;

ProgramRun run_export(const std::string& arguments) {
  return testing::run_tribench_in_shell("export " + arguments);
}

// An attribute's number in a well-formed file, as an XML parser of others reads it; "broken" else.
std::string attribute(const std::string& xml, const std::string& path, const std::string& name) {
  const testing::TemporaryFolder folder;
  testing::write_text(folder / "file.xml", xml);
  return testing::output_of(fmt::format(
      "python3 -c \"import xml.etree.ElementTree as t; "
      "print(t.parse('{}').getroot().find('{}').get('{}'), end='')\" 2>/dev/null || echo broken",
      (folder / "file.xml").string(), path, name));
}

double after(const std::string& text, const std::string& words) {
  const std::size_t at = text.find(words);
  return at == std::string::npos ? -1e9 : std::stod(text.substr(at + words.size()));
}

TEST(SimulatorExport, AStraightFrictionIsTakenAsItIsAndTheFilesAreWellFormed) {
  const std::string straight = "'8*sgn_v + 14*v' --box 'v=-2:2' --inertia 1 --joint elbow --as ";
  const ProgramRun mujoco = run_export(straight + "mujoco");
  EXPECT_EQ(mujoco.status, 0) << mujoco.output;
  const std::string joint = "default/default[@class=\\\"elbow\\\"]/joint";
  EXPECT_NEAR(std::stod(attribute(mujoco.output, joint, "frictionloss")), 8, 1e-6);
  EXPECT_NEAR(std::stod(attribute(mujoco.output, joint, "damping")), 14, 1e-6);
  EXPECT_LT(after(mujoco.output, "off by "), 1e-6);
  EXPECT_LT(after(mujoco.output, "2 s: "), 1e-4);
  const ProgramRun urdf = run_export(straight + "urdf");
  EXPECT_NEAR(std::stod(attribute(urdf.output, "joint[@name=\\\"elbow\\\"]/dynamics", "friction")),
              8, 1e-6);
  EXPECT_NEAR(std::stod(attribute(urdf.output, "joint/dynamics", "damping")), 14, 1e-6);
  const ProgramRun isaac = run_export(straight + "isaac");
  EXPECT_NEAR(after(isaac.output, "staticFrictionEffort = "), 8, 1e-4);
  EXPECT_NEAR(after(isaac.output, "viscousFrictionCoefficient = "), 14 * std::numbers::pi / 180,
              1e-6);
}

TEST(SimulatorExport, SaysWhatIsLostInTorque) {
  // An offset, a load and a break-away level: none of it fits into two numbers.
  const ProgramRun offset = run_export("'8*sgn_v + 14*v + 0.5' --as mujoco --box 'v=-2:2'");
  EXPECT_NEAR(after(offset.output, "off by "), 0.5, 1e-3);
  EXPECT_NEAR(after(offset.output, "and any offset: "), 0.5, 1e-3);
  const ProgramRun load =
      run_export("'8*sgn_v + 0.1*abs(g)*sgn_v + 14*v' --as mujoco --box 'v=-2:2,g=-60:60'");
  // About the mean over the box, which the friction loss holds: at its middle there is no load.
  EXPECT_NEAR(after(load.output, "the dependence on g: "), 6 / std::sqrt(12.0), 0.02);
  EXPECT_NEAR(std::stod(attribute(load.output, "default/default/joint", "frictionloss")), 11, 0.1);
  // The box's corner is no sample.
  EXPECT_NEAR(after(load.output, "on average, "), 3, 0.1);
  const ProgramRun place = run_export(
      "'sin(q)*9.81 + 2*sgn_v' --as mujoco --box 'v=-2:2,g=-10:10,q=-1:1,a=-5:5' "
      "--inertia 1");
  EXPECT_NEAR(after(place.output, "on average, "), 9.81 * std::sin(1.0), 1e-3);
  EXPECT_THAT(place.output, Not(HasSubstr("the difference between the directions")));
  EXPECT_NEAR(after(place.output, "the dependence on q: "),
              9.81 * std::sqrt(0.5 - std::sin(2.0) / 4), 0.01);
  EXPECT_THAT(place.output, HasSubstr("motion, all other inputs at the middle of the box: with"));
  const ProgramRun level =
      run_export("'sgn_v*(8 + 2*exp(-(v/0.05)^2)) + 14*v' --as urdf --box v=-2:2");
  EXPECT_NEAR(after(level.output, "in place of "), 10, 1e-3);
  const ProgramRun isaac =
      run_export("'sgn_v*(8 + 2*exp(-(v/0.05)^2)) + 14*v' --as isaac --box v=-2:2");
  EXPECT_NEAR(after(isaac.output, "staticFrictionEffort = "), 10, 1e-3);
  EXPECT_LT(after(isaac.output, "dynamicFrictionEffort = "), 8.4);
}

TEST(SimulatorExport, MakesAnArmatureOfTheAccelerationAndSettlesStates) {
  const ProgramRun armature =
      run_export("'8*sgn_v + 14*v + 1.1*a' --as mujoco --box 'v=-2:2,a=-5:5'");
  EXPECT_NEAR(std::stod(attribute(armature.output, "default/default/joint", "armature")), 1.1,
              1e-6);
  const ProgramRun bristle =
      run_export("'z = dahl(v, sliding=1e-4); 3e4*z + 5*v' --as urdf --linear --box 'v=-1:1'");
  EXPECT_NEAR(std::stod(attribute(bristle.output, "joint/dynamics", "friction")), 3, 1e-6);
  EXPECT_THAT(bristle.output, HasSubstr("what its states remember"));
  EXPECT_EQ(attribute(bristle.output, "joint", "type"), "prismatic");
}

TEST(SimulatorExport, ErrorsNameThePlaceAndTheMend) {
  const auto says = [](const std::string& arguments, const std::string& words) {
    const ProgramRun answer = run_export(arguments);
    EXPECT_EQ(answer.status, 2) << arguments;
    EXPECT_THAT(answer.output, HasSubstr(words)) << arguments;
  };
  says("'8*sgn_v' --as mujocoo --box v=-1:1", "did you mean mujoco");
  says("'8*sgn_v' --as urdf", "--box");
  says("'8*sgn_w' --as urdf --box w=-1:1", "add v=LOW:HIGH");
  says("'8*sgn_v' --as urdf --box v=0.1:1", "both directions");
  says("'8*sgn_v' --as isaac --box v=-1:1 --joint 'a b'", "'a b' is no name for a joint");
  says("'log(v)' --as mujoco --box v=-1:1", "no finite value at v=");
}

}  // namespace
}  // namespace tribench
