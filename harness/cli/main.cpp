// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "foundation/error.hpp"
#include "harness/provenance.hpp"

int main(int argc, char** argv) {
  CLI::App app("Benchmarks symbolic regression of joint friction, and closes the loop with data.");
  app.set_version_flag("--version", std::string(tribench::version()));
  CLI11_PARSE(app, argc, argv);
  return 0;
}
