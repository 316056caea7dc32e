// SPDX-License-Identifier: MIT
//
// Anyone's own method of diagnosis in the study of the closed loop: a program in any language,
// run once a case. The protocol is docs/own_diagnosis.md. It is judged like the loop itself; it
// sees the training movements and the held-out ones without their target.
#pragma once

#include <string>
#include <vector>

#include "harness/study/loop_methods.hpp"

namespace tribench {

// What an answer is read against.
struct AskedDiagnosis {
  std::vector<std::string> movement_names;
  std::vector<char> held_out;  // per row, 1: to be predicted
  std::vector<double> before;  // the base's predictions, per row
};

// The last JSON object that a program printed, on one line or several. Throws Error (failed) where
// it is no answer: a verdict or family that there is not, a number that is none.
LoopAnswer read_diagnosis(const std::string& output, const AskedDiagnosis& asked);

// command: the words to run; the path of the request is added as the last. Unusable answers and an
// exit status other than 0 throw Error (failed) that names the case; so does a case that takes
// longer than `limit_s` of wall time, and the program is ended with all it has started.
LoopMethod make_external_diagnosis(std::vector<std::string> command, double limit_s = 600);

}  // namespace tribench
