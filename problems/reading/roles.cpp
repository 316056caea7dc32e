// SPDX-License-Identifier: MIT
#include "problems/reading/roles.hpp"

#include <fmt/format.h>

#include <vector>

#include "foundation/error.hpp"
#include "foundation/text.hpp"

namespace tribench {
namespace {

// Cut at commas that stand neither in brackets nor in quotes.
std::vector<std::string_view> parts_of(std::string_view text) {
  std::vector<std::string_view> parts;
  std::size_t begin = 0;
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    if (i == text.size() || (text[i] == ',' && depth == 0 && !quoted)) {
      parts.push_back(trimmed(text.substr(begin, i - begin)));
      begin = i + 1;
    } else if (text[i] == '"') {
      quoted = !quoted;
    } else if (text[i] == '[' || text[i] == '(') {
      ++depth;
    } else if ((text[i] == ']' || text[i] == ')') && depth > 0) {
      --depth;
    }
  }
  return parts;
}

}  // namespace

GivenRole parse_role(std::string_view text, std::string_view place) {
  GivenRole given;
  const std::size_t open = text.find('[');
  given.role = find_role(trimmed(text.substr(0, open)), place);
  if (open == std::string_view::npos) return given;
  if (text.back() != ']') {
    throw_bad_input(fmt::format("'{}' is no ROLE[UNIT]", text), place,
                    "write for example position[deg]");
  }
  const std::string_view unit = trimmed(text.substr(open + 1, text.size() - open - 2));
  if (const std::size_t at = unit.find('@'); at != std::string_view::npos) {
    if (unit.substr(at + 1) != "motor") {
      throw_bad_input(fmt::format("'{}' is no side of the gear", unit.substr(at + 1)), place,
                      "write @motor, or nothing for the joint");
    }
  }
  if (given.role == Role::time && unit == "epoch") return given;  // its size tells
  given.in = find_written_unit(unit);
  const std::string known = units_of(given.role);
  if (known.empty()) {
    throw_bad_input(fmt::format("a {} has no unit", role_name(given.role)), place,
                    fmt::format("leave out [{}]", unit));
  }
  if (given.in.unit == nullptr || !suits(*given.in.unit, given.role)) {
    throw_bad_input(fmt::format("'{}' is no unit of a {}", unit, role_name(given.role)), place,
                    fmt::format("known: {}; a number may stand before it: [0.1 deg]", known));
  }
  return given;
}

GivenRoles parse_roles(std::string_view text, std::string_view place) {
  GivenRoles roles;
  if (trimmed(text).empty()) return roles;
  for (const std::string_view part : parts_of(text)) {
    // The last equals sign: a column's name may hold one, a role never does.
    const std::size_t equals = part.rfind('=');
    if (equals == std::string_view::npos || equals == 0) {
      throw_bad_input(fmt::format("'{}' is no COLUMN=ROLE", part), place,
                      "write for example --roles 'tau=friction_torque,w=velocity[deg/s]'");
    }
    std::string_view column = trimmed(part.substr(0, equals));
    if (column.size() > 1 && column.front() == '"' && column.back() == '"') {
      column = column.substr(1, column.size() - 2);
    }
    const GivenRole role = parse_role(trimmed(part.substr(equals + 1)), place);
    if (!roles.emplace(column, role).second) {
      throw_bad_input(fmt::format("column '{}' is given two roles", column), place, "give it one");
    }
  }
  return roles;
}

}  // namespace tribench
