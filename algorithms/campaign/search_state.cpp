// SPDX-License-Identifier: MIT
#include "algorithms/campaign/search_state.hpp"

#include <algorithm>
#include <utility>

namespace tribench::loop {

std::vector<std::size_t> SearchState::families() const {
  std::vector<std::size_t> all;
  for (const Found& one : found) all.push_back(one.family);
  return all;
}

void SearchState::note(std::string text) {
  if (std::ranges::count(notes, text) == 0) notes.push_back(std::move(text));
}

}  // namespace tribench::loop
