// SPDX-License-Identifier: MIT
#include "foundation/suggestion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <span>

namespace tribench {
namespace {

constexpr std::size_t kShown = 30;  // names of a list that a person still reads

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitute = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitute});
    }
  }
  return row[b.size()];
}

bool is_same_but_for_case(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return std::ranges::equal(a, b, {}, lower, lower);
}

}  // namespace

std::string nearest_name(std::string_view word, const std::vector<std::string>& candidates) {
  const auto same = std::ranges::find_if(candidates, [word](const std::string& candidate) {
    return !word.empty() && is_same_but_for_case(candidate, word);
  });
  if (same != candidates.end()) return *same;
  // Something of the word stays: any name of two letters is near to one of one.
  const std::size_t limit = std::min(std::max<std::size_t>(2, word.size() / 3),
                                     std::max<std::size_t>(word.size(), 1) - 1);
  std::string best;
  std::size_t best_distance = limit + 1;
  for (const std::string& candidate : candidates) {
    // Lengths that differ by more cannot be nearer.
    const std::size_t longer = std::max(candidate.size(), word.size());
    if (longer - std::min(candidate.size(), word.size()) >= best_distance) continue;
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  if (!best.empty()) return best;
  // Of a name in parts the last is what people remember.
  const auto ends_in_it = std::ranges::find_if(candidates, [&](const std::string& candidate) {
    return !word.empty() && candidate.size() > word.size() && candidate.ends_with(word) &&
           candidate[candidate.size() - word.size() - 1] == '/';
  });
  if (ends_in_it != candidates.end()) return *ends_in_it;
  constexpr std::size_t kFewestLetters = 3;
  const auto begins_with_it = std::ranges::find_if(candidates, [&](const std::string& candidate) {
    return word.size() >= kFewestLetters && candidate.starts_with(word);
  });
  return begins_with_it == candidates.end() ? std::string() : *begins_with_it;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates,
                         std::string_view otherwise) {
  const std::string near = nearest_name(word, candidates);
  if (!near.empty()) return fmt::format("did you mean {}?", near);
  if (!otherwise.empty()) return std::string(otherwise);
  if (candidates.empty()) return {};
  const std::span shown = std::span(candidates).first(std::min(kShown, candidates.size()));
  const std::size_t hidden = candidates.size() - shown.size();
  return fmt::format("known: {}{}", fmt::join(shown, ", "),
                     hidden == 0 ? std::string() : fmt::format(" and {} more", hidden));
}

}  // namespace tribench
