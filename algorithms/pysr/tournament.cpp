// SPDX-License-Identifier: MIT
#include "algorithms/pysr/tournament.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "foundation/elementary.hpp"

namespace tribench::pysr {
namespace {

constexpr double kFrequencyOutOfRange = 1e-6;  // SymbolicRegression.jl, Mutate.jl

double frequency_or_floor(const SizeFrequencies& frequencies, int size) {
  const double frequency = frequencies.normalised(size);
  return frequency > 0 ? frequency : kFrequencyOutOfRange;
}

}  // namespace

std::size_t draw_rank(std::size_t contestants, double p, RandomStream& random) {
  const double total = 1 - elementary::pow(1 - p, static_cast<double>(contestants));
  double left = random.uniform() * total;
  double share = p;
  for (std::size_t rank = 0; rank + 1 < contestants; ++rank) {
    if (left < share) return rank;
    left -= share;
    share *= 1 - p;
  }
  return contestants - 1;
}

std::size_t run_tournament(std::span<const Member> members, const SizeFrequencies& frequencies,
                           const Options& options, RandomStream& random) {
  const std::size_t contestants =
      std::min(members.size(), static_cast<std::size_t>(options.tournament_size));
  struct Contestant {
    double cost;
    std::size_t member;
  };
  std::vector<std::size_t> order(members.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<Contestant> field(contestants);
  for (std::size_t k = 0; k < contestants; ++k) {
    std::swap(order[k], order[k + random.below(members.size() - k)]);
    const Member& member = members[order[k]];
    double cost = member.cost;
    if (options.use_frequency_in_tournament) {
      cost *= elementary::exp(options.adaptive_parsimony * frequencies.normalised(member.size));
    }
    field[k] = {cost, order[k]};
  }
  const auto rank =
      static_cast<std::ptrdiff_t>(draw_rank(contestants, options.tournament_probability, random));
  std::nth_element(field.begin(), field.begin() + rank, field.end(),
                   [](const Contestant& a, const Contestant& b) {
                     return a.cost != b.cost ? a.cost < b.cost : a.member < b.member;
                   });
  return field[static_cast<std::size_t>(rank)].member;
}

std::size_t oldest_of(std::span<const Member> members) {
  return static_cast<std::size_t>(std::ranges::min_element(members, {}, &Member::birth) -
                                  members.begin());
}

double acceptance(double cost_child, double cost_parent, int size_child, int size_parent,
                  double temperature, const SizeFrequencies& frequencies, const Options& options) {
  double probability = 1;
  if (options.annealing) {
    probability *= elementary::exp(-(cost_child - cost_parent) / (temperature * options.alpha));
  }
  if (options.use_frequency) {
    probability *=
        frequency_or_floor(frequencies, size_parent) / frequency_or_floor(frequencies, size_child);
  }
  return probability;
}

}  // namespace tribench::pysr
