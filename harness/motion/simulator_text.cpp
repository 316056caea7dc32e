// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "foundation/error.hpp"
#include "foundation/formula_name.hpp"
#include "harness/motion/simulator_friction.hpp"

namespace tribench {
namespace {

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

// A comment holds no two dashes in a row.
std::string comment_safe(std::string text) {
  for (std::size_t at = 0; (at = text.find("--", at)) != std::string::npos;)
    text.insert(at + 1, " ");
  return text;
}

std::string number(double value) { return fmt::format("{:.9g}", value); }

std::vector<std::string> explanation_of(const SimulatorFriction& f, Simulator simulator,
                                        std::string_view formula, bool is_linear) {
  const char* torque = is_linear ? "N" : "N m";
  const char* length = is_linear ? "m" : "rad";
  std::vector<std::string> lines = {
      fmt::format("From the formula {}", formula),
      fmt::format("torque over its box: {:.4g} {} rms; off by {:.4g} {} on average, {:.4g} {} at "
                  "worst ({})",
                  f.rms, torque, f.mean_error, torque, f.worst_error, torque, f.worst_at)};
  for (const LostFriction& lost : f.lost) {
    if (lost.rms < 1e-3 * f.rms) continue;
    lines.push_back(fmt::format("lost: {}: {:.4g} {} rms", lost.what, lost.rms, torque));
  }
  if (f.remembers) {
    lines.emplace_back("lost: what its states remember (presliding, lag): none of it");
  }
  if (simulator != Simulator::isaac && std::abs(f.breakaway - f.coulomb) > 1e-3 * f.rms) {
    lines.push_back(fmt::format("break-away: {:.4g} {} in place of {:.4g} {}", f.coulomb, torque,
                                f.breakaway, torque));
  }
  if (f.inertia) {
    const bool has_others = std::ranges::any_of(f.lost, [&](const LostFriction& lost) {
      return lost.what.starts_with("the dependence on") && lost.rms >= 1e-3 * f.rms;
    });
    lines.push_back(fmt::format(
        "motion{}: with an inertia of {:.4g}, under the torque by which the formula follows a sine "
        "of {:.4g} {} and 2 s: {:.4g} {} off on average over a period, {:.4g} {} at most",
        has_others ? ", all other inputs at the middle of the box" : "", *f.inertia, f.amplitude,
        length, f.mean_motion, length, f.largest_motion, length));
  }
  lines.push_back(
      fmt::format("the same friction on your data: tribench simulate '{}' DATA.csv", f.formula));
  return lines;
}

std::string mujoco_text(const SimulatorFriction& f, const std::string& joint,
                        const std::string& comment) {
  return fmt::format(
      "<mujoco>\n{}  <!-- include this file and give the joint class=\"{}\" -->\n  <default>\n"
      "    <default class=\"{}\">\n      <joint frictionloss=\"{}\" damping=\"{}\"{}/>\n"
      "    </default>\n  </default>\n</mujoco>\n",
      comment, joint, joint, number(f.coulomb), number(f.viscous),
      f.armature > 0 ? fmt::format(" armature=\"{}\"", number(f.armature)) : "");
}

std::string urdf_text(const SimulatorFriction& f, const std::string& joint, bool is_linear,
                      const std::string& comment) {
  const std::string armature =
      f.armature > 0
          ? fmt::format("  <!-- URDF has no armature: add {} to the inertia about the axis -->\n",
                        number(f.armature))
          : "";
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<robot name=\"{0}\">\n{1}{2}"
      "  <link name=\"{0}_parent\"/>\n  <link name=\"{0}_child\"/>\n"
      "  <joint name=\"{0}\" type=\"{3}\">\n    <parent link=\"{0}_parent\"/>\n"
      "    <child link=\"{0}_child\"/>\n    <axis xyz=\"0 0 1\"/>\n{4}"
      "    <dynamics damping=\"{5}\" friction=\"{6}\"/>\n  </joint>\n</robot>\n",
      joint, comment, armature, is_linear ? "prismatic" : "continuous",
      is_linear ? "    <limit effort=\"1e9\" velocity=\"1e9\" lower=\"-1e9\" upper=\"1e9\"/>\n"
                : "",
      number(f.viscous), number(f.coulomb));
}

// USD keeps what belongs to a rotation by degrees; PhysX and Isaac Lab take radians.
std::string isaac_text(const SimulatorFriction& f, const std::string& joint, bool is_linear,
                       const std::string& comment) {
  const char* axis = is_linear ? "linear" : "angular";
  const double by_degree = is_linear ? f.viscous : f.viscous / kDegreesPerRadian;
  const double still = std::max(f.breakaway, f.coulomb);
  return fmt::format(
      "#usda 1.0\n{0}# Isaac Lab: friction={1}, dynamic_friction={2}, viscous_friction={3}{4}\n"
      "over \"{5}\" (\n    prepend apiSchemas = [\"PhysxJointAxisAPI:{6}\"]\n)\n{{\n"
      "    float physxJointAxis:{6}:staticFrictionEffort = {1}\n"
      "    float physxJointAxis:{6}:dynamicFrictionEffort = {2}\n"
      "    float physxJointAxis:{6}:viscousFrictionCoefficient = {7}\n{8}}}\n",
      comment, number(still), number(f.coulomb), number(f.viscous),
      f.armature > 0 ? fmt::format(", armature={}", number(f.armature)) : "", joint, axis,
      number(by_degree),
      f.armature > 0
          ? fmt::format("    float physxJointAxis:{}:armature = {}\n", axis, number(f.armature))
          : "");
}

}  // namespace

std::string simulator_text(const SimulatorFriction& friction, Simulator simulator,
                           std::string_view formula, const std::string& joint, bool is_linear) {
  if (!is_identifier(joint)) {
    throw_bad_input(fmt::format("'{}' is no name for a joint", joint), "--joint",
                    "use letters, digits and _, a letter first");
  }
  std::string comment;
  for (const std::string& line : explanation_of(friction, simulator, formula, is_linear)) {
    comment += simulator == Simulator::isaac ? "# " + line + "\n"
                                             : "  <!-- " + comment_safe(line) + " -->\n";
  }
  switch (simulator) {
    case Simulator::mujoco:
      return mujoco_text(friction, joint, comment);
    case Simulator::urdf:
      return urdf_text(friction, joint, is_linear, comment);
    case Simulator::isaac:
      return isaac_text(friction, joint, is_linear, comment);
  }
  return {};
}

}  // namespace tribench
