// SPDX-License-Identifier: MIT
#include "harness/loop/chosen_shares.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "reports/record/loop_record.hpp"

namespace tribench::loop {
namespace {

// Correlation of the columns of two names of one cause. Two slight effects cannot be told from each
// other either, however little they have in common.
constexpr double kAlike = 0.9;

}  // namespace

ChosenShares::ChosenShares(std::span<const Diagnosis> parts) {
  for (const Diagnosis& part : parts) {
    std::set<std::string> families;
    for (const EffectFinding& effect : part.effects) families.insert(effect.family);
    chosen_.push_back(std::move(families));
  }
}

double ChosenShares::of_any(const std::set<std::string>& families) const {
  const auto share = std::ranges::count_if(chosen_, [&](const std::set<std::string>& one) {
    return std::ranges::any_of(families, [&](const auto& name) { return one.contains(name); });
  });
  return chosen_.empty() ? std::numeric_limits<double>::quiet_NaN()
                         : static_cast<double>(share) / static_cast<double>(chosen_.size());
}

std::set<std::string> names_of(const EffectFinding& effect) {
  std::set<std::string> names{effect.family};
  for (const AliasFinding& alias : effect.aliases) {
    if (alias.correlation >= kAlike) names.insert(alias.family);
  }
  return names;
}

void write_shares(Diagnosis& whole, const ChosenShares& shares) {
  for (EffectFinding& effect : whole.effects) {
    const std::set<std::string> names = names_of(effect);
    effect.chosen_share = shares.of_any(names);
    if (!(shares.of(effect.family) < kStableShare)) continue;
    std::vector<std::string> others;
    for (const std::string& name : names) {
      if (name == effect.family || !(shares.of(name) > 0)) continue;
      others.push_back(fmt::format("'{}' in {:.0f} %", name, 100 * shares.of(name)));
    }
    if (others.empty()) continue;
    effect.notes.push_back(
        fmt::format("in {:.0f} % of the searches without some of the movements by this name; {}",
                    100 * shares.of(effect.family), fmt::join(others, ", ")));
  }
}

}  // namespace tribench::loop
