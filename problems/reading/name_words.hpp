// SPDX-License-Identifier: MIT
//
// The words that columns' names are made of, and what single ones of them say. What a whole name
// says: channel_names.hpp. Internal to the room.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tribench {

using Words = std::vector<std::string>;

// Letters of other alphabets as those that names are listed in: accents off, Greek ones by name;
// and LaTeX's signs off.
std::string in_plain_letters(std::string_view text);

// "jointPos.velDeg[2]" as joint, Pos, vel, Deg, 2; without `humps` as jointPos, velDeg, 2.
Words split_words(std::string_view text, bool humps);

// The words from `begin` up to `end`, apart by '_'.
std::string joined(const Words& words, std::size_t begin, std::size_t end);

// Of a word in any case: that it names the setting and not the measurement ("desired"); that it
// adds nothing to what a channel is ("measured"); that what it is said of is not the joint ("bus",
// "gripper") or no measurement of it ("gravity", "delay").
bool is_set_point(std::string_view word);
bool is_filler(std::string_view word);
bool is_elsewhere(std::string_view word);
bool is_no_measurement(std::string_view word);
// That it stands before a joint's number ("joint", "axis", "j").
bool is_joint_word(std::string_view word);

// Whether a word of the name says that it is no measurement of the joint: a set point, an error, a
// limit; a bus, a tool; a phase; how long something took.
bool names_something_else(std::string_view name);

// Whether a word, or one of the name, says the motor.
bool is_motor_word(std::string_view word);
bool names_motor(std::string_view name);

// Whether a word of the name says that it tells joints apart.
bool names_joint(std::string_view name);

// Whether the name is no more than a date's.
bool names_date(std::string_view name);

}  // namespace tribench
