// SPDX-License-Identifier: MIT
#include "algorithms/expression/complexity.hpp"

namespace tribench {

int paper_complexity(const Expression& formula) {
  int count = 0;
  for (const Node& node : formula.nodes()) {
    if (node.op != Op::constant && node.op != Op::neg) ++count;
  }
  return count;
}

}  // namespace tribench
