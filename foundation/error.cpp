// SPDX-License-Identifier: MIT
#include "foundation/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace tribench {
namespace {

std::string compose(std::string_view what, std::string_view place, std::string_view mend) {
  std::string text = place.empty() ? std::string(what) : fmt::format("{}: {}", place, what);
  if (!mend.empty()) text += fmt::format("; {}", mend);
  return text;
}

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

}  // namespace

Error::Error(ErrorKind kind, std::string_view what, std::string_view place, std::string_view mend)
    : std::runtime_error(compose(what, place, mend)), kind_(kind), place_(place), mend_(mend) {}

void throw_bad_input(std::string_view what, std::string_view place, std::string_view mend) {
  throw Error(ErrorKind::bad_input, what, place, mend);
}

std::string nearest_name(std::string_view word, const std::vector<std::string>& candidates) {
  const std::size_t limit = std::max<std::size_t>(2, word.size() / 3);
  std::string best;
  std::size_t best_distance = limit + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace tribench
