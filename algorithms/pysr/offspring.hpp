// SPDX-License-Identifier: MIT
//
// What an island tries: children that a kind of mutation proposes, fitted and scored, and no
// structure twice.
// Source: SymbolicRegression.jl, Mutate.jl; fits of children and growth are ours (README.md).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_set>
#include <vector>

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

// One event of a tournament.
struct EventState {
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

class Offspring {
 public:
  explicit Offspring(const Shared& shared);

  // Children that the kind proposes and the validator admits.
  std::vector<Expression> propose(MutationKind kind, const Subject& subject, const EventState& step,
                                  RandomStream& random, Budget& budget);
  // A member of the child; none where the budget ends or its structure was fitted before, unless
  // that is `exempt`.
  std::optional<Member> scored(Expression child, const EventState& step, bool exempt,
                               Budget& budget);
  // The parent with a subtree replaced by a member close to what the target asks of it; judged on
  // all rows, and none unless it is better there.
  std::optional<Member> solved_back(const Member& parent, std::span<const Member> members,
                                    const EventState& step, RandomStream& random, Budget& budget);
  // False from the second time on.
  bool is_new(const Expression& child);
  Scorer& scorer() { return scorer_; }

 private:
  std::vector<Expression> structural(MutationKind kind, const Subject& subject,
                                     const EventState& step, RandomStream& random);
  std::optional<double> fitted_loss(Expression& child, const EventState& step, Budget& budget);
  std::optional<double> scaled_loss(Expression& child, const EventState& step, double loss,
                                    Budget& budget);

  const Shared& shared_;
  const Form& form_;
  Scorer scorer_;
  Grower grower_;
  std::unordered_set<std::uint64_t> seen_;  // structures already fitted; never iterated
};

}  // namespace tribench::pysr
