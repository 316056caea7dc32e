// SPDX-License-Identifier: MIT
//
// What a search has taken so far: a model and the families in it. It is the search that changes it,
// and what looks for the leftover.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "algorithms/campaign/fitted_model.hpp"

namespace tribench::loop {

// A family that was taken, in the order picked.
struct Found {
  std::size_t family = 0;
  double p = 1;
  Gain gain;         // beside the others, in the end
  bool few = false;  // carried by few movements
  std::vector<AliasFinding> aliases;
  bool another_shape = false;  // this cause, a curve that the library does not have
  bool stands_in = false;      // maybe, for what differs from movement to movement
};

// A model and the families in it.
struct SearchState {
  FittedModel model;
  std::vector<Found> found;
  std::vector<std::size_t> left_out;    // next to nothing: not tried again
  std::vector<std::string> given_up;    // atoms that others of their family took the place of
  std::vector<std::size_t> asked_more;  // families that would have taken a third column
  std::vector<std::string> notes;

  std::vector<std::size_t> families() const;
  void note(std::string text);  // once
};

}  // namespace tribench::loop
