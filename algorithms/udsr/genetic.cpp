// SPDX-License-Identifier: MIT
#include "algorithms/udsr/genetic.hpp"

#include <algorithm>
#include <numeric>

namespace tribench::udsr {
namespace {

void splice(Sequence& sequence, std::size_t begin, std::size_t end,
            std::span<const TokenId> replacement) {
  Sequence result(sequence.begin(), sequence.begin() + static_cast<std::ptrdiff_t>(begin));
  result.insert(result.end(), replacement.begin(), replacement.end());
  result.insert(result.end(), sequence.begin() + static_cast<std::ptrdiff_t>(end), sequence.end());
  sequence = std::move(result);
}

TokenId pick(const std::vector<TokenId>& tokens, RandomStream& random) {
  return tokens[random.below(tokens.size())];
}

// A full tree: operations down to `depth`, leaves there.
void grow(const TokenLibrary& library, int depth, RandomStream& random, Sequence& out) {
  if (depth == 0 || library.operations() == 0) {
    out.push_back(pick(library.with_children(0), random));
    return;
  }
  const auto operation = static_cast<TokenId>(random.below(library.operations()));
  out.push_back(operation);
  for (int c = 0; c < library[operation].children; ++c) grow(library, depth - 1, random, out);
}

void replace_subtree(const TokenLibrary& library, int max_depth, RandomStream& random,
                     Sequence& child) {
  const std::size_t at = random.below(child.size());
  Sequence tree;
  grow(library, static_cast<int>(random.below(static_cast<std::uint64_t>(max_depth) + 1)), random,
       tree);
  splice(child, at, subtree_end(library, child, at), tree);
}

void replace_node(const TokenLibrary& library, RandomStream& random, Sequence& child) {
  const std::size_t at = random.below(child.size());
  child[at] = pick(library.with_children(library[child[at]].children), random);
}

void insert_node(const TokenLibrary& library, RandomStream& random, Sequence& child) {
  if (library.operations() == 0) return;
  const std::size_t at = random.below(child.size());
  const std::size_t end = subtree_end(library, child, at);
  const auto operation = static_cast<TokenId>(random.below(library.operations()));
  Sequence grown = {operation};
  const Sequence below(child.begin() + static_cast<std::ptrdiff_t>(at),
                       child.begin() + static_cast<std::ptrdiff_t>(end));
  const std::size_t slot = random.below(library[operation].children);
  for (std::size_t c = 0; c < library[operation].children; ++c) {
    if (c == slot) {
      grown.insert(grown.end(), below.begin(), below.end());
    } else {
      grown.push_back(pick(library.with_children(0), random));
    }
  }
  splice(child, at, end, grown);
}

// A random operation gives way to one of its children.
void shrink(const TokenLibrary& library, RandomStream& random, Sequence& child) {
  std::vector<std::size_t> operations;
  for (std::size_t i = 0; i < child.size(); ++i) {
    if (library.is_operation(child[i])) operations.push_back(i);
  }
  if (operations.empty()) return;
  const std::size_t at = operations[random.below(operations.size())];
  std::size_t kept = at + 1;
  if (library[child[at]].children == 2 && random.chance(0.5)) {
    kept = subtree_end(library, child, kept);
  }
  const std::size_t kept_end = subtree_end(library, child, kept);
  const Sequence below(child.begin() + static_cast<std::ptrdiff_t>(kept),
                       child.begin() + static_cast<std::ptrdiff_t>(kept_end));
  splice(child, at, subtree_end(library, child, at), below);
}

class Population {
 public:
  Population(std::span<const Sequence> seed, std::span<const double> rewards,
             const GeneticOptions& options, RandomStream& random) {
    std::vector<std::size_t> order(seed.size());
    std::iota(order.begin(), order.end(), 0);
    random.shuffle(std::span(order));
    order.resize(std::min(order.size(), static_cast<std::size_t>(options.population)));
    for (const std::size_t i : order) {
      members_.push_back(seed[i]);
      rewards_.push_back(rewards[i]);
    }
  }

  const Sequence& tournament(int size, RandomStream& random) const {
    std::size_t best = random.below(members_.size());
    for (int k = 1; k < size; ++k) {
      const std::size_t other = random.below(members_.size());
      if (rewards_[other] > rewards_[best]) best = other;
    }
    return members_[best];
  }

