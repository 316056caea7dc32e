// SPDX-License-Identifier: MIT
#include "problems/catalogue.hpp"

#include <fmt/format.h>

#include "foundation/error.hpp"
#include "problems/benchmark/entries.hpp"
#include "problems/kuka/entries.hpp"
#include "problems/kuka/planted_entries.hpp"
#include "problems/measured/entries.hpp"

namespace tribench {
namespace {

bool glob_matches(std::string_view glob, std::string_view text) {
  if (glob.empty()) return text.empty();
  if (glob.front() == '*') {
    for (std::size_t skip = 0; skip <= text.size(); ++skip) {
      if (glob_matches(glob.substr(1), text.substr(skip))) return true;
    }
    return false;
  }
  if (text.empty() || (glob.front() != '?' && glob.front() != text.front())) return false;
  return glob_matches(glob.substr(1), text.substr(1));
}

std::string suggestion(std::string_view name, const std::vector<ProblemEntry>& entries) {
  std::vector<std::string> names;
  for (const ProblemEntry& entry : entries) names.push_back(entry.name);
  const std::string near = nearest_name(name, names);
  return near.empty() ? std::string("see: tribench list problems")
                      : fmt::format("did you mean {}?", near);
}

}  // namespace

Catalogue::Catalogue(std::optional<std::filesystem::path> data) {
  kuka::add_entries(entries_);
  kuka::add_planted_entries(entries_);
  benchmark::add_entries(entries_, data);
  measured::add_entries(entries_, data);
}

const ProblemEntry& Catalogue::find(std::string_view name) const {
  for (const ProblemEntry& entry : entries_) {
    if (entry.name == name) return entry;
  }
  throw_bad_input(fmt::format("there is no problem '{}'", name), {}, suggestion(name, entries_));
}

std::vector<const ProblemEntry*> Catalogue::match(std::string_view glob) const {
  std::vector<const ProblemEntry*> matches;
  for (const ProblemEntry& entry : entries_) {
    if (glob_matches(glob, entry.name)) matches.push_back(&entry);
  }
  if (matches.empty()) {
    throw_bad_input(fmt::format("no problem matches '{}'", glob), {}, suggestion(glob, entries_));
  }
  return matches;
}

}  // namespace tribench
