// SPDX-License-Identifier: MIT
//
// What a program answers as a method of diagnosis: it fails its case with a reason, or gives a
// prediction for every row that was held out and none elsewhere.
#include <cmath>

#include "foundation/error.hpp"
#include "harness/study/external_diagnosis.hpp"
#include "tests/fuzz/fuzz_target.hpp"

TRIBENCH_FUZZ_TARGET(diagnosis) {
  using namespace tribench;
  const AskedDiagnosis asked{{"up", "down"}, {0, 1, 1}, {0.5, 0.25, -0.5}};
  try {
    const LoopAnswer answer = read_diagnosis(std::string(input), asked);
    fuzz::expect(answer.after.size() == 3 && answer.before.size() == 3, "as many rows as asked");
    for (std::size_t row = 0; row < 3; ++row) {
      fuzz::expect(std::isfinite(answer.after[row]) == (asked.held_out[row] == 1),
                   "a prediction is missing, or not asked for");
    }
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::failed) throw;  // the case's failure, and nobody else's
  }
}
