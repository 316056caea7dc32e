// SPDX-License-Identifier: MIT
#include "problems/preparation/chain_gravity.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "foundation/error.hpp"

#ifdef TRIBENCH_WITH_URDF
#include <urdf_parser/urdf_parser.h>

#include <kdl/tree.hpp>
#include <kdl/treeidsolver_recursive_newton_euler.hpp>

#include "foundation/text.hpp"
#endif

namespace tribench {

#ifndef TRIBENCH_WITH_URDF

bool has_chain_gravity() { return false; }

void add_chain_gravity(DataFile&, const std::filesystem::path&) {
  throw_bad_input("this program is built without what reads a URDF", "--urdf",
                  "install liburdfdom-dev and liborocos-kdl-dev and build again, or declare the "
                  "gravity torque as a column");
}

#else

namespace {

constexpr double kGravity = 9.81;          // m/s^2
constexpr std::size_t kMostLinks = 1'000;  // walking a chain takes stack
constexpr const char* kNamedAlike = "name the columns after the joints of that file";

KDL::Vector vector_of(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

KDL::Frame frame_of(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  return {KDL::Rotation::Quaternion(r.x, r.y, r.z, r.w), vector_of(pose.position)};
}

bool is_movable(const urdf::Joint& joint) {
  return joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS ||
         joint.type == urdf::Joint::PRISMATIC;
}

KDL::Joint joint_of(const urdf::Joint& joint) {
  const KDL::Frame frame = frame_of(joint.parent_to_joint_origin_transform);
  if (!is_movable(joint)) return KDL::Joint(joint.name, KDL::Joint::Fixed);
  const auto kind =
      joint.type == urdf::Joint::PRISMATIC ? KDL::Joint::TransAxis : KDL::Joint::RotAxis;
  return {joint.name, frame.p, frame.M * vector_of(joint.axis), kind};
}

// Moments of inertia do nothing at rest.
KDL::RigidBodyInertia inertia_of(const urdf::Link& link) {
  if (!link.inertial) return KDL::RigidBodyInertia::Zero();
  return KDL::RigidBodyInertia(link.inertial->mass, vector_of(link.inertial->origin.position));
}

struct Arm {
  std::string place;  // the file, for messages
  KDL::Tree tree;
  std::vector<std::string> joints;  // that move, from the root on

  void add(const urdf::Link& link) {
    for (const urdf::LinkSharedPtr& child : link.child_links) {
      const urdf::Joint& joint = *child->parent_joint;
      // A link that is there already: following it again would never end.
      if (!tree.addSegment(
              KDL::Segment(child->name, joint_of(joint),
                           frame_of(joint.parent_to_joint_origin_transform), inertia_of(*child)),
              link.name)) {
        throw_bad_input(fmt::format("link '{}' hangs on two joints or on itself", child->name),
                        place, "an arm is a tree of links");
      }
      if (is_movable(joint)) joints.push_back(joint.name);
      add(*child);
    }
  }
};

Arm read_arm(const std::filesystem::path& file) {
  const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(read_file(file));
  if (!model || !model->getRoot()) {
    throw_bad_input("this is no URDF of a robot", file.string(),
                    "give the file that `xacro` writes, with links and joints");
  }
  if (model->links_.size() > kMostLinks) {
    throw_bad_input(fmt::format("{} links", model->links_.size()), file.string(),
                    fmt::format("{} at most", kMostLinks));
  }
  Arm arm;
  arm.place = file.string();
  arm.tree = KDL::Tree(model->getRoot()->name);
  arm.add(*model->getRoot());
  return arm;
}

bool holds(const std::string& name, const std::string& word) {
  return in_small_letters(name).find(in_small_letters(word)) != std::string::npos;
}

// Of the arm's joint of this name.
const JointPosition& position_of(const std::string& name, const DataFile& file, const Arm& arm) {
  std::vector<const JointPosition*> all;
  std::vector<std::string> words;
  for (const JointPosition& one : file.joint_positions) {
    if (in_small_letters(one.joint) == in_small_letters(name)) return one;
    words.push_back(one.joint);
    if (holds(name, one.joint) || holds(one.joint, name)) all.push_back(&one);
  }
  if (all.size() == 1) return *all.front();
  throw_bad_input(
      fmt::format("{} '{}' is the position of its joint '{}'",
                  all.empty() ? "none of" : "more than one of", fmt::join(words, "', '"), name),
      arm.place, kNamedAlike);
}

// In the order of the arm's joints.
std::vector<const JointPosition*> positions_of(const DataFile& file, const Arm& arm) {
  std::vector<const JointPosition*> positions;
  if (file.joints_have_words) {
    for (const std::string& name : arm.joints) {
      const JointPosition& one = position_of(name, file, arm);
      if (std::ranges::count(positions, &one) > 0) {
        throw_bad_input(
            fmt::format("'{}' would be the position of two of its joints, '{}' one of them",
                        one.joint, name),
            arm.place, kNamedAlike);
      }
      positions.push_back(&one);
    }
    return positions;
  }
  if (file.joint_positions.size() != arm.joints.size()) {
    throw_bad_input(
        fmt::format("{} joints move there ({}), and the data have positions of {}",
                    arm.joints.size(), fmt::join(arm.joints, ", "), file.joint_positions.size()),
        arm.place, "give columns q1, q2, ... of all of them, in the file's order");
  }
  for (const JointPosition& one : file.joint_positions) positions.push_back(&one);
  return positions;
}

}  // namespace

bool has_chain_gravity() { return true; }

void add_chain_gravity(DataFile& file, const std::filesystem::path& urdf) {
  if (file.joint.empty()) {
    throw_bad_input("no joint is chosen", "--urdf",
                    "give --joint N, or its name, beside columns of all joints");
  }
  if (const Channel* gravity = file.data.find(Role::gravity_torque)) {
    throw_bad_input(fmt::format("'{}' declares the gravity torque already", gravity->name),
                    "--urdf",
                    fmt::format("leave one of them out: --roles '{}=none'", gravity->name));
  }
  const Arm arm = read_arm(urdf);
  const std::vector<const JointPosition*> of_joints = positions_of(file, arm);
  const auto chosen = std::ranges::find(of_joints, file.joint, &JointPosition::joint);
  if (chosen == of_joints.end()) {
    throw_bad_input(
        fmt::format("joint '{}' is none of {}", file.joint, fmt::join(arm.joints, ", ")),
        urdf.string(), "it has to move there");
  }
  const auto which = static_cast<std::size_t>(chosen - of_joints.begin());
  const std::string& held = arm.joints[which];
  const std::size_t joints = of_joints.size();
  std::vector<const std::vector<double>*> positions;
  for (const JointPosition* one : of_joints) {
    positions.push_back(&file.data.at(one->channel).values);
  }
  const auto n = static_cast<unsigned>(joints);
  std::vector<unsigned> place(joints);  // of each joint among the solver's
  for (const auto& [name, element] : arm.tree.getSegments()) {
    const auto at = std::ranges::find(arm.joints, element.segment.getJoint().getName());
    if (at != arm.joints.end()) {
      place[static_cast<std::size_t>(at - arm.joints.begin())] = element.q_nr;
    }
  }
  KDL::TreeIdSolver_RNE solver(arm.tree, KDL::Vector(0, 0, -kGravity));
  KDL::JntArray q(n);
  const KDL::JntArray rest(n);
  KDL::JntArray torques(n);
  Channel gravity{"urdf_gravity", {}, Role::gravity_torque, {}};
  gravity.unit = file.data.find(Role::position)->unit == "m" ? "N" : "N m";
  for (std::size_t r = 0; r < file.data.rows(); ++r) {
    for (std::size_t j = 0; j < joints; ++j) q(place[j]) = (*positions[j])[r];
    solver.CartToJnt(q, rest, rest, {}, torques);
    gravity.values.push_back(torques(place[which]));
  }
  if (!std::ranges::all_of(gravity.values, [](double torque) { return std::isfinite(torque); })) {
    throw_bad_input("its masses and lengths give no finite torque", urdf.string(),
                    "masses are in kg and lengths in m");
  }
  const auto [low, high] = std::ranges::minmax(gravity.values);
  file.warnings.push_back(fmt::format("gravity of '{}' is from {}: {:.4g} to {:.4g} {}", held,
                                      urdf.filename().string(), low, high, gravity.unit));
  file.data.channels.push_back(std::move(gravity));
}

#endif

}  // namespace tribench
