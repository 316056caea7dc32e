// SPDX-License-Identifier: MIT
//
// Measured or generated data: named channels with units and roles, cut into movements.
// A movement (one recorded motion) is the unit of independence: splits, folds and bootstraps
// never cut one.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace tribench {

// What a channel is physically.
enum class Role {
  none,
  time,
  movement,
  position,
  velocity,
  velocity_sign,  // -1, 0, 1
  acceleration,
  gravity_torque,
  gravity_sign,
  motor_torque,
  friction_torque,
  external_torque,
  temperature,
  motor_current,
  other_velocity,  // of another joint
  other_acceleration,
};

std::string_view role_name(Role role);
// Throws Error (bad_input) at `place` with the nearest name.
Role find_role(std::string_view name, std::string_view place = {});

struct Channel {
  std::string name;
  std::string unit;  // SI symbol, "-" for none
  Role role = Role::none;
  std::vector<double> values;
  std::string formula = {};  // over q, the position, where it is no column of the source: "sin(q)"
};

// A column of the source that is no channel, since it holds text: what stands in it, and where.
struct TextCell {
  std::string column;
  std::string text;
  std::string place;  // "joint.csv:2:label"
};

// All channels have the same number of rows. Rows of one movement stand together.
struct Dataset {
  std::string name;
  std::vector<Channel> channels;
  std::vector<int> movement;                // per row: index into movement_names
  std::vector<std::string> movement_names;  // in the order of the file, which is the campaign's
  std::vector<TextCell> texts = {};         // one a column, for messages
  bool torques_flipped = false;             // by flip_torques: what to mend is another thing then

  std::size_t rows() const { return movement.size(); }
  const Channel* find(std::string_view channel_name) const;
  const Channel* find(Role role) const;  // the first with that role
  // As `find`, but throws Error (bad_input) with the text that the column holds, or the nearest
  // name.
  const Channel& at(std::string_view channel_name) const;
};

// The channels by name, for who asks for many: `find` alone looks at one after the other. Of data
// that stay where they are and as they are.
class ChannelIndex {
 public:
  explicit ChannelIndex(const Dataset& data);
  const Channel* find(std::string_view channel_name) const;
  const Dataset& data() const { return data_; }

 private:
  const Dataset& data_;
  std::unordered_map<std::string_view, const Channel*> by_name_;  // the first of a name
};

// What to write in place of a list in a cell, "[0.1, 0.2]", which is no number; empty for others.
std::string mend_for_list(std::string_view column, std::string_view cell);

// Lets a movement begin in each of these rows, which increase: 'NAME, part 1', 'NAME, part 2'.
void cut_movements(Dataset& data, std::span<const std::size_t> first_rows);

}  // namespace tribench
