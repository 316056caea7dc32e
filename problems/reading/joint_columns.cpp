// SPDX-License-Identifier: MIT
#include "problems/reading/joint_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "foundation/error.hpp"
#include "foundation/text.hpp"
#include "problems/reading/joint_words.hpp"
#include "problems/reading/name_words.hpp"

namespace tribench {
namespace {

// The position of a joint, for who needs the whole arm's posture: of several the first one's.
void keep_position(const std::string& joint, ColumnPlan& plan, DataFile& out) {
  const bool is_known = std::ranges::count(out.joint_positions, joint, &JointPosition::joint) > 0;
  if (plan.reading.role != Role::position || is_known) return;
  plan.in_chain = true;
  out.joint_positions.push_back({joint, plan.reading.column});
}

// What differs between names, from the first that differs to the last: "shoulder" and "elbow" of
// "/shoulder_joint/position" and "/elbow_joint/position". Empty unless all end alike after it.
std::vector<std::string> differences(const std::vector<std::string>& names) {
  std::size_t shortest = names[0].size();
  for (const std::string& name : names) shortest = std::min(shortest, name.size());
  const auto alike = [&](auto character) {
    std::size_t count = 0;
    while (count < shortest && std::ranges::all_of(names, [&](const std::string& name) {
             return character(name, count) == character(names[0], count);
           })) {
      ++count;
    }
    return count;
  };
  const std::size_t begin = alike([](const std::string& name, std::size_t k) { return name[k]; });
  const std::size_t end =
      alike([](const std::string& name, std::size_t k) { return name[name.size() - 1 - k]; });
  std::vector<std::string> parts;
  for (const std::string& name : names) {
    if (end == 0 || begin + end >= name.size()) return {};
    parts.push_back(name.substr(begin, name.size() - end - begin));
  }
  return parts;
}

}  // namespace

void refuse_joints_told_by_words(const std::vector<ColumnPlan>& plans, std::string_view file) {
  std::map<Role, std::vector<std::string>> names;
  for (const ColumnPlan& plan : plans) {
    const Role role = plan.reading.role;
    if (plan.role_given && is_of_one_joint(role)) return;  // which one was said
    if (!is_of_one_joint(role) || plan.joint || !plan.joint_word.empty()) continue;
    names[role].push_back(plan.reading.column);
  }
  std::map<std::vector<std::string>, std::vector<std::string>> seen;  // roles of one joint
  for (const auto& [role, alike] : names) {
    if (alike.size() < 2) continue;
    const std::vector<std::string> parts = differences(alike);
    if (parts.empty() || std::ranges::any_of(parts, names_processing)) continue;
    seen[parts].push_back(fmt::format("{}={}", alike.front(), role_name(role)));
  }
  for (const auto& [parts, roles] : seen) {
    if (roles.size() < 2) continue;
    throw_bad_input(
        fmt::format("columns of several joints stand here, told apart by '{}'",
                    fmt::join(parts, "', '")),
        file, fmt::format("say which are those of one joint: --roles '{}'", fmt::join(roles, ",")));
  }
}

namespace {

// "Elbow_joint" and "elbow" are one.
std::string plain_word(std::string_view joint) {
  std::string plain = in_small_letters(joint);
  constexpr std::string_view kJoint = "_joint";
  if (plain.ends_with(kJoint)) plain.resize(plain.size() - kJoint.size());
  return plain;
}

// The joint that is asked for, else the one of the columns whose roles are given, else the only
// one; empty: none is told.
std::string chosen_word(const CsvOptions& options, const std::vector<ColumnPlan>& plans,
                        const Words& words) {
  if (!options.joint_word.empty() || options.joint) {
    const std::string asked =
        options.joint ? fmt::format("{}", *options.joint) : options.joint_word;
    for (const std::string& word : words) {
      if (plain_word(word) == plain_word(asked)) return word;
    }
    throw_bad_input(fmt::format("no column is of joint '{}'", asked), "--joint",
                    fmt::format("joints: {}", fmt::join(words, ", ")));
  }
  std::set<std::string> given;
  for (const ColumnPlan& plan : plans) {
    if (plan.role_given && is_of_one_joint(plan.reading.role)) given.insert(plan.joint_word);
  }
  if (given.size() == 1) return *given.begin();
  return words.size() == 1 ? words.front() : std::string();
}

// As --roles takes it, of the first joint's columns.
std::string roles_of_first(const std::vector<ColumnPlan>& plans, const std::string& word) {
  std::string roles;
  for (const ColumnPlan& plan : plans) {
    if (plan.joint_word != word || !is_of_one_joint(plan.reading.role)) continue;
    roles += fmt::format("{}{}={}", roles.empty() ? "" : ",", plan.reading.column,
                         role_name(plan.reading.role));
  }
  return roles;
}

}  // namespace

void choose_joint_by_word(const CsvOptions& options, std::vector<ColumnPlan>& plans,
                          std::string_view file, DataFile& out) {
  Words words;
  for (const ColumnPlan& plan : plans) {
    const bool is_known = std::ranges::count(words, plan.joint_word) > 0;
    if (!plan.joint_word.empty() && !is_known) words.push_back(plan.joint_word);
  }
  if (words.empty()) {
    if (options.joint_word.empty()) return;
    throw_bad_input(fmt::format("no column is of joint '{}'", options.joint_word), "--joint",
                    "leave it out, or give a number: no words in the names tell joints apart");
  }
  const bool is_given = std::ranges::any_of(plans, [](const ColumnPlan& plan) {
    return plan.role_given && is_of_one_joint(plan.reading.role);
  });
  const std::string chosen = chosen_word(options, plans, words);
  if (chosen.empty() && is_given) return;  // which one was said
  if (chosen.empty()) {
    throw_bad_input(
        fmt::format("columns of several joints stand here, told apart by '{}'",
                    fmt::join(words, "', '")),
        file,
        fmt::format("choose one (--joint {}), or say which are those of one joint: --roles '{}'",
                    words.front(), roles_of_first(plans, words.front())));
  }
  if (words.size() == 1) {
    out.warnings.push_back(
        fmt::format("the columns of '{}' are taken for the joint's: there are no others", chosen));
  }
  out.joint = chosen;
  out.joints_have_words = true;
  for (ColumnPlan& plan : plans) {
    if (plan.joint_word.empty()) continue;
    if (options.all_positions) keep_position(plan.joint_word, plan, out);
    if (plan.joint_word == chosen || plan.role_given) continue;
    lose_role(plan, fmt::format("of joint '{}'", plan.joint_word));
  }
}

void choose_joint(const CsvOptions& options, std::vector<ColumnPlan>& plans, DataFile& out) {
  std::map<int, std::vector<std::size_t>> joints;
  std::set<int> given;  // of whose motion or torque a column was given its role by hand
  for (std::size_t j = 0; j < plans.size(); ++j) {
    const Role role = plans[j].reading.role;
    if (role == Role::none || role == Role::movement) continue;
    if (!plans[j].joint) continue;
    if (!plans[j].role_given) joints[*plans[j].joint].push_back(j);
    if (plans[j].role_given && is_of_one_joint(role)) given.insert(*plans[j].joint);
  }
  const std::optional<int> chosen =
      options.joint || given.size() != 1 ? options.joint : std::optional(*given.begin());
  if (chosen && given.contains(*chosen)) joints[*chosen];
  // "v2" is the other joint's velocity, unless --joint makes it the second's.
  if (options.joint) {
    for (std::size_t j = 0; j < plans.size(); ++j) {
      if (plans[j].reading.column != "v2" && plans[j].reading.column != "a2") continue;
      plans[j].reading.role = plans[j].reading.column == "v2" ? Role::velocity : Role::acceleration;
      joints[2].push_back(j);
    }
  }
  if (chosen && !joints.contains(*chosen)) {
    std::vector<int> known;
    for (const auto& [joint, columns] : joints) known.push_back(joint);
    throw_bad_input(fmt::format("no column is of joint {}", *chosen), "--joint",
                    known.empty() ? "leave it out: no name holds a joint's number"
                                  : fmt::format("joints: {}", fmt::join(known, ", ")));
  }
  if (chosen) out.joint = fmt::format("{}", *chosen);
  if (joints.size() < 2) return;
  if (!chosen) {
    // Where the motion is told without a number, or by hand, the numbers are of others.
    const bool is_told = std::ranges::any_of(plans, [](const ColumnPlan& plan) {
      const Role role = plan.reading.role;
      return (role == Role::velocity && plan.doubt == 0) ||
             (plan.role_given && (role == Role::velocity || role == Role::position));
    });
    for (const auto& [joint, columns] : joints) {
      if (!is_told) out.joints.push_back(joint);
      for (const std::size_t j : columns) lose_role(plans[j], "of one of several joints");
    }
    return;
  }
  if (options.all_positions) {
    for (const auto& [joint, columns] : joints) {
      for (const std::size_t j : columns) keep_position(fmt::format("{}", joint), plans[j], out);
    }
  }
  int neighbour = *chosen - 1;
  if (!joints.contains(neighbour)) neighbour = *chosen + 1;
  for (const auto& [joint, columns] : joints) {
    if (joint == *chosen) continue;
    for (const std::size_t j : columns) {
      ColumnReading& reading = plans[j].reading;
      if (joint == neighbour && reading.role == Role::velocity) {
        reading.role = Role::other_velocity;
      } else if (joint == neighbour && reading.role == Role::acceleration) {
        reading.role = Role::other_acceleration;
      } else {
        lose_role(plans[j], fmt::format("of joint {}", joint));
      }
    }
  }
}

std::string joints_that_stand_here(const DataFile& file) {
  return fmt::format("columns of the joints {} stand here", fmt::join(file.joints, ", "));
}

}  // namespace tribench
