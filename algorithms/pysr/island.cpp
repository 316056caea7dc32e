// SPDX-License-Identifier: MIT
#include "algorithms/pysr/island.hpp"

#include <algorithm>

#include "algorithms/expression/edit.hpp"

namespace tribench::pysr {
namespace {

// Success rates of the mutations: smoothing and floor of PySR 2 (pysr/mutations.py).
constexpr double kSuccessSmoothing = 0.02;
constexpr double kSuccessFloor = 0.05;

// Retries in a burst of PySR 2 (pysr/plugins.py).
constexpr int kBurstRetries = 4;

}  // namespace

Island::Island(const Shared& shared)
    : shared_(shared),
      form_(shared.validator.form()),
      offspring_(shared),
      best_seen_(shared.options.max_size) {
  success_.fill(1);
}

void Island::populate(RandomStream random, Budget& budget) {
  const Options& options = shared_.options;
  if (options.constructions > 0) construct(random, budget);
  const SizeFrequencies frequencies(options.max_size);
  const EpochState state{frequencies, best_seen_, options.max_size};
  const EventState step{state, shared_.rows, 1};
  while (static_cast<int>(members_.size()) < options.population_size) {
    std::optional<Member> member;
    for (int attempt = 0; attempt < options.attempts && !member; ++attempt) {
      Expression formula = form_.assembled([&](std::size_t part) {
        return random_part(form_, part, options.initial_operators, shared_.operators, random);
      });
      if (!shared_.validator.admits(formula, options.max_size)) continue;
      member = offspring_.scored(std::move(formula), step, true, budget);
      if (budget.exhausted()) return;
    }
    if (!member) {
      const auto zero = [](std::size_t) { return Expression::constant(0); };
      member = offspring_.scored(form_.assembled(zero), step, true, budget);
    }
    if (!member) return;
    member->birth = clock_++;
    best_seen_.offer(*member);
    members_.push_back(std::move(*member));
  }
}

void Island::construct(RandomStream& random, Budget& budget) {
  const Options& options = shared_.options;
  Climber climber(options, shared_.operators, shared_.validator, shared_.rows, shared_.libraries,
                  shared_.rule);
  climber.on_fitted([this](const Fitted& fitted) {
    best_seen_.offer(offspring_.scorer().member_of(fitted.formula, fitted.loss));
  });
  std::vector<Fitted> built;
  for (int i = 0; i < options.constructions && !budget.exhausted(); ++i) {
    std::optional<Fitted> formula = climber.construct(random, budget);
    if (formula) built.push_back(std::move(*formula));
  }
  std::ranges::stable_sort(built, {}, &Fitted::against);
  const ClimbEffort effort{12, 3, 4, 2, 6};
  for (std::size_t i = 0; i < built.size() && !budget.exhausted(); ++i) {
    if (static_cast<int>(i) < options.climbs) {
      built[i] = climber.climb(std::move(built[i]), effort, random, budget);
    }
    if (static_cast<int>(members_.size()) >= options.population_size) break;
    Member member = offspring_.scorer().member_of(std::move(built[i].formula), built[i].loss);
    member.birth = clock_++;
    offspring_.is_new(member.formula);
    members_.push_back(std::move(member));
  }
}

void Island::evolve(const EpochState& state, RandomStream random, Budget& budget) {
  const Options& options = shared_.options;
  best_seen_ = HallOfFame(options.max_size);
  const std::size_t all = shared_.rows.size();
  const bool batched = options.batching == Batching::on && options.batch_size > 0 &&
                       static_cast<std::size_t>(options.batch_size) < all;
  Rows batch;
  if (batched) {
    batch = draw_batch(shared_.rows, static_cast<std::size_t>(options.batch_size), random);
  }
  const int events = (options.population_size + options.tournament_size - 1) /
                     std::max(options.tournament_size, 1);
  for (int cycle = 0; cycle < options.cycles; ++cycle) {
    // From 1 down to 0.
    const double temperature =
        options.annealing && options.cycles > 1
            ? 1 - static_cast<double>(cycle) / static_cast<double>(options.cycles - 1)
            : 1;
    const EventState step{state, batched ? batch : shared_.rows, temperature};
    for (int e = 0; e < events; ++e) {
      if (budget.exhausted() || members_.empty()) return;
      if (random.chance(options.crossover_probability)) {
        crossover_event(step, random, budget);
      } else {
        mutation_event(step, random, budget);
      }
    }
  }
  if (batched) {
    // What was best on the batch is not yet known on all rows.
    const std::vector<Member> batch_best = best_seen_.members();
    best_seen_ = HallOfFame(options.max_size);
    for (const Member& member : batch_best) {
      const auto loss = offspring_.scorer().mean_square(member.formula, shared_.rows, budget);
      if (loss) best_seen_.offer(offspring_.scorer().member_of(member.formula, *loss));
    }
  }
  tidy(state, random, budget);
}

MutationKind Island::draw_mutation(const Subject& subject, const EventState& step,
                                   RandomStream& random) {
  const Options& options = shared_.options;
  MutationWeights weights = conditioned(options.weights, subject.formula, subject.parent.size,
                                        step.state.max_size, form_.arguments(subject.part).size());
  if (options.adaptive_weights) {
    for (std::size_t k = 0; k < kMutationKinds; ++k) {
      weights[k] *= std::max(success_[k], kSuccessFloor);
    }
  }
  return draw_kind(weights, random);
}

void Island::mutation_event(const EventState& step, RandomStream& random, Budget& budget) {
  const Options& options = shared_.options;
  const Member parent = members_[run_tournament(members_, step.state.frequencies, options, random)];
  const int attempts = options.mutation_burst ? 1 + kBurstRetries : 1;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    const std::size_t part = form_.draw_part(random);
    const Subject subject{parent, part, form_.part(parent.formula, part)};
    const MutationKind kind = draw_mutation(subject, step, random);
    if (kind == MutationKind::do_nothing) return replace_oldest(parent);
    std::optional<Member> child = accepted_child(kind, subject, step, random, budget);
    if (budget.exhausted()) return;
    learn(kind, child && child->cost < parent.cost);
    if (!child) continue;
    return replace_oldest(std::move(*child));
  }
  if (!options.skip_failures) replace_oldest(parent);
}

