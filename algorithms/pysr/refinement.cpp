// SPDX-License-Identifier: MIT
#include "algorithms/pysr/refinement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "algorithms/expression/complexity.hpp"
#include "algorithms/pysr/description_length.hpp"
#include "algorithms/pysr/simplify.hpp"

namespace tribench::pysr {
namespace {

constexpr int kPolishSteps = 60;  // to convergence; a warm start needs few of them
constexpr std::size_t kStarts = 3;
constexpr std::size_t kGrown = 6;
constexpr int kRounds = 12;

}  // namespace

Refinement::Refinement(const Options& options, const OperatorSet& operators,
                       const Validator& validator, const Rows& rows, const TermLibrary& library,
                       bool fit_exponents)
    : options_(options),
      validator_(validator),
      rows_(rows),
      scorer_(validator, 1, 0, fit_exponents),
      grower_(operators, library) {}

std::optional<Candidate> Refinement::polished(Expression formula, Budget& budget) {
  formula = simplified(formula);
  const auto loss = scorer_.fit(formula, rows_, kPolishSteps, budget);
  if (!loss || !validator_.admits(formula, options_.max_size)) return std::nullopt;
  if (admitted_ && !admitted_(formula)) return std::nullopt;
  Candidate candidate;
  candidate.point.loss = *loss;
  candidate.point.size = paper_complexity(formula);
  candidate.point.description_length = description_length(formula, rows_, differentiator_)
                                           .value_or(std::numeric_limits<double>::infinity());
  candidate.formula = std::move(formula);
  return candidate;
}

bool Refinement::offer(Expression formula, Budget& budget) {
  const std::uint64_t hash = structure_hash(formula);
  const auto place = std::ranges::lower_bound(seen_, hash);
  if (place != seen_.end() && *place == hash) return false;
  seen_.insert(place, hash);
  std::optional<Candidate> candidate = polished(std::move(formula), budget);
  if (!candidate) return false;
  candidates_.push_back(std::move(*candidate));
  return true;
}

void Refinement::climb(std::size_t start, RandomStream& random, Budget& budget) {
  std::size_t current = start;
  for (int round = 0; round < kRounds && !budget.exhausted(); ++round) {
    const Expression formula = candidates_[current].formula;
    std::vector<Proposal> proposals = grower_.prune(formula, rows_, budget);
    proposals.resize(std::min(proposals.size(), kGrown));
    std::vector<Proposal> grown = grower_.grow(formula, rows_, 0, kGrown, random, budget);
    proposals.insert(proposals.end(), grown.begin(), grown.end());
    std::size_t best = current;
    for (const Proposal& proposal : proposals) {
      Expression child = simplified(proposal.formula);
      if (!validator_.admits(child, options_.max_size) || !offer(std::move(child), budget))
        continue;
      if (candidates_.back().point.description_length <
          candidates_[best].point.description_length) {
        best = candidates_.size() - 1;
      }
    }
    if (best == current) return;
    current = best;
  }
}

std::vector<Candidate> Refinement::pareto() const {
  std::vector<Candidate> sorted = candidates_;
  std::ranges::stable_sort(sorted, [](const Candidate& a, const Candidate& b) {
    if (a.point.size != b.point.size) return a.point.size < b.point.size;
    if (a.point.loss != b.point.loss) return a.point.loss < b.point.loss;
    return a.formula.size() < b.formula.size();
  });
  std::vector<Candidate> front;
  for (Candidate& candidate : sorted) {
    if (front.empty() || (candidate.point.size > front.back().point.size &&
                          candidate.point.loss < front.back().point.loss)) {
      front.push_back(std::move(candidate));
    }
  }
  return front;
}

std::vector<Candidate> Refinement::front_of(const std::vector<Member>& members, RandomStream random,
                                            Budget& budget) {
  for (const Member& member : members) {
    if (budget.exhausted()) break;
    offer(member.formula, budget);
  }
  if (options_.refine) {
    std::vector<std::size_t> order(candidates_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::stable_sort(
        order, {}, [this](std::size_t i) { return candidates_[i].point.description_length; });
    order.resize(std::min(order.size(), kStarts));
    for (const std::size_t start : order) climb(start, random, budget);
  }
  return pareto();
}

}  // namespace tribench::pysr
