// SPDX-License-Identifier: MIT
//
// An input box either is refused, or prints as text that reads back to the same box.
#include "algorithms/expression/input_box.hpp"
#include "tests/fuzz/fuzz_target.hpp"

TRIBENCH_FUZZ_TARGET(box) {
  using namespace tribench;
  NamedBox box;
  if (!fuzz::reads([&] {
        box = parse_box(input);
        check_box(Expression::constant(1), box.ranges);
      })) {
    return;
  }
  const std::string printed = print_box(box);
  const NamedBox again = parse_box(printed);
  fuzz::expect(again.names == box.names, "reads back with other names: " + printed);
  for (std::size_t i = 0; i < box.ranges.size(); ++i) {
    const InputRange& a = box.ranges[i];
    const InputRange& b = again.ranges[i];
    fuzz::expect(a.sign_of == b.sign_of && (a.sign_of || (a.low == b.low && a.high == b.high)),
                 "reads back as another box: " + printed);
  }
}
