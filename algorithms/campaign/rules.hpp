// SPDX-License-Identifier: MIT
//
// The rules of the search that can be left out one at a time, as data: what each is for, so that a
// study can say what each of them is worth (tribench study loop --without RULE). Not for use in a
// diagnosis that anybody acts on.
#pragma once

#include <span>
#include <string_view>

namespace tribench::loop {

struct Rule {
  std::string_view name;
  std::string_view purpose;
};

std::span<const Rule> rules();

// Throws Error (bad_input) with the nearest name where there is no such rule.
const Rule& find_rule(std::string_view name);

}  // namespace tribench::loop
