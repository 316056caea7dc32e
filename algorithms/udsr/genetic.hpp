// SPDX-License-Identifier: MIT
//
// GP-meld: genetic programming seeded with a batch of the policy, its elites handed back.
//
// Source: Mundhenk et al. 2021; the public code's gp_controller.py: tournaments of 5 over the
// whole population, one-point subtree crossover and mutation with probability 0.5 each, four kinds
// of mutation equally likely, children that break a constraint replaced by a parent, generational
// replacement, the 50 best unique formulas seen as elites.
#pragma once

#include <span>
#include <vector>

#include "algorithms/udsr/population.hpp"
#include "algorithms/udsr/prior.hpp"
#include "foundation/random.hpp"

namespace tribench::udsr {

struct GeneticOptions {
  int population = 100;
  int generations = 20;
  int tournament = 5;
  double crossover_probability = 0.5;
  double mutation_probability = 0.5;
  int max_mutation_depth = 3;
  int elites = 50;
};

struct Elite {
  Sequence sequence;
  double reward = 0;
};

// seed: sequences with their rewards. Returns the elites, best first.
std::vector<Elite> evolve(std::span<const Sequence> seed, std::span<const double> rewards,
                          const Prior& prior, const GeneticOptions& options,
                          const TokenLibrary& library, RandomStream random, Scoreboard& scoreboard);

// The two variations, for tests: a child may break constraints.
std::pair<Sequence, Sequence> crossover(const TokenLibrary& library, const Sequence& a,
                                        const Sequence& b, RandomStream& random);
Sequence mutate(const TokenLibrary& library, const Sequence& parent, const GeneticOptions& options,
                RandomStream& random);

}  // namespace tribench::udsr
