// SPDX-License-Identifier: MIT
//
// The search for missing effects on training movements: rounds of tests, additions by
// cross-validated gain, what is next to nothing left out, and the test for what is left over.
// Internal to the room.
#pragma once

#include <compare>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/campaign/search_state.hpp"
#include "algorithms/diagnosis/first_look.hpp"

namespace tribench::loop {

struct SearchResult {
  FittedModel base;
  SearchState state;
  FirstLook first;
  LeftoverFinding leftover;
  std::vector<std::size_t> taken;  // families, before any gave way to the leftover
  // Families that the search ended with, whichever way it had begun, before any was taken out.
  std::set<std::size_t> tried;
  FittedModel whole;  // the model with all of them
};

// What is noise in a recording, as the rich model leaves it, and the bursts in it.
struct FirstNoise {
  Eigen::VectorXd residual;  // of every row
  std::vector<EventFinding> events;
  std::vector<char> masked;  // per row: part of an event
};

// How a search begins.
struct SearchStart {
  std::vector<std::size_t> left_out;          // families
  std::vector<std::size_t> last_resort = {};  // families with their atoms of last resort
  // From the end of the search that left nothing out, without these families, not from the base.
  bool goes_on = false;

  // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 takes what <=> compares with for a pointer
  auto operator<=>(const SearchStart&) const = default;
};

// What the searches of a campaign began with, what they ended with before anything was taken out,
// and what they left over by what was still in them then.
struct KnownSearch {
  std::vector<double> gear_ratios;  // of the campaign, where they are not the ones told
  std::optional<FirstNoise> noise;
  std::optional<SearchResult> start;
  std::map<SearchStart, SearchResult> ends;
  std::map<std::pair<SearchStart, std::vector<std::size_t>>, SearchResult> leftovers;
};

struct KnownSearches {
  KnownSearch plain;
  KnownSearch with_ripple;  // the same once more, what repeats taken for a turn of the motor
};

// known: of the same campaign, or empty; it is added to.
// Cost: a round of tests an effect found, some fits each, and one of the smoothers.
SearchResult search(const BaseModel& base, const Campaign& campaign, RandomStream random,
                    KnownSearch& known);

}  // namespace tribench::loop
