// SPDX-License-Identifier: MIT
#include "algorithms/expression/simplify.hpp"

#include <algorithm>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "algorithms/expression/canonical.hpp"
#include "algorithms/expression/complexity.hpp"
#include "algorithms/expression/rewrite.hpp"
#include "algorithms/expression/singularity.hpp"

namespace tribench {
namespace {

constexpr ProofLimits kGuardLimits = {.node_boxes = 5'000};
constexpr ProofLimits kVerdictLimits = {.node_boxes = 50'000};
constexpr int kRounds = 40;
// Larger ones are left as they are: the rewrites of a long sum are many.
constexpr std::size_t kLargest = 200;

// Two rewrites at once: of formulas of so many nodes, over so many more, by so many ways.
constexpr std::size_t kLargestLeap = 60;
constexpr int kDetour = 8;
constexpr std::size_t kMostBetween = 24;
constexpr int kWorthAProof = 1;  // longer

using Size = std::pair<int, int>;

Size size_of(const Expression& formula) { return {paper_complexity(formula), node_count(formula)}; }

class Descent {
 public:
  Descent(const InputBox& box, const std::function<bool(const Expression&)>& admits)
      : box_(box),
        admits_(admits),
        rewriter_(box),
        canonicalizer_({[this](const Expression& x) { return is_finite(x); },
                        [this](const Expression& x) {
                          return is_finite(Expression::binary(Op::div, Expression::constant(1), x));
                        }}),
        continuer_({[this](const Expression& x) { return is_finite(x); },
                    [this](const Expression& x) { return is_finite(x); }}) {}

  Expression run(Expression formula) {
    verdict_ = verdict_of(formula);
    for (int round = 0; round < kRounds && (step(formula) || leap(formula)); ++round) {
    }
    return formula;
  }

 private:
  bool is_finite(const Expression& formula) const {
    return prove_free(formula, box_, kGuardLimits).verdict == Verdict::proved_free;
  }
  Verdict verdict_of(const Expression& formula) const {
    return prove_free(formula, box_, kVerdictLimits).verdict;
  }

  using Candidates = std::vector<std::pair<Size, Expression>>;

  // Those that are shorter, as they are and in canonical form; while the formula is not proved
  // those hardly longer, too.
  void add_shorter(const std::vector<Expression>& rewrites, Size than, Candidates& out) {
    const bool is_proved = verdict_ == Verdict::proved_free;
    const auto consider = [&](Expression candidate) {
      const Size size = size_of(candidate);
      if (size < than || (size.first <= than.first + kWorthAProof && !is_proved))
        out.emplace_back(size, std::move(candidate));
    };
    for (const Expression& candidate : rewrites) {
      consider(canonicalizer_.canonical(candidate));
      consider(continuer_.canonical(candidate));
      consider(candidate);
    }
  }

  // The shortest that may be used; one that is no shorter has to be proved.
  bool take_shortest(Candidates candidates, Expression& formula) {
    const Size now = size_of(formula);
    std::ranges::stable_sort(candidates, {}, &std::pair<Size, Expression>::first);
    for (auto& [size, candidate] : candidates) {
      if (candidate == formula || (admits_ && !admits_(candidate))) continue;
      const Verdict verdict = verdict_of(candidate);
      const bool is_kept = verdict == verdict_ && size < now;
      if (!is_kept && verdict != Verdict::proved_free) continue;
      verdict_ = verdict;
      formula = std::move(candidate);
      return true;
    }
    return false;
  }

  // To the shortest form one rewrite away, if it is shorter.
  bool step(Expression& formula) {
    Candidates shorter;
    add_shorter({canonicalizer_.canonical(formula)}, size_of(formula), shorter);
    add_shorter(rewriter_.rewrites(formula), size_of(formula), shorter);
    return take_shortest(std::move(shorter), formula);
  }

  // To the shortest form two rewrites away, over one that is a little longer.
  bool leap(Expression& formula) {
    if (formula.size() > kLargestLeap) return false;
    const Size now = size_of(formula);
    std::set<std::uint64_t> seen = {canonicalizer_.hash(formula).exact};
    Candidates between;
    for (const Expression& rewrite : rewriter_.rewrites(formula)) {
      if (!seen.insert(canonicalizer_.hash(rewrite).exact).second) continue;
      Expression canonical = canonicalizer_.canonical(rewrite);
      const Size size = size_of(canonical);
      if (size.second <= now.second + kDetour) between.emplace_back(size, std::move(canonical));
    }
    std::ranges::stable_sort(between, {}, &std::pair<Size, Expression>::first);
    if (between.size() > kMostBetween) between.resize(kMostBetween);
    Candidates shorter;
    for (const auto& [size, candidate] : between) {
      add_shorter(rewriter_.rewrites(candidate), now, shorter);
    }
    return take_shortest(std::move(shorter), formula);
  }

  const InputBox& box_;
  const std::function<bool(const Expression&)>& admits_;
  Rewriter rewriter_;
  Canonicalizer canonicalizer_;
  Canonicalizer continuer_;  // x/x is 1 where x is 0, too
  Verdict verdict_ = Verdict::undecided;
};

}  // namespace

Expression simplify(const Expression& formula, const InputBox& box,
                    const std::function<bool(const Expression&)>& admits) {
  check_box(formula, box);
  if (formula.size() > kLargest) return formula;
  return Descent(box, admits).run(formula);
}

}  // namespace tribench
