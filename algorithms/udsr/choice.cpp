// SPDX-License-Identifier: MIT
#include "algorithms/udsr/choice.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "algorithms/expression/differentiate.hpp"
#include "algorithms/expression/singularity.hpp"
#include "algorithms/fitting/cross_validation.hpp"
#include "algorithms/fitting/description_length.hpp"
#include "algorithms/fitting/evidence.hpp"
#include "algorithms/fitting/posterior_choice.hpp"
#include "algorithms/udsr/pruning.hpp"
#include "foundation/elementary.hpp"

namespace tribench::udsr {
namespace {

// Below this normalised error all formulas are exact, and the simplest is the one.
constexpr double kExact = 1e-9;

std::size_t place_of_least(const std::vector<double>& values) {
  return static_cast<std::size_t>(std::ranges::min_element(values) - values.begin());
}

std::size_t shortest(std::span<const Expression> front, const ScoringProblem& problem,
                     Budget& budget) {
  Differentiator differentiator;
  std::vector<double> lengths;
  for (const Expression& formula : front) {
    lengths.push_back(
        description_length(formula, problem.inputs(), problem.target(), differentiator));
    budget.spend(4 * node_rows(formula, problem.rows()));
  }
  return place_of_least(lengths);
}

// n ln(RSS / n) + p ln n.
std::size_t least_bic(std::span<const Expression> front, const ScoringProblem& problem) {
  const auto n = static_cast<double>(problem.rows());
  Scorer scorer(problem);
  std::vector<double> criteria;
  for (const Expression& formula : front) {
    const auto constants = static_cast<double>(movable_constants(formula).size());
    criteria.push_back(2 * n * elementary::log(scorer.nrmse(formula) + kExact) +
                       constants * elementary::log(n));
  }
  return place_of_least(criteria);
}

std::size_t typical_of_posterior(std::span<const Expression> front, std::span<const Candidate> pool,
                                 const ScoringProblem& problem, Budget& budget) {
  constexpr double kNodesAreFree = 0;
  double zero_loss = 0;
  for (const double y : problem.target()) zero_loss += y * y / static_cast<double>(problem.rows());
  std::vector<WeighedFormula> weighed;
  for (const Candidate& candidate : pool) {
    const double variance = problem.variance() > 0 ? problem.variance() : 1;
    const double mean_square = candidate.nrmse * candidate.nrmse * variance;
    weighed.push_back(
        {&candidate.formula,
         evidence_against(candidate.formula, mean_square, zero_loss, problem.rows(), kNodesAreFree),
         mean_square});
  }
  const PosteriorDistances distances =
      distances_from_posterior_mean(front, weighed, problem.inputs());
  budget.spend(distances.node_rows);
  return simplest_typical(distances);
}

// The first formula that is exact on every row; none where there is noise.
std::optional<std::size_t> simplest_exact(std::span<const Expression> front,
                                          const ScoringProblem& problem) {
  Scorer scorer(problem);
  for (std::size_t k = 0; k < front.size(); ++k) {
    if (scorer.nrmse(front[k]) < kExact) return k;
  }
  return std::nullopt;
}

}  // namespace

Choice choice_of(const std::string& name) {
  if (name == "description_length") return Choice::description_length;
  if (name == "cross_validation") return Choice::cross_validation;
  if (name == "simpler") return Choice::simpler;
  return name == "bic" ? Choice::bic : Choice::posterior;
}

std::size_t choose(Choice rule, std::span<const Expression> front, std::span<const Candidate> pool,
                   const ScoringProblem& problem, const InputBox& box, Budget& budget) {
  if (rule == Choice::description_length) return shortest(front, problem, budget);
  // Beyond the rows no criterion speaks: held-out edges do, even where the search spent everything.
  const bool beyond = reaches_beyond(problem.inputs(), box) && !budget.out_of_time();
  if (rule == Choice::posterior && !beyond) {
    return typical_of_posterior(front, pool, problem, budget);
  }
  if (rule == Choice::bic || (budget.exhausted() && !beyond)) return least_bic(front, problem);
  const CrossValidation validation =
      cross_validate(front, problem.inputs(), problem.target(), problem.movement(), box);
  budget.spend(validation.node_rows);
  if (rule == Choice::cross_validation || beyond) return validation.chosen;
  return std::min(validation.chosen, least_bic(front, problem));
}

std::size_t choose_sound(Choice rule, const std::vector<Expression>& front,
                         std::span<const Candidate> pool, const ScoringProblem& problem,
                         const InputBox& box, Budget& budget) {
  if (const std::optional<std::size_t> exact = simplest_exact(front, problem)) return *exact;
  std::vector<Expression> left = front;
  std::vector<std::size_t> places(front.size());
  std::iota(places.begin(), places.end(), 0);
  while (true) {
    const std::size_t chosen = choose(rule, left, pool, problem, box, budget);
    if (left.size() == 1 || prove_free(left[chosen], box).verdict != Verdict::refuted) {
      return places[chosen];
    }
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(chosen));
    places.erase(places.begin() + static_cast<std::ptrdiff_t>(chosen));
  }
}

}  // namespace tribench::udsr
