// SPDX-License-Identifier: MIT
#include "problems/reading/column_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "foundation/error.hpp"
#include "foundation/suggestion.hpp"
#include "problems/reading/channel_names.hpp"
#include "problems/reading/csv_checks.hpp"
#include "problems/reading/joint_columns.hpp"
#include "problems/reading/joint_words.hpp"
#include "problems/reading/name_words.hpp"
#include "problems/reading/time_columns.hpp"

namespace tribench {
namespace {

// `purpose`: what it was named for, where a reader would wonder.
void check_named(std::string_view column, std::string_view purpose, const CsvLayout& layout,
                 std::string_view file) {
  if (std::ranges::find(layout.header, column) != layout.header.end()) return;
  constexpr std::string_view kSign = "sgn_";
  if (column.starts_with(kSign) &&
      std::ranges::find(layout.header, column.substr(kSign.size())) != layout.header.end()) {
    return;  // derived
  }
  const std::size_t shown = std::min<std::size_t>(layout.header.size(), 40);
  const auto end = layout.header.begin() + static_cast<std::ptrdiff_t>(shown);
  throw_bad_input(
      fmt::format("there is no column '{}'{}", column, purpose), file,
      did_you_mean(column, layout.header,
                   fmt::format("columns: {}{}", fmt::join(layout.header.begin(), end, ", "),
                               shown < layout.header.size() ? ", ..." : "")));
}

bool needs_unit(Role role) {
  return role == Role::position || role == Role::velocity || role == Role::acceleration ||
         role == Role::time || role == Role::motor_current || role == Role::other_velocity ||
         role == Role::other_acceleration;
}

// What a role given without a unit is in.
const Unit* si_unit(Role role) {
  switch (role) {
    case Role::position:
      return find_unit("rad");
    case Role::velocity:
    case Role::other_velocity:
      return find_unit("rad/s");
    case Role::acceleration:
    case Role::other_acceleration:
      return find_unit("rad/s^2");
    case Role::time:
      return find_unit("s");
    case Role::motor_current:
      return find_unit("A");
    case Role::temperature:
      return find_unit("degC");
    default:
      return nullptr;
  }
}

WrittenUnit unit_in_row(const CsvLayout& layout, std::size_t column, Role role) {
  if (layout.units.empty()) return {};
  const WrittenUnit unit = find_written_unit(layout.units[column]);
  return unit.unit != nullptr && suits(*unit.unit, role) ? unit : WrittenUnit{};
}

// What stands in the row of units and is no unit that is known, else what stands so in the name.
std::string unknown_unit(const CsvLayout& layout, std::size_t column, const NameReading& heard) {
  const bool in_row = !layout.units.empty() && !layout.units[column].empty() &&
                      !heard.unit_written &&
                      find_written_unit(layout.units[column]).unit == nullptr;
  if (in_row) return layout.units[column];
  // What the name's source always has in one that is none of the role.
  const bool is_strange =
      !heard.unit_written && heard.known.unit != nullptr && !suits(*heard.known.unit, heard.role);
  return is_strange ? std::string(heard.known.unit->symbol) : heard.unknown_unit;
}

std::string or_nearest(const std::string& unit, Role role) {
  const std::string nearest = nearest_unit(unit, role);
  return nearest.empty() ? std::string() : fmt::format(" (is {} meant?)", nearest);
}

std::string mend_for_unit(const std::string& column, Role role, std::string_view unit) {
  if (unit == "%" && (role == Role::velocity || role == Role::other_velocity)) {
    return fmt::format(
        "say how fast one per cent is, as in --roles '{}={}[1.8 deg/s]', or leave it "
        "out: --roles '{}=none'",
        column, role_name(role), column);
  }
  return fmt::format("say it with --roles '{}={}[UNIT]'; known: {}", column, role_name(role),
                     units_of(role));
}

ColumnPlan plan_column(const CsvLayout& layout, std::size_t j, const JointWord& owner,
                       const CsvOptions& options, std::string_view file) {
  const std::string& name = layout.header[j];
  ColumnPlan plan;
  plan.reading.column = name;
  NameReading heard;
  if (options.names_tell) heard = read_channel_name(owner.word.empty() ? name : owner.quantity);
  plan.joint_word = owner.word;
  if (owner.word.empty()) plan.joint = heard.joint;
  plan.reading.role = heard.role;
  plan.doubt = heard.doubt;
  bool at_motor = heard.at_motor;
  if (heard.role != Role::none) {
    plan.reading.role_from = fmt::format("name ({})", heard.source);
    if (heard.source.empty()) plan.reading.role_from = "name";
  }
  const auto given = options.roles.find(name);
  if (given != options.roles.end()) {
    plan.role_given = true;
    plan.reading.role = given->second.role;
    plan.reading.role_from = "--roles";
    at_motor = given->second.in.at_motor;
    plan.doubt = 0;
    // What is written in the name counts whatever else the name says.
    if (!options.names_tell) heard = read_channel_name(name);
    const bool is_strange =
        heard.known.unit != nullptr && !suits(*heard.known.unit, plan.reading.role);
    if (is_strange && (heard.unit_written || heard.role != plan.reading.role)) heard = {};
    at_motor = at_motor || (heard.unit_written && heard.known.at_motor);
  }
  const Role role = plan.reading.role;
  const auto on_side = [&](WrittenUnit unit) {
    unit.at_motor = unit.at_motor || at_motor;
    return unit;
  };
  const std::string unknown = unknown_unit(layout, j, heard);
  if (given != options.roles.end() && given->second.in.unit != nullptr) {
    take_unit(plan, given->second.in, "--roles");
  } else if (const WrittenUnit row = unit_in_row(layout, j, role); row.unit != nullptr) {
    take_unit(plan, on_side(row), "row of units");
  } else if (heard.unit_written) {
    take_unit(plan, on_side(heard.known), "name");
  } else if (!unknown.empty() && needs_unit(role)) {
    throw_bad_input(fmt::format("'{}' is no unit of a {}{}", unknown, role_name(role),
                                or_nearest(unknown, role)),
                    fmt::format("{}, column '{}'", file, name), mend_for_unit(name, role, unknown));
  } else if (heard.known.unit != nullptr && unknown.empty() && role != Role::none &&
             !plan.role_given) {
    take_unit(plan, on_side(heard.known), heard.source);
    plan.reading.unit_assumed = true;
  } else if (plan.role_given && si_unit(role) != nullptr) {
    take_unit(plan, on_side({si_unit(role)}), "--roles without a unit");
    plan.reading.unit_assumed = true;
  } else {
    plan.reading.unit_asked = needs_unit(role);
    if (!unknown.empty() && role != Role::none && role != Role::movement) {
      plan.reading.remark = fmt::format("'{}' is no unit that is known{}: read as it stands",
                                        unknown, or_nearest(unknown, role));
      plan.unknown_unit = unknown;
    }
  }
  return plan;
}

// A torque in a unit that is not known beside another in one that is: their numbers cannot be held
// against each other.
void check_known_units(const std::vector<ColumnPlan>& plans, std::string_view file) {
  const auto known = std::ranges::find_if(plans, [](const ColumnPlan& plan) {
    return is_torque_like(plan.reading.role) && plan.unit.unit != nullptr;
  });
  if (known == plans.end()) return;
  for (const ColumnPlan& plan : plans) {
    const Role role = plan.reading.role;
    if (!is_torque_like(role) || plan.unknown_unit.empty() || plan.role_given) continue;
    throw_bad_input(fmt::format("'{}' is no unit of a {}{}, and '{}' is in {}", plan.unknown_unit,
                                role_name(role), or_nearest(plan.unknown_unit, role),
                                known->reading.column, known->unit.symbol()),
                    fmt::format("{}, column '{}'", file, plan.reading.column),
                    mend_for_unit(plan.reading.column, role, plan.unknown_unit));
  }
}

// A role given by hand takes it away from columns that only sound like it; of several that sound
// alike the one whose name is closest keeps it, then the first.
void settle_roles(const CsvLayout& layout, std::vector<ColumnPlan>& plans, DataFile& out) {
  std::map<Role, std::size_t> owner;
  std::vector<std::size_t> order(plans.size());
  for (std::size_t j = 0; j < order.size(); ++j) order[j] = j;
  std::ranges::stable_sort(order, {}, [&](std::size_t j) {
    if (plans[j].role_given) return -2;
    return is_split_stamp(layout, plans[j], plans) ? -1 : plans[j].doubt;
  });
  for (const std::size_t j : order) {
    ColumnPlan& plan = plans[j];
    if (plan.reading.role == Role::none) continue;
    const auto [place, is_new] = owner.try_emplace(plan.reading.role, j);
    if (is_new) continue;
    ColumnPlan& first = plans[place->second];
    if (completes_time(layout, first, plan) || completes_time(layout, plan, first)) {
      // The seconds are the time, the nanoseconds are added to it.
      ColumnPlan& part = plan.unit.symbol() == "ns" ? plan : first;
      part.adds_to_time = true;
      part.reading.remark = "added to the seconds";
      if (&part == &first) place->second = j;
      continue;
    }
    if (!plan.role_given) {
      std::string remark = fmt::format("'{}' already is the {}", first.reading.column,
                                       role_name(first.reading.role));
      if (plan.doubt <= first.doubt || first.role_given) {
        out.warnings.push_back(
            fmt::format("column '{}' is read without a role: {}", plan.reading.column, remark));
      }
      lose_role(plan, std::move(remark));
    } else if (plan.reading.role == Role::movement) {
      lose_role(plan, "another column is the movement");
    }
  }
}

// The role that a column may have by its unit, where nothing else has it.
Role role_of(Dimension dimension) {
  switch (dimension) {
    case Dimension::time:
      return Role::time;
    case Dimension::angle:
      return Role::position;
    case Dimension::angular_velocity:
      return Role::velocity;
    case Dimension::angular_acceleration:
      return Role::acceleration;
    case Dimension::current:
      return Role::motor_current;
    case Dimension::torque:
      return Role::motor_torque;
    case Dimension::temperature:
      return Role::temperature;
    default:
      return Role::none;
  }
}

// Of what the motor gives there is one column: a torque or its current.
Role kind_of(Role role) {
  const bool effort = role == Role::motor_current || role == Role::friction_torque;
  return effort ? Role::motor_torque : role;
}

// "phase_A" and "flag_s" are not in amperes and seconds: one letter tells in brackets or in a row
// of units alone.
bool is_plainly_written(const ColumnPlan& plan) {
  const std::string& name = plan.reading.column;
  const bool letter = name.size() > 1 && name[name.size() - 2] == '_';
  return !plan.reading.unit_assumed && (!letter || plan.reading.unit_from == "row of units");
}

// The one column in a unit of time, angle, its rates, current, torque or temperature ("tick_ms",
// "shoulder [deg]") is what its unit says, where no name says what is.
void take_roles_by_unit(const CsvLayout& layout, std::vector<ColumnPlan>& plans, DataFile& out) {
  std::map<Role, std::vector<std::size_t>> candidates;
  std::set<Role> owned;
  for (std::size_t j = 0; j < plans.size(); ++j) {
    const ColumnPlan& plan = plans[j];
    const Role role = plan.reading.role;
    if (role != Role::none) owned.insert(kind_of(role));
    if (role != Role::none || plan.role_given || !plan.reading.remark.empty()) continue;
    if (plan.unit.unit == nullptr) continue;
    const Role may_be = role_of(plan.unit.unit->dimension);
    if (may_be == Role::none || plan.unit.unit->counts || !is_plainly_written(plan)) continue;
    if (names_something_else(plan.reading.column)) continue;
    candidates[kind_of(may_be)].push_back(j);
  }
  // A joint whose speed is known is told already: its way may be counted in any manner.
  if (owned.contains(Role::velocity)) candidates.erase(Role::position);
  take_date(layout, plans, owned.contains(Role::time) || candidates.contains(Role::time));
  for (const auto& [role, columns] : candidates) {
    if (owned.contains(role) || columns.size() != 1) continue;
    ColumnPlan& plan = plans[columns.front()];
    plan.reading.role = role_of(plan.unit.unit->dimension);
    plan.reading.role_from = "the only one in such a unit";
    WrittenUnit unit = plan.unit;
    unit.at_motor = unit.at_motor || names_motor(plan.reading.column);
    take_unit(plan, unit, plan.reading.unit_from);
    out.warnings.push_back(fmt::format(
        "column '{}' is taken for the {}: it is the only one in {} (--roles says otherwise)",
        plan.reading.column, role_name(plan.reading.role), plan.unit.unit->symbol));
  }
}

// What a user has looked at and left without a role is no question any more; another torque is no
// cause of this one.
bool is_spare(const CsvOptions& options, const ColumnPlan& plan) {
  const bool effort = plan.unit.unit != nullptr && measures_effort(*plan.unit.unit);
  return options.spare && !plan.role_given && !effort;
}

}  // namespace

void lose_role(ColumnPlan& plan, std::string remark) {
  plan.reading.role = Role::none;
  plan.reading.role_from.clear();
  plan.reading.unit_asked = false;
  plan.reading.remark = std::move(remark);
}

std::vector<ColumnPlan> plan_columns(const CsvLayout& layout, const CsvOptions& options,
                                     std::string_view file, DataFile& out) {
  for (const auto& [column, role] : options.roles) {
    check_named(column, ", to which a role is given", layout, file);
  }
  std::set<std::string, std::less<>> used;
  if (options.used) {
    for (const std::string& column : *options.used) {
      check_named(column, "", layout, file);
      used.insert(column);
      if (column.starts_with("sgn_")) used.insert(column.substr(4));
    }
  }
  std::vector<JointWord> words(layout.header.size());
  if (options.names_tell) words = joint_words_of(layout.header);
  std::vector<ColumnPlan> plans;
  for (std::size_t j = 0; j < layout.header.size(); ++j) {
    plans.push_back(plan_column(layout, j, words[j], options, file));
  }
  if (options.names_tell) {
    choose_joint_by_word(options, plans, file, out);
    refuse_joints_told_by_words(plans, file);
    choose_joint(options, plans, out);
  }
  settle_roles(layout, plans, out);
  if (options.names_tell && out.joints.empty()) take_roles_by_unit(layout, plans, out);
  check_known_units(plans, file);
  demote_current(options, plans, out);
  for (ColumnPlan& plan : plans) {
    const Role role = plan.reading.role;
    plan.used =
        !options.used || role != Role::none || plan.in_chain || used.contains(plan.reading.column);
    plan.kind = role == Role::movement                ? ColumnKind::text
                : role == Role::time                  ? ColumnKind::time
                : role != Role::none || plan.in_chain ? ColumnKind::number
                : plan.used                           ? ColumnKind::found
                : is_spare(options, plan)             ? ColumnKind::spare
                                                      : ColumnKind::unused;
  }
  return plans;
}

void take_unit(ColumnPlan& plan, const WrittenUnit& unit, std::string_view from) {
  plan.unit = unit;
  plan.reading.unit = unit.symbol();
  plan.reading.unit_from = std::string(from);
}

void take_time_text(ColumnPlan& plan) {
  take_unit(plan, {find_unit("s")}, "its text");
  plan.reading.unit_assumed = false;
  plan.reading.unit_asked = false;
}

void convert(ColumnPlan& plan, std::vector<double>& values, const Drive& drive,
             std::string_view file) {
  ColumnReading& reading = plan.reading;
  const std::string place = fmt::format("{}, column '{}'", file, reading.column);
  if (reading.role == Role::time && !values.empty()) settle_time(plan, values, place);
  if (plan.unit.unit == nullptr || (reading.role == Role::none && !plan.in_chain)) {
    reading.si = reading.unit.empty() ? "-" : reading.unit;
    return;
  }
  const auto [conversion, needs] = conversion_of(plan.unit, drive);
  if (!needs.empty()) {
    reading.needs = needs;
    reading.si = "-";
    return;
  }
  reading.si = conversion.unit;
  reading.factor = conversion.factor;
  if (conversion.factor == 1 && conversion.offset == 0) return;
  for (double& value : values) value = (value + conversion.offset) * conversion.factor;
}

}  // namespace tribench
