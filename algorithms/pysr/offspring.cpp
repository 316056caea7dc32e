// SPDX-License-Identifier: MIT
#include "algorithms/pysr/offspring.hpp"

#include <algorithm>

#include "algorithms/pysr/backsolve.hpp"
#include "algorithms/pysr/simplify.hpp"

namespace tribench::pysr {
namespace {

// A child is fitted in two stages: a few steps to see what it promises, the rest only where its
// loss is within this factor of the best formula that is no larger.
constexpr int kFirstSteps = 4;
constexpr int kFurtherSteps = 12;
constexpr double kPromising = 2.0;

// Places and terms ranked by one growth, and how many of the best are fitted.
constexpr std::size_t kGrowthSamples = 48;
constexpr std::size_t kGrowthChildren = 2;

// The share of mutations in a burst of PySR 2 that change a child twice (pysr/plugins.py).
constexpr double kCompoundChance = 0.25;

}  // namespace

Offspring::Offspring(const Shared& shared)
    : shared_(shared),
      form_(shared.validator.form()),
      scorer_(shared.validator, shared.rule),
      grower_(shared.operators, form_, shared.libraries) {}

std::vector<Expression> Offspring::structural(MutationKind kind, const Subject& subject,
                                              const EventState& step, RandomStream& random) {
  const Options& options = shared_.options;
  const Alphabet alphabet{shared_.operators, form_.arguments(subject.part).size()};
  const auto outside = static_cast<int>(subject.parent.formula.size() - subject.formula.size());
  const MutationSettings settings{step.temperature, options.perturbation_factor,
                                  options.negate_probability, options.compat,
                                  std::max(step.state.max_size - outside, 1)};
  for (int attempt = 0; attempt < options.attempts; ++attempt) {
    std::optional<Expression> child = mutate(kind, subject.formula, alphabet, settings, random);
    if (!child) return {};
    if (options.mutation_burst && random.chance(kCompoundChance)) {
      const MutationKind second = draw_kind(options.weights, random);
      if (auto further = mutate(second, *child, alphabet, settings, random)) child = further;
    }
    if (options.fit_children) *child = simplified(*child);
    *child = form_.with_part(subject.parent.formula, subject.part, std::move(*child));
    if (!shared_.validator.admits(*child, step.state.max_size)) continue;
    // Another draw of the same kind rather than a structure that has been fitted before.
    if (options.novelty && kind != MutationKind::mutate_constant &&
        seen_.contains(structure_hash(*child))) {
      continue;
    }
    return {std::move(*child)};
  }
  return {};
}

std::vector<Expression> Offspring::propose(MutationKind kind, const Subject& subject,
                                           const EventState& step, RandomStream& random,
                                           Budget& budget) {
  const Member& parent = subject.parent;
  std::vector<Expression> children;
  if (kind == MutationKind::grow || kind == MutationKind::prune) {
    std::vector<Proposal> proposals = kind == MutationKind::grow
                                          ? grower_.grow(parent.formula, step.rows, kGrowthSamples,
                                                         2 * kGrowthChildren, random, budget)
                                          : grower_.prune(parent.formula, step.rows, budget);
    for (Proposal& proposal : proposals) {
      Expression child = simplified(form_, proposal.formula);
      if (!shared_.validator.admits(child, step.state.max_size)) continue;
      if (shared_.options.novelty && seen_.contains(structure_hash(child))) continue;
      children.push_back(std::move(child));
      if (children.size() == kGrowthChildren) break;
    }
    return children;
  }
  if (kind == MutationKind::simplify || kind == MutationKind::optimize) {
    Expression child =
        kind == MutationKind::simplify ? simplified(form_, parent.formula) : parent.formula;
    if (kind == MutationKind::optimize) {
      scorer_.fit(child, step.rows, shared_.options.optimize_iterations, budget);
    }
    if (shared_.validator.admits(child, step.state.max_size)) children.push_back(std::move(child));
    return children;
  }
  return structural(kind, subject, step, random);
}

bool Offspring::is_new(const Expression& child) {
  return seen_.insert(structure_hash(child)).second;
}

std::optional<Member> Offspring::scored(Expression child, const EventState& step, bool exempt,
                                        Budget& budget) {
  std::optional<double> loss;
  if (shared_.options.fit_children) {
    const bool first_time = is_new(child);
    if (!first_time && !exempt && shared_.options.novelty) return std::nullopt;
    loss = fitted_loss(child, step, budget);
  } else {
    loss = scorer_.mean_square(child, step.rows, budget);
  }
  if (!loss) return std::nullopt;
  return scorer_.member_of(std::move(child), *loss);
}

std::optional<double> Offspring::fitted_loss(Expression& child, const EventState& step,
                                             Budget& budget) {
  std::optional<double> loss = scorer_.fit(child, step.rows, kFirstSteps, budget);
  if (!loss) return std::nullopt;
  if (shared_.options.linear_scaling) loss = scaled_loss(child, step, *loss, budget);
  if (!loss) return std::nullopt;
  const std::optional<double> best = step.state.hall.best_loss_up_to(shared_.validator.size(child));
  if (best && *loss > kPromising * *best) return loss;
  return scorer_.fit(child, step.rows, kFurtherSteps, budget);
}

std::optional<double> Offspring::scaled_loss(Expression& child, const EventState& step, double loss,
                                             Budget& budget) {
  // A child far from its target may lack no more than a scale and an offset.
  const std::optional<double> best = step.state.hall.best_loss_up_to(step.state.max_size);
  if (best && loss <= kPromising * *best) return loss;
  if (arity(child.node(child.root()).op) == 0) return loss;
  Expression scaled = simplified(
      Expression::binary(Op::add, Expression::binary(Op::mul, Expression::constant(0.9), child),
                         Expression::constant(0.1)));
  if (scaled.size() == child.size()) return loss;
  if (!shared_.validator.admits(scaled, step.state.max_size)) return loss;
  if (!is_new(scaled)) return loss;
  const std::optional<double> scaled_loss = scorer_.fit(scaled, step.rows, kFirstSteps, budget);
  if (budget.exhausted()) return std::nullopt;
  if (!scaled_loss || *scaled_loss > 0.5 * loss) return loss;
  child = std::move(scaled);
  return scaled_loss;
}

std::optional<Member> Offspring::solved_back(const Member& parent, std::span<const Member> members,
                                             const EventState& step, RandomStream& random,
                                             Budget& budget) {
  const EventState whole{step.state, shared_.rows, step.temperature};
  std::optional<Expression> child =
      backsolve(parent.formula, members, shared_.rows,
                static_cast<std::size_t>(step.state.max_size), random, budget);
  if (!child) return std::nullopt;
  if (shared_.options.fit_children) *child = simplified(form_, *child);
  if (!shared_.validator.admits(*child, step.state.max_size)) return std::nullopt;
  std::optional<Member> member = scored(std::move(*child), whole, false, budget);
  if (!member) return std::nullopt;
  const auto before = scorer_.mean_square(parent.formula, shared_.rows, budget);
  if (!before || !(member->cost < scorer_.member_of(parent.formula, *before).cost)) {
    return std::nullopt;
  }
  return member;
}

}  // namespace tribench::pysr
