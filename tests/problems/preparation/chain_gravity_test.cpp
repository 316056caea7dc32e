// SPDX-License-Identifier: MIT
#include "problems/preparation/chain_gravity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "foundation/error.hpp"
#include "problems/preparation/data_options.hpp"
#include "tests/support/paths.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;

// Two links in a plane that stands upright, and a tool that is fixed to the second.
constexpr const char* kArm = R"(<?xml version="1.0"?>
<robot name="planar">
  <link name="base"/>
  <link name="upper"><inertial><origin xyz="0.5 0 0"/><mass value="2"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="lower"><inertial><origin xyz="0.25 0 0"/><mass value="3"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="tool"><inertial><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="9" velocity="9"/></joint>
  <joint name="elbow" type="continuous"><parent link="upper"/><child link="lower"/>
    <origin xyz="1 0 0"/><axis xyz="0 1 0"/></joint>
  <joint name="flange" type="fixed"><parent link="lower"/><child link="tool"/>
    <origin xyz="0.5 0 0"/></joint>
</robot>
)";

constexpr const char* kLog =
    "t [s],q1 [deg],q2 [deg],tau1 [Nm],tau2 [Nm]\n0,0,0,1,1\n0.01,30,20,2,1\n0.02,-90,45,3,1\n";

class ChainGravity : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = testing::scratch_folder() / "urdf";
    std::filesystem::create_directories(folder_);
    write("arm.urdf", kArm);
    write("log.csv", kLog);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  DataFile read(const std::string& joint) const {
    DataOptions options;
    if (!joint.empty()) options.choose_joint(joint, "--joint");
    options.urdf = folder_ / "arm.urdf";
    const std::vector<std::filesystem::path> files = {folder_ / "log.csv"};
    return read_data(files, options, std::vector<std::string>{});
  }
  std::string refusal(const std::string& joint) const {
    try {
      read(joint);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
      return error.what();
    }
    return "accepted";
  }

  // In the log's three postures, of the joint at the root or of the other one.
  void expect_what_holds(const std::string& joint, bool is_root) const {
    const DataFile file = read(joint);
    const Channel* gravity = file.data.find(Role::gravity_torque);
    ASSERT_NE(gravity, nullptr);
    EXPECT_EQ(gravity->unit, "N m");
    const double degrees[3][2] = {{0, 0}, {30, 20}, {-90, 45}};
    for (std::size_t r = 0; r < 3; ++r) {
      const double upper = std::cos(degrees[r][0] * M_PI / 180);
      const double lower = std::cos((degrees[r][0] + degrees[r][1]) * M_PI / 180);
      const double beyond = (3 * 0.25 + 1 * 0.5) * lower;
      // An angle about +y turns the links down: gravity pulls with it.
      const double held = is_root ? (2 * 0.5 + 3 + 1) * upper + beyond : beyond;
      EXPECT_NEAR(gravity->values[r], -9.81 * held, 1e-9) << joint << ", row " << r;
    }
  }

  std::filesystem::path folder_;
};

TEST_F(ChainGravity, IsWhatHoldsTheArm) {
  if (!has_chain_gravity()) GTEST_SKIP() << "built without urdfdom and KDL";
  expect_what_holds("1", true);
  expect_what_holds("2", false);
}

// As ROS lists joint states: by the alphabet, a gripper among them that the URDF has not.
TEST_F(ChainGravity, JointsThatHaveWordsAreThoseWhoseNamesHoldThem) {
  if (!has_chain_gravity()) GTEST_SKIP() << "built without urdfdom and KDL";
  write("log.csv",
        "t [s],elbow_position [deg],finger_position [deg],shoulder_position [deg],"
        "elbow_effort [Nm],finger_effort [Nm],shoulder_effort [Nm]\n"
        "0,0,1,0,1,0,1\n0.01,20,2,30,1,0,2\n0.02,45,1,-90,1,0,3\n");
  expect_what_holds("shoulder", true);
  expect_what_holds("elbow", false);
  EXPECT_THAT(refusal("finger"), HasSubstr("joint 'finger' is none of shoulder, elbow"));
}

TEST_F(ChainGravity, AWordThatTellsNoJointOfTheArmIsRefused) {
  if (!has_chain_gravity()) GTEST_SKIP() << "built without urdfdom and KDL";
  write("log.csv",
        "t [s],knee_position [deg],shoulder_position [deg],knee_effort [Nm],shoulder_effort [Nm]\n"
        "0,0,0,1,1\n0.01,30,20,2,1\n");
  EXPECT_THAT(refusal("shoulder"),
              HasSubstr("none of 'knee', 'shoulder' is the position of its joint 'elbow'"));
  write("log.csv",
        "t [s],e_position [deg],o_position [deg],e_effort [Nm],o_effort [Nm]\n"
        "0,0,0,1,1\n0.01,30,20,2,1\n");
  EXPECT_THAT(refusal("e"), HasSubstr("more than one of 'e', 'o' is the position of"));
  write("log.csv",
        "t [s],e_position [deg],finger_position [deg],e_effort [Nm],finger_effort [Nm]\n"
        "0,0,0,1,1\n0.01,30,20,2,1\n");
  EXPECT_THAT(refusal("e"), HasSubstr("'e' would be the position of two of its joints"));
}

TEST_F(ChainGravity, SaysWhatIsWrongWithTheFileOrTheData) {
  if (!has_chain_gravity()) GTEST_SKIP() << "built without urdfdom and KDL";
  EXPECT_THAT(refusal(""), HasSubstr("--joint N"));
  write("log.csv", "t [s],q1 [deg],q2 [deg],q3 [deg],tau1 [Nm]\n0,0,0,0,1\n1,0,0,0,1\n");
  EXPECT_THAT(refusal("1"), HasSubstr("2 joints move there (shoulder, elbow), and the data have"));
  write("arm.urdf", "<robot>");
  EXPECT_THAT(refusal("1"), HasSubstr("no URDF"));
  write("arm.urdf",
        "<robot name='r'><link name='base'/><link name='upper'/>"
        "<joint name='a' type='fixed'><parent link='base'/><child link='upper'/></joint>"
        "<joint name='b' type='fixed'><parent link='upper'/><child link='upper'/></joint></robot>");
  EXPECT_THAT(refusal("1"), HasSubstr("'upper' hangs on two joints or on itself"));
}

TEST_F(ChainGravity, WithoutTheLibrariesSaysHowToGetThem) {
  if (has_chain_gravity()) GTEST_SKIP() << "built with urdfdom and KDL";
  EXPECT_THAT(refusal("1"), HasSubstr("liborocos-kdl-dev"));
}

}  // namespace
}  // namespace tribench
