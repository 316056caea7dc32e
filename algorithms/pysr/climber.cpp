// SPDX-License-Identifier: MIT
#include "algorithms/pysr/climber.hpp"

#include <algorithm>

#include "algorithms/fitting/evidence.hpp"
#include "algorithms/pysr/simplify.hpp"

namespace tribench::pysr {
namespace {

// A construction: places and terms ranked at every step, growths fitted (more while the formula is
// small), steps of a fit.
constexpr std::size_t kSamples = 64;
constexpr std::size_t kChildren = 4;
constexpr int kSteps = 8;
constexpr int kMostGrowths = 16;
// The chance to pass on from a growth to the next best.
constexpr double kPass = 0.5;
// Starts from which a structure is fitted.
constexpr int kMostVisits = 3;

}  // namespace

Climber::Climber(const Options& options, const OperatorSet& operators, const Validator& validator,
                 const Rows& rows, const TermLibraries& libraries, const ScoreRule& rule)
    : options_(options),
      operators_(operators),
      validator_(validator),
      rows_(rows),
      zero_loss_(zero_loss(rows)),
      scorer_(validator, rule),
      grower_(operators, validator.form(), libraries) {}

std::optional<Fitted> Climber::fitted(Expression formula, int steps, Budget& budget) {
  formula = simplified(validator_.form(), formula);
  if (!validator_.admits(formula, options_.max_size)) return std::nullopt;
  Memory& memory = memory_[structure_hash(formula)];
  if (memory.visits >= kMostVisits) return memory.best;
  ++memory.visits;
  const std::optional<double> loss = scorer_.fit(formula, rows_, steps, budget);
  if (!loss) return memory.best;
  if (memory.best && memory.best->loss <= *loss) return memory.best;
  Fitted result{std::move(formula), *loss, 0};
  result.against = evidence_against(result.formula, *loss, zero_loss_, rows_.size());
  if (sink_) sink_(result);
  memory.best = result;
  return result;
}

std::vector<Fitted> Climber::best_of(std::span<const Proposal> proposals, std::size_t count,
                                     int steps, Budget& budget) {
  std::vector<Fitted> best;
  for (const Proposal& proposal : proposals.first(std::min(count, proposals.size()))) {
    if (budget.exhausted()) break;
    std::optional<Fitted> child = fitted(proposal.formula, steps, budget);
    if (child) best.push_back(std::move(*child));
  }
  std::ranges::stable_sort(best, {}, &Fitted::against);
  return best;
}

std::optional<Fitted> Climber::construct(RandomStream& random, Budget& budget) {
  const Form& form = validator_.form();
  std::optional<Fitted> current;
  for (int attempt = 0; attempt < options_.attempts && !current; ++attempt) {
    const auto start = [&](std::size_t part) {
      const int operators = static_cast<int>(random.below(3));
      return Expression::binary(Op::mul, Expression::constant(0.9),
                                random_part(form, part, operators, operators_, random));
    };
    current = fitted(form.assembled(start), kSteps, budget);
    if (budget.exhausted()) return current;
  }
  if (!current) return current;
  std::optional<Fitted> best = current;
  int idle = 0;
  for (int step = 0; step < kMostGrowths && idle < 2 && !budget.exhausted(); ++step) {
    std::vector<Fitted> children =
        best_of(grower_.grow(current->formula, rows_, kSamples, kChildren, random, budget),
                kChildren, kSteps, budget);
    if (children.empty()) {
      ++idle;
      continue;
    }
    std::size_t chosen = 0;
    while (chosen + 1 < children.size() && random.chance(kPass)) ++chosen;
    if (step % 2 == 1) {
      // What the first terms explained, later ones often explain better.
      std::vector<Fitted> pruned =
          best_of(grower_.prune(children[chosen].formula, rows_, budget), 2, kSteps, budget);
      if (!pruned.empty() && pruned[0].against < children[chosen].against) {
        children[chosen] = std::move(pruned[0]);
      }
    }
    idle = children[chosen].against < current->against ? 0 : idle + 1;
    if (idle == 0) current = std::move(children[chosen]);
    if (current->against < best->against) best = current;
  }
  return best;
}

std::vector<Fitted> Climber::neighbours(const Expression& formula, const ClimbEffort& effort,
                                        RandomStream& random, Budget& budget) {
  std::vector<Fitted> pruned =
      best_of(grower_.prune(formula, rows_, budget), effort.pruned, effort.fit_steps, budget);
  std::vector<Fitted> grown = best_of(grower_.grow(formula, rows_, 0, effort.grown, random, budget),
                                      effort.grown, effort.fit_steps, budget);
  std::vector<Fitted> all = pruned;
  all.insert(all.end(), grown.begin(), grown.end());
  // Exchanges: what one term explains may be another's to explain.
  pruned.resize(std::min(pruned.size(), effort.exchanged));
  for (const Fitted& smaller : pruned) {
    const std::vector<Fitted> children =
        best_of(grower_.grow(smaller.formula, rows_, 0, effort.grown, random, budget), effort.grown,
                effort.fit_steps, budget);
    all.insert(all.end(), children.begin(), children.end());
  }
  grown.resize(std::min(grown.size(), effort.exchanged));
  for (const Fitted& larger : grown) {
    const std::vector<Fitted> children = best_of(grower_.prune(larger.formula, rows_, budget),
                                                 effort.pruned, effort.fit_steps, budget);
    all.insert(all.end(), children.begin(), children.end());
  }
  return all;
}

Fitted Climber::climb(Fitted start, const ClimbEffort& effort, RandomStream& random,
                      Budget& budget) {
  Fitted current = std::move(start);
  for (int round = 0; round < effort.rounds && !budget.exhausted(); ++round) {
    if (!climbed_.insert(structure_hash(current.formula)).second) break;
    std::vector<Fitted> all = neighbours(current.formula, effort, random, budget);
    const auto best = std::ranges::min_element(all, {}, &Fitted::against);
    if (best == all.end() || !(best->against < current.against)) break;
    current = std::move(*best);
  }
  return current;
}

}  // namespace tribench::pysr
