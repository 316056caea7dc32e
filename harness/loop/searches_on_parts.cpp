// SPDX-License-Identifier: MIT
#include "harness/loop/searches_on_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <numeric>
#include <set>
#include <utility>

#include "algorithms/effects/effect_library.hpp"
#include "foundation/parallel_for.hpp"
#include "harness/loop/chosen_shares.hpp"
#include "reports/record/loop_record.hpp"

namespace tribench::loop {
namespace {

std::vector<std::size_t> numbers_below(std::size_t end) {
  std::vector<std::size_t> all(end);
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

// ": how", or nothing where no rule of experiment is known.
std::string experiments_of(const std::vector<std::string>& rules) {
  std::vector<std::string> texts;
  for (const std::string& rule : rules) texts.push_back(experiment_text(rule));
  return texts.empty() ? std::string() : fmt::format(": {}", fmt::join(texts, ", or "));
}

bool leaves_something(const Diagnosis& one) { return one.verdict == Verdict::unknown; }

}  // namespace

SearchesOnParts::SearchesOnParts(const Observations& data, const BaseMaker& base,
                                 const DiagnosisOptions& options, const JudgingOptions& judging,
                                 const std::vector<int>& without,
                                 const std::vector<std::vector<int>>& parts)
    : data_(data), base_(base), options_(options), judging_(judging), without_{without} {
  for (const std::vector<int>& part : parts) {
    std::vector<int>& all = without_.emplace_back(part);
    all.insert(all.end(), without.begin(), without.end());
    std::ranges::sort(all);
  }
  found_.resize(without_.size());
  memories_.resize(without_.size());
}

void SearchesOnParts::search_all() { search(numbers_below(without_.size()), options_, false); }

void SearchesOnParts::search_until_none() {
  search(numbers_below(without_.size()), options_, true);
}

void SearchesOnParts::search(const std::vector<std::size_t>& which, const DiagnosisOptions& options,
                             bool until_none) {
  DiagnosisOptions effects_alone = options;  // of all but the reported one
  effects_alone.compares_families = false;
  std::mutex mutex;
  std::atomic<bool> is_none = false;
  std::vector<std::exception_ptr> failures(which.size());
  asked_ += which.size();
  parallel_for(which.size(), judging_.threads, [&](std::size_t k) {
    if (is_none) return;
    const std::size_t one = which[k];
    try {
      found_[one] = diagnose(data_, base_, one == 0 ? options : effects_alone, without_[one],
                             &memories_[one]);
    } catch (...) {
      failures[k] = std::current_exception();
      return;
    }
    if (one == 0 && until_none) {
      is_none = !leaves_something(whole()) && whole().effects.empty();
    }
    const std::lock_guard lock(mutex);
    if (judging_.progress) judging_.progress(++ended_, asked_);
  });
  for (std::size_t k = 0; k < which.size(); ++k) {
    if (failures[k] && (which[k] == 0 || !is_none)) std::rethrow_exception(failures[k]);
  }
  if (is_none) found_.resize(1);
}

// What too few of the searches on parts choose, by whatever name the data allow, hangs on a
// movement or two. Where the whole names such an effect, all are asked anew for what most of them
// choose, but those that had nothing else; and again where the answer names one that stood for a
// stable alias before and now stands beside it.
std::vector<std::string> SearchesOnParts::name_the_stable() {
  if (parts().empty()) return {};
  const ChosenShares shares(parts());
  DiagnosisOptions options = options_;
  const auto is_unnamed = [&](const std::string& family) {
    return std::ranges::count(options.unnamed, family) > 0;
  };
  std::vector<std::string> notes;
  std::vector<std::string> needed;
  // Each turn adds to what is unnamed, which no answer names: it ends.
  while (true) {
    std::set<std::string> stable;
    std::vector<EffectFinding> rare;
    for (const EffectFinding& effect : whole().effects) {
      const std::set<std::string> names = names_of(effect);
      if (shares.of_any(names) < kStableShare) {
        rare.push_back(effect);
      } else {
        stable.insert(names.begin(), names.end());
      }
    }
    if (rare.empty()) break;
    for (const EffectFinding& effect : rare) stable.erase(effect.family);
    for (const EffectFamily& family : whole().families) {
      const bool is_rare = shares.of(family.name) < kStableShare;
      if (is_rare && !stable.contains(family.name) && !is_unnamed(family.name)) {
        options.unnamed.push_back(family.name);
      }
    }
    for (const EffectFinding& effect : rare) {
      notes.push_back(fmt::format(
          "'{}' is chosen by {:.0f} % of the searches without some of the movements: not named",
          effect.family, 100 * shares.of(effect.family)));
      needed.push_back(fmt::format("more movements that show '{}'{}", effect.family,
                                   experiments_of(effect.separate_by)));
    }
    std::vector<std::size_t> again;
    for (std::size_t k = 0; k < found_.size(); ++k) {
      if (std::ranges::any_of(found_[k].tried, is_unnamed)) again.push_back(k);
    }
    search(again, options, false);
  }
  whole().notes.insert(whole().notes.end(), notes.begin(), notes.end());
  write_shares(whole(), shares);
  if (leaves_something(whole())) {
    whole().leftover.chosen_share =
        static_cast<double>(std::ranges::count_if(parts(), leaves_something)) /
        static_cast<double>(parts().size());
  }
  return needed;
}

}  // namespace tribench::loop
