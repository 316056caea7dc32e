// SPDX-License-Identifier: MIT
#include "problems/reading/channel_names.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

#include "foundation/text.hpp"
#include "problems/reading/name_words.hpp"

namespace tribench {
namespace {

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_lower(char c) { return std::islower(static_cast<unsigned char>(c)) != 0; }

template <std::size_t N>
bool is_among(const std::array<std::string_view, N>& list, std::string_view word) {
  return std::ranges::find(list, word) != list.end();
}

const ChannelAlias* find_alias(std::string_view name) {
  const std::string wanted = in_small_letters(name);
  for (const ChannelAlias& alias : channel_aliases()) {
    if (alias.name == wanted) return &alias;
  }
  return nullptr;
}

void take_alias(NameReading& reading, const ChannelAlias& alias) {
  reading.role = alias.role;
  reading.source = alias.source;
  if (reading.known.unit == nullptr && !alias.unit.empty()) {
    reading.known.unit = find_unit(alias.unit);
  }
}

// A name that is in the list as it stands.
bool read_whole_name(std::string_view text, NameReading& reading) {
  // Time and temperature differ by case alone where no unit tells; so does a torque.
  const bool is_t = text == "T" || text == "t";
  for (const Role role : {Role::motor_torque, Role::temperature, Role::time}) {
    if (!is_t || reading.known.unit == nullptr || !reading.unit_written) break;
    if (reading.known.unit->dimension == Dimension::current || !suits(*reading.known.unit, role)) {
      continue;
    }
    reading.role = role;
    if (role == Role::motor_torque) reading.doubt = 3;
    return true;
  }
  if (text == "T") {
    reading.role = Role::temperature;
    reading.source = "tribench";
    if (reading.known.unit == nullptr) reading.known.unit = find_unit("degC");
    return true;
  }
  const ChannelAlias* alias = find_alias(text);
  if (alias == nullptr) return false;
  if (alias->by_unit) {
    if (reading.known.unit == nullptr || !suits(*reading.known.unit, alias->role)) return false;
    reading.doubt = 3;
  }
  take_alias(reading, *alias);
  return true;
}

// What a name without its unit says; false: nothing that is known.
bool read_stem(std::string_view text, NameReading& reading) {
  if (read_whole_name(text, reading)) return true;
  Words all;
  Words without_letter;  // "AXIS_ACT" of "AXIS_ACT_A4"
  Words kept;
  bool motor = false;
  std::optional<std::size_t> behind_joint;  // words that are kept before the joint's number
  bool numbers_joint = false;               // the word before a number
  for (std::string word : split_words(text, true)) {
    if (is_set_point(word)) return false;
    const std::size_t letters = word.find_last_not_of("0123456789") + 1;
    const bool numbered = letters < word.size() && word.size() - letters < 4;
    if (numbered) {
      reading.joint = std::stoi(word.substr(letters));
      word.resize(letters);
    }
    if (numbered && (word.empty() ? numbers_joint : is_joint_word(word)))
      behind_joint = kept.size();
    numbers_joint = is_joint_word(word);
    if (word.empty()) continue;
    motor = motor || is_motor_word(word);
    const bool letter =
        numbered && (in_small_letters(word) == "j" || in_small_letters(word) == "a");  // "A2", "j2"
    if (!letter && !is_filler(word)) kept.push_back(word);
    if (!letter) without_letter.push_back(word);
    all.push_back(std::move(word));
  }
  const ChannelAlias* alias = find_alias(joined(all, 0, all.size()));
  if (alias == nullptr) alias = find_alias(joined(without_letter, 0, without_letter.size()));
  if (alias == nullptr) alias = find_alias(joined(kept, 0, kept.size()));
  reading.doubt = 1;
  // "Current position" is the one of now.
  if (alias == nullptr && kept.size() > 1 && in_small_letters(kept.front()) == "current") {
    alias = find_alias(joined(kept, 1, kept.size()));
  }
  // "panda_joint4_position": what stands before the joint is whose it is.
  if (alias == nullptr && behind_joint) {
    const auto end = kept.begin() + static_cast<std::ptrdiff_t>(*behind_joint);
    const bool is_joints = std::none_of(kept.begin(), end, [](const std::string& word) {
      return is_elsewhere(word) || is_no_measurement(word);
    });
    if (is_joints) alias = find_alias(joined(kept, *behind_joint, kept.size()));
    if (alias != nullptr) reading.doubt = 2;
  }
  // "JSPEED" is a joint's.
  if (alias == nullptr && kept.size() == 1 && kept[0].size() > 3 &&
      in_small_letters(kept[0])[0] == 'j') {
    alias = find_alias(kept[0].substr(1));
  }
  if (alias == nullptr && motor) {
    std::erase_if(kept, is_motor_word);
    alias = find_alias(joined(kept, 0, kept.size()));
    if (alias == nullptr) return false;
    reading.at_motor = true;
    reading.doubt = 2;
  }
  if (alias == nullptr || alias->by_unit) return false;
  take_alias(reading, *alias);
  return true;
}

// The unit in the last pair of brackets, which is taken off; a number there is the joint's.
std::string take_brackets(std::string_view& name) {
  while (!name.empty() && name.back() == ' ') name.remove_suffix(1);
  if (name.empty()) return {};
  constexpr std::array<std::string_view, 3> kPairs = {"[]", "()", "{}"};
  for (const std::string_view pair : kPairs) {
    if (name.back() != pair[1]) continue;
    const std::size_t open = name.rfind(pair[0]);
    if (open == std::string_view::npos || open == 0) return {};
    const std::string inside(name.substr(open + 1, name.size() - open - 2));
    if (!inside.empty() && std::ranges::all_of(inside, is_digit)) return {};
    name = name.substr(0, open);
    while (!name.empty() && (name.back() == ' ' || name.back() == '_')) name.remove_suffix(1);
    return inside;
  }
  return {};
}

// "deg" of "position in deg" and "angle_in_degrees".
std::string take_unit_behind_in(std::string_view& name) {
  const std::string small = in_small_letters(name);
  for (const std::string_view word : {" in ", "_in_"}) {
    const std::size_t at = small.rfind(word);
    if (at == std::string::npos || at == 0) continue;
    const std::string_view unit = name.substr(at + word.size());
    if (find_written_unit(unit).unit == nullptr) continue;
    name = name.substr(0, at);
    return std::string(unit);
  }
  return {};
}

// Words that are units in brackets alone: "position_in" is where something goes in,
// "joint_rotation" is no number of turns.
const Unit* find_unit_in_words(std::string_view word) {
  constexpr std::array<std::string_view, 7> kOtherWords = {"in",       "u",         "tr",   "d",
                                                           "rotation", "rotations", "tours"};
  return is_among(kOtherWords, in_small_letters(word)) ? nullptr : find_unit(word);
}

// Behind the last line "angle_0.01deg", what one count is (a larger number, "load_cell_10Nm", is a
// range), or "speed_1/min", whose stroke is no path's.
std::string take_last_word(std::string_view& name) {
  const std::size_t cut = name.find_last_of("_ ");
  if (cut == std::string_view::npos || cut == 0) return {};
  const std::string_view last = name.substr(cut + 1);
  const bool may_be_unit = last.starts_with("0.") || last.find('/') != std::string_view::npos;
  if (!may_be_unit || find_written_unit(last).unit == nullptr) return {};
  name = name.substr(0, cut);
  return std::string(last);
}

// What the end of a name may say, the usual first: a unit; one that has lost its stroke, "rads" of
// a velocity and "rads2"; several, "rads" of a position.
std::vector<const Unit*> units_at_the_end(const std::string& word) {
  std::vector<const Unit*> units = {find_unit_in_words(word)};
  for (const std::string_view second : {"s", "s2"}) {
    if (!word.ends_with(second)) continue;
    const std::string first = word.substr(0, word.size() - second.size());
    units.push_back(find_unit(first + "/" + std::string(second)));
    if (second == "s") units.push_back(find_unit(first));
  }
  std::erase(units, nullptr);
  return units;
}

// A unit as the last words: the longest that leaves a name that goes with it.
bool read_written_unit(const Words& words, NameReading& reading) {
  constexpr std::size_t kMostWords = 5;  // of a unit
  const std::size_t first = words.size() > kMostWords ? words.size() - kMostWords : 1;
  for (std::size_t cut = first; cut < words.size(); ++cut) {
    for (const Unit* unit : units_at_the_end(joined(words, cut, words.size()))) {
      NameReading stem;
      stem.known.unit = unit;
      if (!read_stem(joined(words, 0, cut), stem) || !suits(*unit, stem.role)) continue;
      reading = stem;
      reading.unit_written = true;
      return true;
    }
  }
  return false;
}

// "deg_position": a unit as the first word, where that means nothing else ("turn_angle" may).
bool read_unit_first(std::string_view name, NameReading& reading) {
  constexpr std::array<std::string_view, 6> kPlainUnits = {"deg",  "degrees", "rad",
                                                           "mrad", "radians", "rpm"};
  const Words words = split_words(name, false);
  if (words.size() < 2 || !is_among(kPlainUnits, in_small_letters(words.front()))) return false;
  NameReading stem;
  stem.known.unit = find_unit(words.front());
  stem.unit_written = true;
  if (!read_stem(joined(words, 1, words.size()), stem) || !suits(*stem.known.unit, stem.role)) {
    return false;
  }
  reading = stem;
  return true;
}

// The unit of a channel without a role, for show: only as it is usually written.
void read_unit_alone(std::string_view name, NameReading& reading) {
  for (std::size_t at = name.find('_'); at != std::string_view::npos; at = name.find('_', at + 1)) {
    const std::string_view last = name.substr(at + 1);
    const Unit* unit = find_unit_in_words(last);
    if (unit == nullptr || unit->symbol == "h" || unit->symbol == "d") continue;  // "start_hour"
    const bool is_any_letter = is_lower(last.front()) || unit->dimension == Dimension::time;
    if (last.size() == 1 && is_any_letter && unit->si != last) continue;
    reading = {};
    reading.known.unit = unit;
    reading.unit_written = true;
    return;
  }
}

// "angle_deg [deg]": the last words say a unit as the brackets do; "angle_deg [rad]" says none.
bool read_unit_twice(std::string_view name, const NameReading& reading, NameReading& written) {
  const bool is_read = read_written_unit(split_words(name, false), written) ||
                       read_written_unit(split_words(name, true), written);
  const Unit& in_brackets = *reading.known.unit;
  if (!is_read || written.known.unit->dimension != in_brackets.dimension) return false;
  written.at_motor = written.at_motor || reading.at_motor;
  if (written.known.unit != &in_brackets) {
    written.unknown_unit = std::string(written.known.unit->symbol) + " or ";
    written.unknown_unit += in_brackets.symbol;
    written.unit_written = false;
    written.known = {};
  } else {
    written.known = reading.known;
  }
  return true;
}

// A name without a sign prefix and a path before it.
NameReading read_last(std::string_view whole) {
  std::string_view name = whole;
  std::string inside = take_brackets(name);
  if (inside.empty()) inside = take_unit_behind_in(name);
  if (inside.empty()) inside = take_last_word(name);
  NameReading reading;
  reading.known = find_written_unit(inside);
  reading.at_motor = reading.known.at_motor;
  reading.unit_written = reading.known.unit != nullptr;
  if (!inside.empty() && reading.known.unit == nullptr) reading.unknown_unit = inside;
  NameReading plain = reading;
  NameReading written;
  if (read_whole_name(name, plain)) {
    reading = plain;
  } else if (!reading.unit_written && (read_written_unit(split_words(name, false), written) ||
                                       read_written_unit(split_words(name, true), written))) {
    reading = written;
  } else if (read_stem(name, plain)) {
    reading = plain;
  } else if (reading.unit_written && read_unit_twice(name, reading, written)) {
    reading = written;
  } else if (!reading.unit_written && read_unit_first(name, written)) {
    reading = written;
  } else if (!reading.unit_written) {
    read_unit_alone(name, reading);
  }
  // A unit that suits no such role is none, unless the name's source has it so.
  if (reading.known.unit != nullptr && reading.role != Role::none && reading.unit_written &&
      !suits(*reading.known.unit, reading.role)) {
    reading.unknown_unit = std::string(reading.known.unit->symbol);
    reading.known = {};
    reading.unit_written = false;
  }
  return reading;
}

// A name without a sign prefix. Where it tells nothing as a whole the last part of a path does:
// "/js/position_deg", "MAIN.fbAxis.ActPos [deg]".
NameReading read_plain(std::string_view name) {
  constexpr std::string_view kData = ".Data";  // of a signal of Simulink's
  if (name.ends_with(kData)) name.remove_suffix(kData.size());
  NameReading whole = read_last(name);
  const std::size_t cut = name.substr(0, name.find_first_of("[({")).find_last_of("./:");
  if (whole.role != Role::none || cut == std::string_view::npos || cut + 1 == name.size()) {
    return whole;
  }
  std::optional<int> joint;
  for (const std::string& word : split_words(name.substr(0, cut), true)) {
    const std::string plain = in_small_letters(word);
    if (is_set_point(plain) || is_elsewhere(plain)) return whole;
    const std::size_t letters = plain.find_last_not_of("0123456789") + 1;
    if (letters < plain.size() && plain.size() - letters < 4)
      joint = std::stoi(plain.substr(letters));
  }
  NameReading last = read_last(name.substr(cut + 1));
  if (last.role == Role::none) return whole;
  last.doubt += 2;
  if (!last.joint) last.joint = joint;
  return last;
}

}  // namespace

std::string_view without_unit(std::string_view name) {
  take_brackets(name);
  return name;
}

NameReading read_channel_name(std::string_view name) {
  const std::string plain = in_plain_letters(name);
  name = plain;
  constexpr std::string_view kSign = "sgn_";
  NameReading reading;
  if (!name.starts_with(kSign)) {
    reading = read_plain(name);
  } else {
    const Role of = read_plain(name.substr(kSign.size())).role;
    if (of == Role::velocity) reading.role = Role::velocity_sign;
    if (of == Role::gravity_torque) reading.role = Role::gravity_sign;
  }
  reading.unit = reading.known.unit != nullptr ? reading.known.symbol() : "-";
  return reading;
}

bool is_torque_like(Role role) {
  return role == Role::gravity_torque || role == Role::motor_torque ||
         role == Role::friction_torque || role == Role::external_torque ||
         role == Role::motor_current;
}

}  // namespace tribench
