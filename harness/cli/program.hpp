// SPDX-License-Identifier: MIT
//
// The whole program as a function, so that a program of one's own can offer more methods under the
// same command line:
//
//   int main(int argc, char** argv) {
//     tribench::Registry registry;
//     registry.add({"mine", "what it is", {}, false, make_mine});
//     return tribench::run_program(argc, argv, registry);
//   }
//
// Worker processes are this same program, so they know the same methods.
#pragma once

#include "algorithms/registry.hpp"

namespace tribench {

// The process's exit status.
int run_program(int argc, char** argv, const Registry& registry);

}  // namespace tribench