std::optional<Member> Island::accepted_child(MutationKind kind, const Subject& subject,
                                             const EventState& step, RandomStream& random,
                                             Budget& budget) {
  const Member& parent = subject.parent;
  if (kind == MutationKind::backsolve) {
    std::optional<Member> child = offspring_.solved_back(parent, members_, step, random, budget);
    if (child) best_seen_.offer(*child);
    return child;
  }
  const bool exempt = kind == MutationKind::simplify || kind == MutationKind::optimize;
  std::optional<Member> best;
  for (Expression& child : offspring_.propose(kind, subject, step, random, budget)) {
    std::optional<Member> member = offspring_.scored(std::move(child), step, exempt, budget);
    if (budget.exhausted()) return std::nullopt;
    if (!member) continue;
    best_seen_.offer(*member);
    if (!best || member->cost < best->cost) best = std::move(member);
  }
  if (!best || exempt) return best;
  const double chance = acceptance(best->cost, parent.cost, best->size, parent.size,
                                   step.temperature, step.state.frequencies, shared_.options);
  if (!accepts(chance, random)) return std::nullopt;
  return best;
}

void Island::crossover_event(const EventState& step, RandomStream& random, Budget& budget) {
  const Options& options = shared_.options;
  const SizeFrequencies& frequencies = step.state.frequencies;
  const Member a = members_[run_tournament(members_, frequencies, options, random)];
  const Member b = members_[run_tournament(members_, frequencies, options, random)];
  const std::size_t part = form_.draw_part(random);
  const Expression part_a = form_.part(a.formula, part);
  const Expression part_b = form_.part(b.formula, part);
  for (int attempt = 0; attempt < options.attempts; ++attempt) {
    auto [first, second] = cross(part_a, part_b, random);
    first = form_.with_part(a.formula, part, std::move(first));
    second = form_.with_part(b.formula, part, std::move(second));
    if (!shared_.validator.admits(first, step.state.max_size) ||
        !shared_.validator.admits(second, step.state.max_size)) {
      continue;
    }
    for (Expression* child : {&first, &second}) {
      std::optional<Member> member = offspring_.scored(std::move(*child), step, false, budget);
      if (budget.exhausted()) return;
      if (member) replace_oldest(std::move(*member));
    }
    return;
  }
}

void Island::replace_oldest(Member child) {
  child.birth = clock_++;
  best_seen_.offer(child);
  members_[oldest_of(members_)] = std::move(child);
}

void Island::optimise(Member& member, RandomStream& random, Budget& budget) {
  const Options& options = shared_.options;
  Expression best = member.formula;
  std::optional<double> best_loss =
      offspring_.scorer().fit(best, shared_.rows, options.optimize_iterations, budget);
  for (int restart = 0; restart < options.optimize_restarts; ++restart) {
    Expression trial = member.formula;
    for (const std::size_t place : constant_positions(trial)) {
      if (is_exponent(trial, place)) continue;
      const double value = trial.node(place).value;
      // A zero would never move under a relative perturbation (SymbolicRegression.jl #637).
      set_constant(trial, place,
                   value == 0 ? random.normal() : value * (1 + 0.5 * random.normal()));
    }
    const auto loss =
        offspring_.scorer().fit(trial, shared_.rows, options.optimize_iterations, budget);
    if (loss && (!best_loss || *loss < *best_loss)) {
      best_loss = loss;
      best = std::move(trial);
    }
  }
  if (!best_loss) return;
  Member optimised = offspring_.scorer().member_of(std::move(best), *best_loss);
  if (!(optimised.cost < member.cost)) return;
  optimised.birth = clock_++;
  member = std::move(optimised);
}

void Island::tidy(const EpochState& state, RandomStream& random, Budget& budget) {
  const Options& options = shared_.options;
  for (Member& member : members_) {
    if (budget.exhausted()) return;
    Expression simpler = simplified(form_, member.formula);
    const bool shorter =
        simpler.size() < member.formula.size() && shared_.validator.admits(simpler, state.max_size);
    const bool batched = options.batching == Batching::on;
    if (shorter || batched) {
      if (!shorter) simpler = member.formula;
      const auto loss = offspring_.scorer().mean_square(simpler, shared_.rows, budget);
      if (loss) {
        const std::uint64_t birth = member.birth;
        member = offspring_.scorer().member_of(std::move(simpler), *loss);
        member.birth = birth;
      }
    }
    if (random.chance(options.optimize_probability)) optimise(member, random, budget);
    best_seen_.offer(member);
  }
}

void Island::learn(MutationKind kind, bool success) {
  double& rate = success_[index_of(kind)];
  rate += kSuccessSmoothing * ((success ? 1.0 : 0.0) - rate);
}

}  // namespace tribench::pysr
