// SPDX-License-Identifier: MIT
//
// A data file either is refused with a place, or is read whole; what is written of it is read again
// to the same numbers.
#include <optional>
#include <sstream>
#include <string>

#include "problems/reading/csv.hpp"
#include "problems/reading/explanation.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace tribench;

void expect_same(const Dataset& before, const Dataset& after) {
  fuzz::expect(before.channels.size() == after.channels.size(), "a channel is lost");
  for (std::size_t c = 0; c < before.channels.size(); ++c) {
    fuzz::expect(before.channels[c].name == after.channels[c].name, "a name changes");
    fuzz::expect(before.channels[c].values == after.channels[c].values, "a number changes");
  }
  fuzz::expect(before.movement == after.movement, "movements change");
}

void try_data(std::string_view text, bool drop_missing) {
  CsvOptions options;
  options.drop_missing = drop_missing;
  DataFile file;
  if (!fuzz::reads([&] { file = parse_csv(text, "data.csv", options); })) return;
  for (const Channel& channel : file.data.channels) {
    fuzz::expect(channel.values.size() == file.data.rows(), "a channel has other rows");
    // What was converted is written in SI under its old name.
    GivenRole role(channel.role);
    if (channel.role != Role::none) role.in.unit = find_unit(channel.unit);
    options.roles[channel.name] = role;
  }
  // What could not be converted (a motor's angle, and no gear ratio) is written as it was.
  for (const ColumnReading& reading : file.readings) {
    const auto role = options.roles.find(reading.column);
    if (reading.needs.empty() || role == options.roles.end()) continue;
    role->second.in = find_written_unit(reading.unit);
  }
  std::ostringstream written;
  write_csv(file.data, written);
  expect_same(file.data, parse_csv(written.str(), "written.csv", options).data);
}

// Columns that nobody asked for never make a file wrong that is right without them.
void try_spare_columns(std::string_view text) {
  CsvOptions options;
  options.used = std::vector<std::string>();
  DataFile file;
  if (!fuzz::reads([&] { file = parse_csv(text, "data.csv", options); })) return;
  options.spare = true;
  const DataFile whole = parse_csv(text, "data.csv", options);
  fuzz::expect(whole.data.channels.size() == file.data.channels.size() + whole.spare.size(),
               "a channel is lost");
  fuzz::expect(whole.data.rows() == file.data.rows(), "a row is lost");
  for (const Channel& channel : file.data.channels) {
    fuzz::expect(whole.data.at(channel.name).values == channel.values, "a number changes");
  }
}

// Of an arm's columns those of one joint: other roles, the same rows.
void try_joint(std::string_view text, std::optional<int> number, const std::string& word) {
  CsvOptions options;
  options.used = std::vector<std::string>();
  options.joint = number;
  options.joint_word = word;
  options.all_positions = true;
  options.drop_missing = true;
  options.sample_rate = 500;
  DataFile file;
  if (!fuzz::reads([&] { file = parse_csv(text, "arm.csv", options); })) return;
  for (const Channel& channel : file.data.channels) {
    fuzz::expect(channel.values.size() == file.data.rows(), "a channel has other rows");
  }
  for (const auto& [joint, column] : file.joint_positions) {
    fuzz::expect(file.data.find(column) != nullptr, "a joint's position is no channel");
  }
  explanation(file);
}

}  // namespace

TRIBENCH_FUZZ_TARGET(csv) {
  try_data(input, false);
  try_data(input, true);
  try_spare_columns(input);
  try_joint(input, 2, {});
  try_joint(input, {}, "elbow");
}
