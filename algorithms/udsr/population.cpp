// SPDX-License-Identifier: MIT
#include "algorithms/udsr/population.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "algorithms/expression/complexity.hpp"
#include "foundation/parallel_for.hpp"

namespace tribench::udsr {
namespace {

// Node-rows from which a batch is scored by several threads: about a millisecond of one.
constexpr std::uint64_t kWorthThreads = 1'000'000;

// Node-rows that are scored between two looks at the clock: a tenth of a second or two.
constexpr std::uint64_t kSlice = 10'000'000;

// Puts an entry into its place among the `most` best.
void remember(const Scoreboard::Entry& entry, std::size_t most,
              std::vector<Scoreboard::Entry>& best) {
  if (best.size() == most && entry.reward <= best.back().reward) return;
  const auto place = std::ranges::find_if(
      best, [&](const Scoreboard::Entry& other) { return other.reward < entry.reward; });
  // Equal rewards are, but for rounding, equal formulas written in another order.
  if (place != best.begin() && std::prev(place)->reward == entry.reward) return;
  best.insert(place, entry);
  if (best.size() > most) best.pop_back();
}

std::string key_of_sequence(const Sequence& sequence) {
  return std::string(sequence.begin(), sequence.end());
}

}  // namespace

Scoreboard::Scoreboard(const ScoringProblem& problem, Budget& budget, Progress* progress,
                       int threads)
    : problem_(&problem),
      budget_(&budget),
      progress_(progress),
      best_nrmse_(std::numeric_limits<double>::infinity()) {
  for (int i = 0; i < std::max(1, threads); ++i) {
    scorers_.push_back(std::make_unique<Scorer>(problem));
  }
}

std::vector<double> Scoreboard::rewards(std::span<const Sequence> batch) {
  for (std::size_t next = 0; next < batch.size() && !budget_->exhausted();) {
    next = score_slice(batch, next);
  }
  std::vector<double> rewards(batch.size(), 0.0);
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const auto found = known_.find(key_of_sequence(batch[i]));
    if (found != known_.end()) rewards[i] = found->second;
  }
  return rewards;
}

// Sequences from `next` on, as many as leave the clock a chance to stop the rest; where it stopped.
std::size_t Scoreboard::score_slice(std::span<const Sequence> batch, std::size_t next) {
  const std::uint64_t spent_before = budget_->spent();
  std::vector<std::size_t> fresh;  // places whose sequence has to be scored, in order
  for (; next < batch.size() && budget_->spent() - spent_before < kSlice; ++next) {
    const std::string key = key_of_sequence(batch[next]);
    if (known_.contains(key)) continue;
    if (!budget_->spend(scoring_cost(*problem_, batch[next]))) break;
    known_.emplace(key, 0.0);
    fresh.push_back(next);
  }
  std::vector<Scored> scores(fresh.size());
  // Threads that wait for each other cost more than a small batch.
  const bool parallel = scorers_.size() > 1 && budget_->spent() - spent_before > kWorthThreads;
  constexpr int kChunk = 4;
  parallel_for(
      fresh.size(), parallel ? static_cast<int>(scorers_.size()) : 1,
      [&](std::size_t k) {
        const auto thread = static_cast<std::size_t>(omp_get_thread_num());
        scores[k] = scorers_[thread]->score(batch[fresh[k]]);
      },
      kChunk);
  for (std::size_t k = 0; k < fresh.size(); ++k) {
    known_[key_of_sequence(batch[fresh[k]])] = scores[k].reward;
    book(batch[fresh[k]], scores[k]);
  }
  return next;
}

void Scoreboard::book(const Sequence& sequence, const Scored& scored) {
  if (scored.reward <= 0) return;
  offer(scored.formula, scored.nrmse);
  remember({scored.reward, sequence}, kRemembered, best_);
  remember({scored.reward, sequence}, kRememberedOfLength, best_of_length_[sequence.size()]);
}

std::vector<Scoreboard::Entry> Scoreboard::promising() const {
  std::vector<Entry> all(best_.begin(), best_.begin() + static_cast<std::ptrdiff_t>(
                                                            std::min(kPromising, best_.size())));
  for (const auto& [length, entries] : best_of_length_) {
    for (const Entry& entry : entries) {
      if (std::ranges::find(all, entry.sequence, &Entry::sequence) == all.end()) {
        all.push_back(entry);
      }
    }
  }
  return all;
}

void Scoreboard::offer(const Expression& formula, double nrmse) {
  if (!std::isfinite(nrmse)) return;
  const FrontEntry none{std::numeric_limits<double>::infinity(), Expression()};
  FrontEntry& entry = front_.try_emplace(paper_complexity(formula), none).first->second;
  if (nrmse < entry.nrmse) entry = {nrmse, formula};
  if (nrmse >= best_nrmse_) return;
  best_nrmse_ = nrmse;
  best_reward_ = 1 / (1 + nrmse);
  if (progress_ != nullptr) {
    progress_->improved(nrmse * nrmse * problem_->variance(), budget_->spent());
  }
}

}  // namespace tribench::udsr
