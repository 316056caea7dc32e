// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "foundation/error.hpp"
#include "harness/cli/commands.hpp"
#include "harness/provenance.hpp"

namespace {

int exit_code(tribench::ExitStatus status) { return static_cast<int>(status); }

// Usage errors are bad input (2); --help and --version are done (0).
int report_usage(const CLI::App& app, const CLI::ParseError& error) {
  const int code = app.exit(error);
  return exit_code(code == 0 ? tribench::ExitStatus::done : tribench::ExitStatus::bad_input);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Benchmarks symbolic regression of joint friction, and closes the loop with data.",
               "tribench");
  app.set_version_flag("--version", std::string(tribench::version()));
  app.require_subcommand(1);
  tribench::ExitStatus status = tribench::ExitStatus::done;
  tribench::add_generate_command(app, status);
  tribench::add_list_command(app, status);
  tribench::add_check_command(app, status);
  tribench::add_study_command(app, status);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return report_usage(app, error);
  } catch (const tribench::Error& error) {
    fmt::print(stderr, "tribench: {}\n", error.what());
    return exit_code(error.kind() == tribench::ErrorKind::bad_input
                         ? tribench::ExitStatus::bad_input
                         : tribench::ExitStatus::failed);
  } catch (const std::exception& error) {
    fmt::print(stderr, "tribench: {}\n", error.what());
    return exit_code(tribench::ExitStatus::failed);
  }
  return exit_code(status);
}