  std::size_t size() const { return members_.size(); }
  void replace(std::vector<Sequence> members, std::vector<double> rewards) {
    members_ = std::move(members);
    rewards_ = std::move(rewards);
  }
  const std::vector<Sequence>& members() const { return members_; }
  const std::vector<double>& rewards() const { return rewards_; }

 private:
  std::vector<Sequence> members_;
  std::vector<double> rewards_;
};

void remember(std::vector<Elite>& elites, const Population& population, int limit) {
  for (std::size_t i = 0; i < population.size(); ++i) {
    const double reward = population.rewards()[i];
    if (reward <= 0) continue;
    const auto same = std::ranges::find_if(
        elites, [&](const Elite& elite) { return elite.sequence == population.members()[i]; });
    if (same == elites.end()) elites.push_back({population.members()[i], reward});
  }
  std::ranges::stable_sort(elites, std::ranges::greater{}, &Elite::reward);
  if (elites.size() > static_cast<std::size_t>(limit))
    elites.resize(static_cast<std::size_t>(limit));
}

std::vector<Sequence> next_generation(const Population& population, const Prior& prior,
                                      const GeneticOptions& options, const TokenLibrary& library,
                                      RandomStream& random) {
  std::vector<Sequence> children;
  while (children.size() < population.size()) {
    Sequence a = population.tournament(options.tournament, random);
    Sequence b = population.tournament(options.tournament, random);
    if (random.chance(options.crossover_probability)) {
      auto [first, second] = crossover(library, a, b, random);
      if (prior.allows(first)) a = std::move(first);
      if (prior.allows(second)) b = std::move(second);
    }
    for (Sequence* child : {&a, &b}) {
      if (!random.chance(options.mutation_probability)) continue;
      Sequence mutated = mutate(library, *child, options, random);
      if (prior.allows(mutated)) *child = std::move(mutated);
    }
    children.push_back(std::move(a));
    if (children.size() < population.size()) children.push_back(std::move(b));
  }
  return children;
}

}  // namespace

std::pair<Sequence, Sequence> crossover(const TokenLibrary& library, const Sequence& a,
                                        const Sequence& b, RandomStream& random) {
  if (a.size() < 2 || b.size() < 2) return {a, b};
  const std::size_t at_a = 1 + random.below(a.size() - 1);
  const std::size_t at_b = 1 + random.below(b.size() - 1);
  const std::size_t end_a = subtree_end(library, a, at_a);
  const std::size_t end_b = subtree_end(library, b, at_b);
  Sequence first = a;
  Sequence second = b;
  splice(first, at_a, end_a, std::span(b).subspan(at_b, end_b - at_b));
  splice(second, at_b, end_b, std::span(a).subspan(at_a, end_a - at_a));
  return {std::move(first), std::move(second)};
}

Sequence mutate(const TokenLibrary& library, const Sequence& parent, const GeneticOptions& options,
                RandomStream& random) {
  Sequence child = parent;
  switch (random.below(4)) {
    case 0:
      replace_subtree(library, options.max_mutation_depth, random, child);
      break;
    case 1:
      replace_node(library, random, child);
      break;
    case 2:
      insert_node(library, random, child);
      break;
    default:
      shrink(library, random, child);
      break;
  }
  return child;
}

std::vector<Elite> evolve(std::span<const Sequence> seed, std::span<const double> rewards,
                          const Prior& prior, const GeneticOptions& options,
                          const TokenLibrary& library, RandomStream random,
                          Scoreboard& scoreboard) {
  std::vector<Elite> elites;
  if (seed.empty()) return elites;
  Population population(seed, rewards, options, random);
  remember(elites, population, options.elites);
  for (int g = 0; g < options.generations && !scoreboard.exhausted(); ++g) {
    std::vector<Sequence> children = next_generation(population, prior, options, library, random);
    std::vector<double> scores = scoreboard.rewards(children);
    population.replace(std::move(children), std::move(scores));
    remember(elites, population, options.elites);
  }
  return elites;
}

}  // namespace tribench::udsr
