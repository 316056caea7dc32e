// SPDX-License-Identifier: MIT
//
// Joints that the columns' names tell apart by words: "shoulder_pan_position", "elbow_position",
// "/arm/wrist_1_joint/effort". Internal to the room.
#pragma once

#include <string>
#include <vector>

#include "problems/dataset.hpp"

namespace tribench {

// Of one column: the joint's word ("elbow", "wrist_1"), and what of the name says the quantity
// ("position"). The word is empty where it tells no joint.
struct JointWord {
  std::string word;
  std::string quantity;
};

// Per column. Words tell joints where columns of two quantities and more stand behind each of them;
// what differs by its number alone is read by that (channel_names.hpp). One word tells a joint
// where no other column says a motion or a torque.
std::vector<JointWord> joint_words_of(const std::vector<std::string>& header);

// Whether a joint has one such: position, velocity, acceleration, what its motor gives.
bool is_of_one_joint(Role role);

// "filtered_velocity" and "raw_velocity" are of one joint: parts of such words.
bool names_processing(const std::string& part);

}  // namespace tribench
