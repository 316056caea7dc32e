// SPDX-License-Identifier: MIT
#include "problems/reading/channel_names.hpp"

#include <array>
#include <cctype>

namespace tribench {
namespace {

struct Suffix {
  std::string_view text;
  std::string_view unit;
};

// Longest first: _rad_s2 ends in neither _rad_s nor _s.
constexpr std::array kSuffixes = {Suffix{"_rad_s2", "rad/s^2"},
                                  Suffix{"_deg_s2", "deg/s^2"},
                                  Suffix{"_m_s2", "m/s^2"},
                                  Suffix{"_rad_s", "rad/s"},
                                  Suffix{"_deg_s", "deg/s"},
                                  Suffix{"_m_s", "m/s"},
                                  Suffix{"_degC", "degC"},
                                  Suffix{"_rad", "rad"},
                                  Suffix{"_deg", "deg"},
                                  Suffix{"_rpm", "rpm"},
                                  Suffix{"_Nm", "N m"},
                                  Suffix{"_nm", "N m"},
                                  Suffix{"_kg", "kg"},
                                  Suffix{"_m", "m"},
                                  Suffix{"_s", "s"},
                                  Suffix{"_N", "N"},
                                  Suffix{"_A", "A"},
                                  Suffix{"_V", "V"}};

struct Known {
  std::string_view name;  // lower case
  Role role;
  std::string_view unit;  // of the bare symbol; empty where only a suffix can tell
};

constexpr std::array kKnown = {Known{"time", Role::time, "s"},
                               Known{"movement", Role::movement, "-"},
                               Known{"position", Role::position, ""},
                               Known{"q", Role::position, "rad"},
                               Known{"velocity", Role::velocity, ""},
                               Known{"v", Role::velocity, "rad/s"},
                               Known{"qd", Role::velocity, "rad/s"},
                               Known{"dq", Role::velocity, "rad/s"},
                               Known{"acceleration", Role::acceleration, ""},
                               Known{"a", Role::acceleration, "rad/s^2"},
                               Known{"qdd", Role::acceleration, "rad/s^2"},
                               Known{"ddq", Role::acceleration, "rad/s^2"},
                               Known{"gravity_torque", Role::gravity_torque, ""},
                               Known{"gravity", Role::gravity_torque, ""},
                               Known{"tau_g", Role::gravity_torque, "N m"},
                               Known{"g", Role::gravity_torque, "N m"},
                               Known{"motor_torque", Role::motor_torque, ""},
                               Known{"motor_force", Role::motor_torque, ""},
                               Known{"tau_m", Role::motor_torque, "N m"},
                               Known{"friction_torque", Role::friction_torque, ""},
                               Known{"friction_force", Role::friction_torque, ""},
                               Known{"friction", Role::friction_torque, ""},
                               Known{"tau_f", Role::friction_torque, "N m"},
                               Known{"external_torque", Role::external_torque, ""},
                               Known{"tau_ext", Role::external_torque, "N m"},
                               Known{"temperature", Role::temperature, ""},
                               Known{"motor_current", Role::motor_current, ""},
                               Known{"current", Role::motor_current, ""},
                               Known{"other_velocity", Role::other_velocity, ""},
                               Known{"v2", Role::other_velocity, "rad/s"},
                               Known{"other_acceleration", Role::other_acceleration, ""},
                               Known{"a2", Role::other_acceleration, "rad/s^2"}};

std::string lower(std::string_view text) {
  std::string result;
  for (const char c : text) {
    result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return result;
}

const Known* find_known(std::string_view name) {
  const std::string wanted = lower(name);
  for (const Known& known : kKnown) {
    if (known.name == wanted) return &known;
  }
  return nullptr;
}

std::string unit_or_dash(std::string_view unit) { return std::string(unit.empty() ? "-" : unit); }

// A name without a sign prefix.
NameReading read_plain(std::string_view name) {
  // Time and temperature differ by case alone.
  if (name == "t") return {Role::time, "s"};
  if (name == "T") return {Role::temperature, "degC"};
  if (const Known* known = find_known(name)) return {known->role, unit_or_dash(known->unit)};
  for (const Suffix& suffix : kSuffixes) {
    if (!name.ends_with(suffix.text)) continue;
    const std::string_view stem = name.substr(0, name.size() - suffix.text.size());
    if (stem == "t") return {Role::time, std::string(suffix.unit)};
    if (stem == "T") return {Role::temperature, std::string(suffix.unit)};
    const Known* known = find_known(stem);
    return {known != nullptr ? known->role : Role::none, std::string(suffix.unit)};
  }
  return {Role::none, "-"};
}

}  // namespace

NameReading read_channel_name(std::string_view name) {
  constexpr std::string_view kSign = "sgn_";
  if (!name.starts_with(kSign)) return read_plain(name);
  switch (read_plain(name.substr(kSign.size())).role) {
    case Role::velocity:
      return {Role::velocity_sign, "-"};
    case Role::gravity_torque:
      return {Role::gravity_sign, "-"};
    default:
      return {Role::none, "-"};
  }
}

bool is_torque_like(Role role) {
  return role == Role::gravity_torque || role == Role::motor_torque ||
         role == Role::friction_torque || role == Role::external_torque ||
         role == Role::motor_current;
}

}  // namespace tribench
