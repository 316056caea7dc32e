// SPDX-License-Identifier: MIT
//
// One island: a population that evolves on its own between two migrations.
// Source: SymbolicRegression.jl, SingleIteration.jl and RegularizedEvolution.jl.
#pragma once

#include <cstdint>
#include <unordered_set>
#include <vector>

#include "algorithms/pysr/climber.hpp"
#include "algorithms/pysr/growth.hpp"
#include "algorithms/pysr/hall_of_fame.hpp"
#include "algorithms/pysr/mutation.hpp"
#include "algorithms/pysr/scorer.hpp"
#include "algorithms/pysr/tournament.hpp"

namespace tribench::pysr {

// What all islands share and none changes while they run.
struct Shared {
  const Options& options;
  const OperatorSet& operators;
  const Validator& validator;
  const Rows& rows;  // what the search sees
  const TermLibraries& libraries;
  ScoreRule rule;
};

// What changes from epoch to epoch, the same for all islands.
struct EpochState {
  const SizeFrequencies& frequencies;
  const HallOfFame& hall;
  int max_size = 30;
};

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
  // Mutations tried and accepted, by kind, since the start.
  const std::array<std::uint64_t, kMutationKinds>& accepted() const { return accepted_; }

 private:
  struct Step {
    const EpochState& state;
    const Rows& rows;  // the batch, or all
    double temperature;
  };
  // What a mutation works on: one part of a member's form, as a formula of its arguments.
  struct Subject {
    const Member& parent;
    std::size_t part;
    Expression formula;
  };

  void construct(RandomStream& random, Budget& budget);
  void event(const Step& step, RandomStream& random, Budget& budget);
  void mutation_event(const Step& step, RandomStream& random, Budget& budget);
  MutationKind draw_mutation(const Subject& subject, const Step& step, RandomStream& random);
  // What takes a place in the population; none where nothing is accepted.
  std::optional<Member> accepted_child(MutationKind kind, const Subject& subject, const Step& step,
                                       RandomStream& random, Budget& budget);
  std::optional<Member> solved_back(const Member& parent, const Step& step, RandomStream& random,
                                    Budget& budget);
  void crossover_event(const Step& step, RandomStream& random, Budget& budget);
  // Children that the kind proposes and the validator admits.
  std::vector<Expression> propose(MutationKind kind, const Subject& subject, const Step& step,
                                  RandomStream& random, Budget& budget);
  std::vector<Expression> structural(MutationKind kind, const Subject& subject, const Step& step,
                                     RandomStream& random);
  std::optional<Member> scored(Expression child, const Step& step, bool exempt, Budget& budget);
  std::optional<double> fitted_loss(Expression& child, const Step& step, Budget& budget);
  std::optional<double> scaled_loss(Expression& child, const Step& step, double loss,
                                    Budget& budget);
  bool is_new(const Expression& child);
  Alphabet alphabet_of(std::size_t part) const;
  void replace_oldest(Member child);
  void tidy(const EpochState& state, RandomStream& random, Budget& budget);
  void optimise(Member& member, RandomStream& random, Budget& budget);
  void learn(MutationKind kind, bool success);

  const Shared& shared_;
  const Form& form_;
  Scorer scorer_;
  Grower grower_;
  std::vector<Member> members_;
  HallOfFame best_seen_;
  std::unordered_set<std::uint64_t> seen_;  // structures already fitted; never iterated
  std::uint64_t clock_ = 0;
  std::array<std::uint64_t, kMutationKinds> accepted_{};
  std::array<double, kMutationKinds> success_;  // smoothed rate, for adaptive weights
};

}  // namespace tribench::pysr
