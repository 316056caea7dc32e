// SPDX-License-Identifier: MIT
//
// What to offer where a name is not known. Not for accepting it: a name that is only near is
// refused all the same.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tribench {

// The candidate that differs in upper and lower case alone, else the closest to `word` by edit
// distance; empty where none is near (more than a third of the word's length, at least 2, or all of
// it would have to change), except a candidate in parts (peer/friction1d) whose last part is the
// word, and one that begins with the word's three letters or more. Cost: the product of the lengths
// a candidate.
std::string nearest_name(std::string_view word, const std::vector<std::string>& candidates);

// The mend of an Error about an unknown name: "did you mean NAME?" where one is near, else
// `otherwise`, else "known: a, b, ..." with the first candidates. Empty where there are none.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates,
                         std::string_view otherwise = {});

}  // namespace tribench
