// SPDX-License-Identifier: MIT
//
// What a user says a column is: "q=position[deg],w=velocity[rpm@motor],i=motor_current[2.69 mA]".
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "problems/dataset.hpp"
#include "problems/reading/units.hpp"

namespace tribench {

struct GivenRole {
  Role role = Role::none;
  WrittenUnit in = {};  // no unit: as the header says, else SI

  GivenRole() = default;
  GivenRole(Role given) : role(given) {}  // NOLINT(google-explicit-constructor): a role alone
};

using GivenRoles = std::map<std::string, GivenRole, std::less<>>;

// "position[deg]", "velocity[rpm@motor]", "none". Throws Error (bad_input) with `place` for a role
// or an unknown unit, or that do not go together.
GivenRole parse_role(std::string_view text, std::string_view place);

// "column=role,column=role". Commas in brackets or quotes part nothing: '"a,b"=position'.
// Throws Error (bad_input), also where a column is named twice.
GivenRoles parse_roles(std::string_view text, std::string_view place);

}  // namespace tribench
