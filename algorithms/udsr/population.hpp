// SPDX-License-Identifier: MIT
//
// Scores batches of sequences once each, within the budget, and remembers the best formula of
// every complexity. Shared by the policy's training and by genetic programming.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "algorithms/regressor.hpp"
#include "algorithms/udsr/scoring.hpp"

namespace tribench::udsr {

class Scoreboard {
 public:
  // threads: batches are scored on so many; the result does not depend on it.
  Scoreboard(const ScoringProblem& problem, Budget& budget, Progress* progress, int threads);

  // The score of each sequence, equal ones computed once ever. Sequences beyond the budget score 0
  // and are not remembered.
  std::vector<double> rewards(std::span<const Sequence> batch);

  bool exhausted() const { return budget_->exhausted(); }
  double best_reward() const { return best_reward_; }
  double best_nrmse() const { return best_nrmse_; }
  std::uint64_t evaluations() const { return budget_->spent(); }

  // The most rewarding sequences so far, best first, no two with the same formula.
  struct Entry {
    double reward = 0;
    Sequence sequence;
  };
  std::span<const Entry> best() const { return best_; }

  // The best of all, and the best of each length: what a sequence lacks that holds no constants
  // inside functions shows only once it has them, and the longest ones hide it from the rewards.
  std::vector<Entry> promising() const;

  // Offers a formula that did not come from a sequence.
  void offer(const Expression& formula, double nrmse);
  // Best formula of each complexity (the paper's count).
  struct FrontEntry {
    double nrmse = 0;
    Expression formula;
  };
  const std::map<int, FrontEntry>& front() const { return front_; }

 private:
  static constexpr std::size_t kRemembered = 32;
  static constexpr std::size_t kRememberedOfLength = 8;
  static constexpr std::size_t kPromising = 16;  // of the best of all
  std::size_t score_slice(std::span<const Sequence> batch, std::size_t next);
  void book(const Sequence& sequence, const Scored& scored);

  const ScoringProblem* problem_;
  Budget* budget_;
  Progress* progress_;
  std::vector<std::unique_ptr<Scorer>> scorers_;   // one per thread
  std::unordered_map<std::string, double> known_;  // looked up only, never iterated
  std::vector<Entry> best_;
  std::map<std::size_t, std::vector<Entry>> best_of_length_;
  std::map<int, FrontEntry> front_;
  double best_reward_ = 0;
  double best_nrmse_ = 0;
};

}  // namespace tribench::udsr
