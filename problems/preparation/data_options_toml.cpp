// SPDX-License-Identifier: MIT
#include "problems/preparation/data_options_toml.hpp"

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
  table.read("drop_missing", options.drop_missing);
  table.read("flip_sign", options.flip_sign);
  if (table.has("joint")) {
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

}  // namespace tribench
