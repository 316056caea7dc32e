// SPDX-License-Identifier: MIT
//
// A file of planned movements either is refused with a place, or is written again as a file that
// reads the same.
#include "problems/experiment/planned_movement.hpp"
#include "tests/fuzz/fuzz_target.hpp"

TRIBENCH_FUZZ_TARGET(movements) {
  using namespace tribench;
  std::vector<PlannedMovement> movements;
  if (!fuzz::reads([&] { movements = read_movements(input, "movements.csv"); })) return;
  const std::string written = movements_text(movements, "rad", "rad/s");
  const std::string again = movements_text(read_movements(written, "written.csv"), "rad", "rad/s");
  fuzz::expect(again == written, "what is written reads as something else:\n" + written);
}
