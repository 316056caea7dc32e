// SPDX-License-Identifier: MIT
//
// A method in any language, run as a program: CSV and JSON in, formulas out (the protocol is
// docs/external_methods.md). It is judged like a native method: what it says of its own errors is
// a trace, never a result.
//
// The program runs under this process's limits of memory, with a folder for temporary files of its
// own; it and all it starts end with its answer or with this process, whichever comes first.
#pragma once

#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "algorithms/regressor.hpp"

namespace tribench {

// What a program may take where nobody else watches it: beyond that it is ended.
struct ProgramLimits {
  double cpu_s = std::numeric_limits<double>::infinity();
  double wall_s = std::numeric_limits<double>::infinity();
};

// command: the words to run; the path of the request file is added as the last. Parameters are
// handed on as they are. Unusable answers (no front, a formula that does not parse or leaves the
// operator set, an exit status other than 0) and a program beyond its limits throw Error (failed)
// from fit(); a full disk throws Error (environment).
std::unique_ptr<Regressor> make_external_method(std::vector<std::string> command,
                                                std::map<std::string, ParameterValue> parameters,
                                                ProgramLimits limits = {});

}  // namespace tribench
