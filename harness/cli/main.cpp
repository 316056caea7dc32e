// SPDX-License-Identifier: MIT
#include "algorithms/registry.hpp"
#include "harness/cli/program.hpp"

int main(int argc, char** argv) { return tribench::run_program(argc, argv, tribench::Registry()); }
