// SPDX-License-Identifier: MIT
//
// The program with the tests' own methods besides the real ones.
#include "harness/cli/program.hpp"
#include "tests/support/test_methods.hpp"

int main(int argc, char** argv) {
  tribench::Registry registry;
  tribench::add_test_methods(registry);
  return tribench::run_program(argc, argv, registry);
}
