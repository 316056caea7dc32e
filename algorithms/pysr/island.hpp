// SPDX-License-Identifier: MIT
//
// One island: a population that evolves on its own between two migrations.
// Source: SymbolicRegression.jl, SingleIteration.jl and RegularizedEvolution.jl.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "algorithms/pysr/climber.hpp"
#include "algorithms/pysr/hall_of_fame.hpp"
#include "algorithms/pysr/mutation.hpp"
#include "algorithms/pysr/offspring.hpp"
#include "algorithms/pysr/scorer.hpp"
#include "algorithms/pysr/tournament.hpp"

namespace tribench::pysr {

class Island {
 public:
  explicit Island(const Shared& shared);

  // Fills the population with random members, or with what constructions passed on their way.
  // Stops early when the budget ends.
  void populate(RandomStream random, Budget& budget);

  // One epoch: `cycles` cycles of tournaments, then simplification and fits of the members.
  // `best_seen` holds the best of every size met on the way, on all search rows.
  void evolve(const EpochState& state, RandomStream random, Budget& budget);

  std::vector<Member>& members() { return members_; }
  const std::vector<Member>& members() const { return members_; }
  const HallOfFame& best_seen() const { return best_seen_; }
  std::uint64_t& clock() { return clock_; }

 private:
  void construct(RandomStream& random, Budget& budget);
  void mutation_event(const EventState& step, RandomStream& random, Budget& budget);
  MutationKind draw_mutation(const Subject& subject, const EventState& step, RandomStream& random);
  // What takes a place in the population; none where nothing is accepted.
  std::optional<Member> accepted_child(MutationKind kind, const Subject& subject,
                                       const EventState& step, RandomStream& random,
                                       Budget& budget);
  void crossover_event(const EventState& step, RandomStream& random, Budget& budget);
  void replace_oldest(Member child);
  void tidy(const EpochState& state, RandomStream& random, Budget& budget);
  void optimise(Member& member, RandomStream& random, Budget& budget);
  void learn(MutationKind kind, bool success);

  const Shared& shared_;
  const Form& form_;
  Offspring offspring_;
  std::vector<Member> members_;
  HallOfFame best_seen_;
  std::uint64_t clock_ = 0;
  std::array<double, kMutationKinds> success_;  // smoothed rate, for adaptive weights
};

}  // namespace tribench::pysr
