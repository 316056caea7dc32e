// SPDX-License-Identifier: MIT
//
// A formula with states either is refused, or prints as text that reads back and prints the same;
// what is read passes the laws' own check.
#include "algorithms/states/state_text.hpp"
#include "tests/fuzz/fuzz_target.hpp"

using namespace tribench;

TRIBENCH_FUZZ_TARGET(stateful) {
  std::vector<std::string> names;
  StatefulFormula formula;
  if (fuzz::reads([&] { formula = parse_stateful_collecting(input, names); })) {
    fuzz::expect(formula.first_state == names.size(), "states do not follow the inputs");
    for (const StateDeclaration& state : formula.states) check_state(state, names.size());
    const std::string printed = print_stateful(formula, names);
    const std::string again = print_stateful(parse_stateful(printed, names), names);
    fuzz::expect(again == printed, "reads back as another formula: " + printed);
  }
  NamedBox box = parse_box("v=-2:2,g=-60:60");
  fuzz::reads([&] { parse_stateful_over(input, box); });
}
