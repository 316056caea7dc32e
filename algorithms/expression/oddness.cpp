// SPDX-License-Identifier: MIT
#include "algorithms/expression/oddness.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "algorithms/expression/bounds.hpp"
#include "algorithms/expression/canonical.hpp"
#include "foundation/random.hpp"

namespace tribench {
namespace {

// The formula at the mirrored point: v and its sign turned round.
Expression mirrored(const Expression& formula, const InputBox& box, std::size_t velocity) {
  std::vector<Node> tape;
  for (const Node& node : formula.nodes()) {
    tape.push_back(node);
    if (node.is_variable() &&
        (node.variable == velocity || box[node.variable].sign_of == velocity)) {
      tape.push_back({0, 0, 0, Op::neg});
    }
  }
  return Expression(std::move(tape));
}

}  // namespace

PropertyResult prove_odd(const Expression& formula, const InputBox& box, std::size_t velocity) {
  constexpr int kPoints = 500;
  PropertyResult result;
  const Expression sum = Expression::binary(Op::add, formula, mirrored(formula, box, velocity));
  // The formula is proved finite, and so is its mirror image: every term may cancel.
  Canonicalizer canonicalizer({[](const Expression&) { return true; }, {}});
  if (is_zero(canonicalizer.canonical(sum))) {
    result.verdict = Verdict::proved_free;
    return result;
  }
  const double reach = std::min(box[velocity].high, -box[velocity].low);
  FormulaBounds bounds(sum);
  RandomStream random(key_of("odd"));
  std::vector<double> point(box.size());
  for (int i = 0; i < kPoints; ++i) {
    for (std::size_t j = 0; j < box.size(); ++j) {
      point[j] = j == velocity ? random.uniform(0, reach) : random.uniform(box[j].low, box[j].high);
    }
    set_signs(box, point);
    ++result.boxes;
    if (value_at(bounds, point).contains(0)) continue;
    std::vector<double> mirror = point;
    mirror[velocity] = -point[velocity];
    set_signs(box, mirror);
    result.verdict = Verdict::refuted;
    result.witness = Witness{point, mirror, formula.root()};
    return result;
  }
  result.undecided_box = whole_box(box);
  return result;
}

}  // namespace tribench
