// SPDX-License-Identifier: MIT
#include "algorithms/pysr/refinement.hpp"

#include <algorithm>

#include "algorithms/expression/complexity.hpp"
#include "algorithms/fitting/description_length.hpp"
#include "algorithms/fitting/evidence.hpp"
#include "algorithms/fitting/posterior_choice.hpp"

namespace tribench::pysr {
namespace {

constexpr std::size_t kStarts = 5;

std::vector<Candidate> pareto_of(std::vector<Candidate> candidates,
                                 const std::function<bool(const Expression&)>& admitted) {
  std::ranges::stable_sort(candidates, [](const Candidate& a, const Candidate& b) {
    if (a.point.size != b.point.size) return a.point.size < b.point.size;
    if (a.point.loss != b.point.loss) return a.point.loss < b.point.loss;
    return a.formula.size() < b.formula.size();
  });
  std::vector<Candidate> front;
  for (Candidate& candidate : candidates) {
    const bool better = front.empty() || (candidate.point.size > front.back().point.size &&
                                          candidate.point.loss < front.back().point.loss);
    if (!better || (admitted && !admitted(candidate.formula))) continue;
    front.push_back(std::move(candidate));
  }
  return front;
}

// What a choice from the front may ask for, besides size and loss.
void describe(std::vector<Candidate>& front, std::span<const Candidate> pool, const Rows& rows,
              Budget& budget) {
  std::vector<WeighedFormula> weighed;
  for (const Candidate& candidate : pool) {
    weighed.push_back({&candidate.formula, candidate.point.evidence_against, candidate.point.loss});
  }
  std::vector<Expression> formulas;
  for (const Candidate& candidate : front) formulas.push_back(candidate.formula);
  const PosteriorDistances distances =
      distances_from_posterior_mean(formulas, weighed, rows.inputs());
  budget.spend(distances.node_rows);
  Differentiator workspace;
  for (std::size_t k = 0; k < front.size(); ++k) {
    front[k].point.distance = distances.mean_square[k];
    front[k].point.description_length =
        description_length(front[k].formula, rows.inputs(), rows.target, workspace);
  }
}

}  // namespace

std::vector<Candidate> refined_front(Climber& climber, const Options& options, const Form& form,
                                     const Rows& rows, const std::vector<Member>& members,
                                     const std::function<bool(const Expression&)>& admitted,
                                     RandomStream random, Budget& budget) {
  std::vector<Candidate> candidates;
  const auto enter = [&](const Fitted& fitted) {
    Candidate candidate{fitted.formula, {}};
    candidate.point.loss = fitted.loss;
    candidate.point.evidence_against = fitted.against;
    candidate.point.size = paper_complexity(form.columns().written_out(fitted.formula));
    candidates.push_back(std::move(candidate));
  };
  climber.on_fitted(enter);
  const ClimbEffort effort;
  const double zero = zero_loss(rows);
  std::vector<Fitted> starts;
  for (const Member& member : members) {
    std::optional<Fitted> polished = climber.fitted(member.formula, effort.fit_steps, budget);
    if (polished) starts.push_back(std::move(*polished));
    // What the search has found is not lost when the budget ends before the polish.
    if (!polished && budget.exhausted()) {
      enter({member.formula, member.loss,
             evidence_against(member.formula, member.loss, zero, rows.size())});
    }
  }
  if (options.refine) {
    std::ranges::stable_sort(starts, {}, &Fitted::against);
    starts.resize(std::min(starts.size(), kStarts));
    for (const Fitted& start : starts) climber.climb(start, effort, random, budget);
  }
  climber.on_fitted({});
  std::vector<Candidate> front = pareto_of(candidates, admitted);
  describe(front, candidates, rows, budget);
  return front;
}

}  // namespace tribench::pysr
