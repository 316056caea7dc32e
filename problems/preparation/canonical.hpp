// SPDX-License-Identifier: MIT
//
// One recording can be told in many ways: mirrored, in other units, its movements in another order
// or under other names, its clock set to another hour. What is decided about it must not hang on
// that. Here is what makes it so:
//
//   order    the diagnosis runs on rows in an order that follows from their content alone
//   mirror   where a procedure has to call one direction the first, it asks mirror_sign
//   chance   every random draw comes from a stream with a fixed key (diagnosis.cpp,
//   judged_diagnosis.cpp): there is no
//            luck in a diagnosis, of a seed or of a name
//
// Multiplying a channel or the target by a power of two changes no decision and no bit but by that
// factor; times and temperatures enter as differences to their mean.
#pragma once

#include <vector>

#include "problems/preparation/observations.hpp"

namespace tribench::loop {

// The same recording, its movements ordered by their speed, size and load. Rows of a movement keep
// their order, movements their numbers. The movements of `last` (ascending) come after all others,
// whose order owes nothing to them.
struct Canonical {
  Observations data;
  std::vector<std::size_t> row_of;  // per row of `data`: its row as it was told

  // A mark per row of `data` as one per row as it was told.
  std::vector<char> as_told(const std::vector<char>& marks) const;
};
Canonical canonical(const Observations& told, const std::vector<int>& last = {});

// 1, or -1 in the mirrored recording (every signed quantity negated); 1 where it is its own mirror
// image.
double mirror_sign(const Observations& data);

}  // namespace tribench::loop
