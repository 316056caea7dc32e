// SPDX-License-Identifier: MIT
#include "problems/preparation/data_options_toml.hpp"

#include <fmt/format.h>

#include <limits>
#include <optional>

namespace tribench {
namespace {

std::optional<double> positive(const TomlTable& table, std::string_view key, double high) {
  if (!table.has(key)) return {};
  double value = 0;
  table.read(key, value, std::numeric_limits<double>::min(), high);
  return value;
}

std::string text(const TomlTable& table, std::string_view key) {
  std::string value;
  table.read(key, value);
  return value;
}

std::string role_text(const GivenRole& given) {
  if (given.in.unit == nullptr) return std::string(role_name(given.role));
  return fmt::format("{}[{}]", role_name(given.role), given.in.symbol());
}

}  // namespace

const std::vector<std::string>& data_option_keys() {
  static const std::vector<std::string> kKeys = {
      "roles",           "joint",      "where",           "drop_missing", "flip_sign",
      "counts_per_turn", "gear_ratio", "torque_constant", "sample_rate"};
  return kKeys;
}

DataOptions read_data_options(const TomlTable& table) {
  DataOptions options;
  options.roles = parse_roles(text(table, "roles"), table.place("roles"));
  options.where = text(table, "where");
  if (table.has("where")) options.where_place = table.place("where");
  table.read("drop_missing", options.drop_missing);
  table.read("flip_sign", options.flip_sign);
  if (table.has_text("joint")) {
    options.choose_joint(text(table, "joint"), table.place("joint"));
  } else if (table.has("joint")) {
    int joint = 0;
    table.read("joint", joint, 0, kMostJoints);
    options.joint = joint;
  }
  options.drive.counts_per_turn = positive(table, "counts_per_turn", kMostCounts);
  options.sample_rate = positive(table, "sample_rate", kLargestSampleRate);
  options.drive.gear_ratio = positive(table, "gear_ratio", kLargestGearRatio);
  if (table.has("torque_constant")) {
    options.torque_constant =
        parse_torque_constant(text(table, "torque_constant"), table.place("torque_constant"));
  }
  return options;
}

void insert_data_options(toml::table& table, const DataOptions& options) {
  std::string roles;
  for (const auto& [column, given] : options.roles) {
    const bool quoted = column.find_first_of(",=[]\"") != std::string::npos;
    roles += fmt::format("{}{}={}", roles.empty() ? "" : ",",
                         quoted ? fmt::format("\"{}\"", column) : column, role_text(given));
  }
  if (!roles.empty()) table.insert("roles", roles);
  if (!options.where.empty()) table.insert("where", options.where);
  if (options.joint) table.insert("joint", *options.joint);
  if (!options.joint_word.empty()) table.insert("joint", options.joint_word);
  if (options.drop_missing) table.insert("drop_missing", true);
  if (options.flip_sign) table.insert("flip_sign", true);
  if (options.drive.gear_ratio) table.insert("gear_ratio", *options.drive.gear_ratio);
  if (options.drive.counts_per_turn) {
    table.insert("counts_per_turn", *options.drive.counts_per_turn);
  }
  if (options.sample_rate) table.insert("sample_rate", *options.sample_rate);
  if (options.torque_constant) {
    table.insert("torque_constant", fmt::format("{}{}", options.torque_constant->value,
                                                options.torque_constant->at_motor ? "@motor" : ""));
  }
}

}  // namespace tribench
