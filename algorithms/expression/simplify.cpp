// SPDX-License-Identifier: MIT
#include "algorithms/expression/simplify.hpp"

#include <algorithm>
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
                        }}) {}

  Expression run(Expression formula) {
    verdict_ = verdict_of(formula);
    for (int round = 0; round < kRounds && step(formula); ++round) {
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

  // To the shortest form one rewrite away, if it is shorter.
  bool step(Expression& formula) {
    std::vector<std::pair<Size, Expression>> shorter;
    const Size now = size_of(formula);
    const auto consider = [&](Expression candidate) {
      const Size size = size_of(candidate);
      if (size < now) shorter.emplace_back(size, std::move(candidate));
    };
    consider(canonicalizer_.canonical(formula));
    for (Expression& candidate : rewriter_.rewrites(formula)) {
      consider(canonicalizer_.canonical(candidate));
      consider(std::move(candidate));
    }
    std::ranges::stable_sort(shorter, {}, &std::pair<Size, Expression>::first);
    for (auto& [size, candidate] : shorter) {
      if (admits_ && !admits_(candidate)) continue;
      if (verdict_of(candidate) != verdict_) continue;
      formula = std::move(candidate);
      return true;
    }
    return false;
  }

  const InputBox& box_;
  const std::function<bool(const Expression&)>& admits_;
  Rewriter rewriter_;
  Canonicalizer canonicalizer_;
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
