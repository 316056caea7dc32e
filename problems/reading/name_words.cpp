// SPDX-License-Identifier: MIT
#include "problems/reading/name_words.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include "foundation/text.hpp"

namespace tribench {
namespace {

// Words that name the setting and not the measurement.
constexpr std::array<std::string_view, 22> kSetPoints = {
    "desired",   "des",    "commanded", "command", "cmd",   "target",  "goal", "ref",
    "reference", "set",    "setpoint",  "demand",  "error", "err",     "min",  "max",
    "limit",     "offset", "bias",      "std",     "soll",  "sollwert"};

// Words that add nothing to what a channel is.
constexpr std::array<std::string_view, 36> kFillers = {
    "joint",    "joints",    "state", "states",  "actual", "act",   "measured", "meas",     "msr",
    "axis",     "robot",     "arm",   "link",    "value",  "val",   "feedback", "fb",       "raw",
    "filtered", "filt",      "data",  "msg",     "output", "jnt",   "ax",       "actuator", "drive",
    "estimate", "estimated", "est",   "present", "active", "field", "sensor",   "fbk",      "ist"};

// In a path before the last name ("/dc_bus/current"): what is measured there is not the joint.
constexpr std::array<std::string_view, 18> kElsewhere = {
    "bus", "dc",  "supply", "battery", "tcp",     "tool",   "tool0", "cartesian", "ee",
    "fan", "imu", "brake",  "base",    "gripper", "wrench", "ft",    "gps",       "odom"};

// In a name that would be known by its unit alone: what is no measurement of the joint.
constexpr std::array<std::string_view, 40> kNoMeasurement = {
    "phase",   "electrical", "elec",   "el",           "cycle",      "period",      "duration",
    "delay",   "latency",    "jitter", "dt",           "delta",      "diff",        "lag",
    "age",     "timeout",    "exec",   "step",         "ambient",    "room",        "ground",
    "support", "peak",       "rated",  "deadband",     "slip",       "gravity",     "grav",
    "rigid",   "model",      "comp",   "compensation", "ff",         "feedforward", "coriolis",
    "inertia", "friction",   "ext",    "external",     "disturbance"};

// Before a number they say whose joint it is.
constexpr std::array<std::string_view, 12> kJointWords = {
    "joint", "jnt", "j", "axis", "ax", "a", "achse", "gelenk", "dof", "drive", "motor", "actuator"};

template <std::size_t N>
bool is_in(const std::array<std::string_view, N>& list, std::string_view word) {
  return std::ranges::find(list, in_small_letters(word)) != list.end();
}

// The first byte (in UTF-8) of a sign of China's or Japan's; any byte of no letter of ASCII's.
bool begins_sign(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte >= 0xE3 && byte <= 0xE9;
}
bool is_foreign(char c) { return static_cast<unsigned char>(c) >= 128; }

}  // namespace

// Letters of other alphabets as those that names are listed in: accents off, Greek ones by name;
// and LaTeX's signs off.
std::string in_plain_letters(std::string_view text) {
  struct Letter {
    std::string_view written;
    std::string_view plain;
  };
  static constexpr std::array kLetters = {
      Letter{"\xC3\xA0", "a"},     Letter{"\xC3\xA1", "a"},     Letter{"\xC3\xA3", "a"},
      Letter{"\xC3\xA7", "c"},     Letter{"\xC3\xA8", "e"},     Letter{"\xC3\xA9", "e"},
      Letter{"\xC3\x89", "E"},     Letter{"\xC3\xAA", "e"},     Letter{"\xC3\xAD", "i"},
      Letter{"\xC3\xB3", "o"},     Letter{"\xC3\xB4", "o"},     Letter{"\xC3\xBA", "u"},
      Letter{"\xC3\x81", "A"},     Letter{"\xC4\x85", "a"},     Letter{"\xC4\x87", "c"},
      Letter{"\xC4\x99", "e"},     Letter{"\xC5\x9B", "s"},     Letter{"\xC5\x82", "l"},
      Letter{"\xCE\xB8", "theta"}, Letter{"\xCF\x89", "omega"}, Letter{"\xCF\x84", "tau"},
      Letter{"\xCF\x86", "phi"},   Letter{"\xCF\x95", "phi"},   Letter{"$", ""},
      Letter{"（", "("},           Letter{"）", ")"},           Letter{"关节", "joint"},
      Letter{"関節", "joint"},     Letter{"电机", "motor_"},
  };
  std::string plain;
  while (!text.empty()) {
    const auto* const letter = std::ranges::find_if(
        kLetters, [&](const Letter& one) { return text.starts_with(one.written); });
    const bool is_listed = letter != kLetters.end();
    plain += is_listed ? letter->plain : text.substr(0, 1);
    text.remove_prefix(is_listed ? letter->written.size() : 1);
  }
  return plain;
}

Words split_words(std::string_view text, bool humps) {
  Words words;
  std::string word;
  const auto end_word = [&] {
    if (!word.empty()) words.push_back(std::move(word));
    word.clear();
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && static_cast<unsigned char>(c) < 128) {
      end_word();
      continue;
    }
    const bool begins = std::isupper(static_cast<unsigned char>(c)) != 0 || begins_sign(c);
    const bool ends = i > 0 && !is_foreign(text[i - 1]) &&
                      std::isupper(static_cast<unsigned char>(text[i - 1])) == 0;
    if (humps && begins && ends) end_word();
    word += c;
  }
  end_word();
  return words;
}

std::string joined(const Words& words, std::size_t begin, std::size_t end) {
  std::string text;
  for (std::size_t i = begin; i < end; ++i) text += (i > begin ? "_" : "") + words[i];
  return text;
}

bool is_set_point(std::string_view word) { return is_in(kSetPoints, word); }
bool is_filler(std::string_view word) { return is_in(kFillers, word); }
bool is_elsewhere(std::string_view word) { return is_in(kElsewhere, word); }
bool is_no_measurement(std::string_view word) { return is_in(kNoMeasurement, word); }
bool is_joint_word(std::string_view word) { return is_in(kJointWords, word); }

bool names_something_else(std::string_view name) {
  return std::ranges::any_of(split_words(name, true), [](const std::string& word) {
    return is_set_point(word) || is_elsewhere(word) || is_no_measurement(word);
  });
}

bool is_motor_word(std::string_view word) {
  const std::string small = in_small_letters(word);
  return small == "motor" || small == "mot";
}

bool names_motor(std::string_view name) {
  return std::ranges::any_of(split_words(name, true), is_motor_word);
}

bool names_joint(std::string_view name) {
  constexpr std::array<std::string_view, 11> kWords = {"joint", "axis", "achse", "motor",
                                                       "drive", "dof",  "name",  "actuator",
                                                       "id",    "node", "gelenk"};
  return std::ranges::any_of(split_words(name, true),
                             [&](const std::string& word) { return is_in(kWords, word); });
}

bool names_date(std::string_view name) {
  const std::string plain = in_small_letters(name);
  return plain == "date" || plain == "datum";
}

}  // namespace tribench
