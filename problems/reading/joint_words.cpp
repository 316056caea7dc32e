// SPDX-License-Identifier: MIT
#include "problems/reading/joint_words.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>
#include <string_view>

#include "foundation/text.hpp"
#include "problems/reading/channel_names.hpp"
#include "problems/reading/name_words.hpp"

namespace tribench {
namespace {

// A name as whose it is and what.
struct OwnedName {
  std::string owner;
  std::string quantity;
  Role role = Role::none;
  bool in_path = false;  // the name tells its role by itself
};

bool begins_word(std::string_view text, std::size_t at) {
  const auto is = [&](std::size_t k, int (*test)(int)) {
    return test(static_cast<unsigned char>(text[k])) != 0;
  };
  return is(at, std::isalpha) &&
         (is(at - 1, std::isalnum) == 0 || (is(at, std::isupper) && is(at - 1, std::isupper) == 0));
}

// "base" is a joint's name beside others, but a place by itself.
bool names_another_place(const std::string& owner) {
  return std::ranges::any_of(split_words(owner, true), [](const std::string& word) {
    return names_something_else(word) && in_small_letters(word) != "base";
  });
}

OwnedName owned_name(const std::string& name) {
  const std::size_t end = std::min(name.find_first_of("[({"), name.size());
  const std::size_t cut = name.substr(0, end).find_last_of("./:");
  const std::size_t begin = cut == std::string::npos ? 0 : cut + 1;
  if (begin == 0 && read_channel_name(name).role != Role::none) return {};
  constexpr std::size_t kMostWords = 6;  // of a quantity and its unit
  std::vector<std::size_t> begins;
  for (std::size_t at = end; at-- > begin + 1 && begins.size() < kMostWords;) {
    if (begins_word(name, at)) begins.push_back(at);
  }
  if (begin > 0) begins.push_back(begin);
  std::ranges::reverse(begins);
  for (const std::size_t at : begins) {
    OwnedName owned{name.substr(0, at), name.substr(at), Role::none, at == begin};
    const NameReading reading = read_channel_name(owned.quantity);
    if (!is_of_one_joint(reading.role) || reading.joint) continue;
    if (names_another_place(owned.owner)) return {};
    owned.role = reading.role;
    return owned;
  }
  return {};
}

std::string without_digits(const std::string& text) {
  std::string rest;
  for (const char c : text) {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) rest += c;
  }
  return rest;
}

// The words by which each owner differs from the others.
std::vector<std::string> differing_words(const std::vector<std::string>& owners) {
  std::vector<Words> all;
  std::size_t shortest = owners.front().size();
  for (const std::string& owner : owners) {
    all.push_back(split_words(owner, true));
    shortest = std::min(shortest, all.back().size());
  }
  const auto is_shared = [&](auto place) {
    return std::ranges::all_of(all, [&](const Words& words) {
      return words[place(words)] == all.front()[place(all.front())];
    });
  };
  std::size_t first = 0;
  std::size_t last = 0;
  if (owners.size() > 1) {
    while (first + 1 < shortest && is_shared([&](const Words&) { return first; })) ++first;
    while (first + last + 1 < shortest &&
           is_shared([&](const Words& words) { return words.size() - 1 - last; })) {
      ++last;
    }
  }
  std::vector<std::string> parts;
  for (Words& words : all) {
    words.erase(words.end() - static_cast<std::ptrdiff_t>(last), words.end());
    while (words.size() > first + 1 && is_filler(words.back())) words.pop_back();
    parts.push_back(joined(words, first, words.size()));
  }
  return parts;
}

bool tells_motion_or_torque(const std::string& name) {
  return is_of_one_joint(read_channel_name(name).role);
}

// Owners of two quantities and more, in the order of the file.
std::vector<std::string> owners_of_joints(const std::vector<OwnedName>& names) {
  std::map<std::string, std::set<Role>> roles;
  std::vector<std::string> owners;
  for (const OwnedName& name : names) {
    if (name.role != Role::none) roles[name.owner].insert(name.role);
  }
  for (const OwnedName& name : names) {
    const bool is_known = std::ranges::count(owners, name.owner) > 0;
    if (name.role != Role::none && !is_known && roles[name.owner].size() > 1) {
      owners.push_back(name.owner);
    }
  }
  return owners;
}

}  // namespace

bool is_of_one_joint(Role role) {
  constexpr std::array kRoles = {Role::position, Role::velocity, Role::acceleration,
                                 Role::motor_torque, Role::motor_current};
  return std::ranges::count(kRoles, role) > 0;
}

bool names_processing(const std::string& part) {
  constexpr std::array kWords = {"raw",   "filt", "smooth", "meas", "act",    "est",
                                 "motor", "link", "output", "load", "encoder"};
  return std::ranges::any_of(
      kWords, [&](const char* word) { return part.find(word) != std::string::npos; });
}

std::vector<JointWord> joint_words_of(const std::vector<std::string>& header) {
  std::vector<JointWord> told(header.size());
  std::vector<OwnedName> names;
  for (const std::string& name : header) names.push_back(owned_name(name));
  const std::vector<std::string> owners = owners_of_joints(names);
  if (owners.empty()) return told;
  if (owners.size() == 1) {
    const bool is_told =
        names_something_else(owners.front()) ||
        std::ranges::any_of(header, tells_motion_or_torque) ||
        std::ranges::any_of(names, [](const OwnedName& name) { return name.in_path; });
    if (is_told) return told;
  } else if (std::ranges::all_of(owners, [&](const std::string& owner) {
               return without_digits(owner) == without_digits(owners.front());
             })) {
    return told;
  }
  const std::vector<std::string> parts = differing_words(owners);
  if (std::ranges::any_of(parts, names_processing)) return told;
  if (std::set<std::string>(parts.begin(), parts.end()).size() < parts.size()) return told;
  for (std::size_t j = 0; j < header.size(); ++j) {
    const auto owner = std::ranges::find(owners, names[j].owner);
    if (names[j].role == Role::none || owner == owners.end()) continue;
    told[j] = {parts[static_cast<std::size_t>(owner - owners.begin())], names[j].quantity};
  }
  return told;
}

}  // namespace tribench
