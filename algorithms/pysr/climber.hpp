// SPDX-License-Identifier: MIT
//
// Local search on formulas by the evidence: greedy randomised construction from almost nothing,
// and exchanges of terms until none helps. It seeds the islands (on the rows the search sees) and
// refines the front at the end (on all rows).
//
// Source: GRASP (Feo, Resende 1995) with the growth and pruning of growth.hpp as its moves.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "algorithms/budget.hpp"
#include "algorithms/pysr/growth.hpp"
#include "algorithms/pysr/options.hpp"
#include "algorithms/pysr/random_formula.hpp"
#include "algorithms/pysr/scorer.hpp"

namespace tribench::pysr {

// A fitted formula.
struct Fitted {
  Expression formula;
  double loss = 0;     // mean squared error on the climber's rows
  double against = 0;  // evidence against it, nats
};

// What a climb may spend on a round; the defaults are for the end, on all rows.
struct ClimbEffort {
  int fit_steps = 60;
  std::size_t pruned = 4;     // prunings fitted a round
  std::size_t grown = 6;      // growths fitted a round
  std::size_t exchanged = 3;  // of either, carried on to an exchange
  int rounds = 12;
};

// One per thread; keeps its workspace and the structures it has seen.
class Climber {
 public:
  Climber(const Options& options, const OperatorSet& operators, const Validator& validator,
          const Rows& rows, const TermLibraries& libraries, const ScoreRule& rule);

  // Called with every formula fitted on the way.
  void on_fitted(std::function<void(const Fitted&)> sink) { sink_ = std::move(sink); }

  // The formula simplified and fitted; none where it is not finite, not admitted, or the budget
  // ends. A structure is fitted from a few starts only, since other starts may lead to other
  // minima; then the best of them stands.
  std::optional<Fitted> fitted(Expression formula, int steps, Budget& budget);

  // Grows a random start while the evidence improves, each time by a random one of the best
  // growths; every few steps prunes what has become idle.
  std::optional<Fitted> construct(RandomStream& random, Budget& budget);

  // Prunes, grows and exchanges while the evidence improves.
  Fitted climb(Fitted start, const ClimbEffort& effort, RandomStream& random, Budget& budget);

 private:
  std::vector<Fitted> best_of(std::span<const Proposal> proposals, std::size_t count, int steps,
                              Budget& budget);
  std::vector<Fitted> neighbours(const Expression& formula, const ClimbEffort& effort,
                                 RandomStream& random, Budget& budget);

  const Options& options_;
  const OperatorSet& operators_;
  const Validator& validator_;
  const Rows& rows_;
  double zero_loss_;
  Scorer scorer_;
  Grower grower_;
  std::function<void(const Fitted&)> sink_;
  struct Memory {
    int visits = 0;
    std::optional<Fitted> best;
  };
  std::unordered_map<std::uint64_t, Memory> memory_;  // by structure; never iterated
  std::unordered_set<std::uint64_t> climbed_;         // structures whose neighbours are known
};

}  // namespace tribench::pysr
