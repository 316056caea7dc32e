// SPDX-License-Identifier: MIT
#include "algorithms/expression/simplify.hpp"

#include <utility>

#include "algorithms/expression/canonical.hpp"
#include "algorithms/expression/complexity.hpp"
#include "algorithms/expression/singularity.hpp"

namespace tribench {
namespace {

constexpr ProofLimits kGuardLimits = {.node_boxes = 20'000};

bool is_proved(const Expression& formula, const InputBox& box) {
  return prove_free(formula, box, kGuardLimits).verdict == Verdict::proved_free;
}

std::pair<int, int> size_of(const Expression& formula) {
  return {paper_complexity(formula), node_count(formula)};
}

}  // namespace

Expression simplify(const Expression& formula, const InputBox& box) {
  check_box(formula, box);
  const RewriteGuard guard{[&box](const Expression& x) { return is_proved(x, box); },
                           [&box](const Expression& x) {
                             return is_proved(
                                 Expression::binary(Op::div, Expression::constant(1), x), box);
                           }};
  const Expression canonical = Canonicalizer(guard).canonical(formula);
  if (size_of(canonical) >= size_of(formula)) return formula;
  const bool same_verdict = prove_free(canonical, box).verdict == prove_free(formula, box).verdict;
  return same_verdict ? canonical : formula;
}

}  // namespace tribench
