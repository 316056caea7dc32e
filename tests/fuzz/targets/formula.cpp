// SPDX-License-Identifier: MIT
//
// A formula either is refused, or prints as text that reads back to the same tape; with holes
// (templates) it is refused or read.
#include <cmath>

#include "algorithms/expression/text.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace tribench;

bool has_finite_constants(const Expression& formula) {
  for (const Node& node : formula.nodes()) {
    if (node.is_constant() && !std::isfinite(node.value)) return false;
  }
  return true;
}

}  // namespace

TRIBENCH_FUZZ_TARGET(formula) {
  std::vector<std::string> names;
  Expression formula;
  if (fuzz::reads([&] { formula = parse_collecting_names(input, names); })) {
    fuzz::expect(has_finite_constants(formula), "a constant is read that is not finite");
    const std::string printed = print(formula, names);
    fuzz::expect(parse(printed, names) == formula, "reads back as another formula: " + printed);
  }
  const std::vector<std::string> inputs = {"v", "g"};
  std::vector<Hole> holes;
  fuzz::reads([&] { parse_with_holes(input, inputs, holes); });
}
