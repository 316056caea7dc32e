// SPDX-License-Identifier: MIT
#include "problems/catalogue.hpp"

#include <fmt/format.h>

#include "foundation/error.hpp"
#include "foundation/suggestion.hpp"
#include "problems/benchmark/entries.hpp"
#include "problems/kuka/entries.hpp"
#include "problems/kuka/planted_entries.hpp"
#include "problems/measured/entries.hpp"
#include "problems/variant.hpp"

namespace tribench {
namespace {

std::string suggestion(std::string_view name, const std::vector<ProblemEntry>& entries) {
  std::vector<std::string> names;
  for (const ProblemEntry& entry : entries) names.push_back(entry.name);
  return did_you_mean(name, names, "see: tribench list problems");
}

}  // namespace

Catalogue::Catalogue(std::optional<std::filesystem::path> data, const suite::LawReader& laws,
                     std::span<const user::UserProblem> own) {
  user::add_entries(entries_, own, laws);
  kuka::add_entries(entries_);
  kuka::add_planted_entries(entries_);
  benchmark::add_entries(entries_, data);
  suites_ = suite::known_suites(data);
  for (const suite::Suite& suite : suites_) suite::add_entries(entries_, suite, laws, data);
  measured::add_entries(entries_, data);
}

ProblemEntry Catalogue::find(std::string_view name) const {
  const auto [base, suffix] = split_variant(name);
  for (const ProblemEntry& entry : entries_) {
    if (entry.name == base) return suffix.empty() ? entry : varied(entry, suffix);
  }
  throw_bad_input(fmt::format("there is no problem '{}'", name), {}, suggestion(name, entries_));
}

}  // namespace tribench
