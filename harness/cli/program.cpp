// SPDX-License-Identifier: MIT
#include "harness/cli/program.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstring>
#include <exception>

#include "foundation/error.hpp"
#include "harness/cli/commands.hpp"
#include "harness/provenance.hpp"
#include "harness/worker.hpp"

namespace tribench {
namespace {

int exit_code(ExitStatus status) { return static_cast<int>(status); }

// Usage errors are bad input (2); --help and --version are done (0).
int report_usage(const CLI::App& app, const CLI::ParseError& error) {
  const int code = app.exit(error);
  return exit_code(code == 0 ? ExitStatus::done : ExitStatus::bad_input);
}

int run_command_line(int argc, char** argv, const Registry& registry) {
  CLI::App app("Benchmarks symbolic regression of joint friction, and closes the loop with data.",
               "tribench");
  app.set_version_flag("--version", version_with_commit());
  app.require_subcommand(1);
  app.footer(
      "Every subcommand has --help with an example.\n"
      "Exit status: 0 done, 1 found what it was asked to look for (a regression, a singularity), 2 "
      "bad "
      "input, 3 failed, 4 undecided.");
  ExitStatus status = ExitStatus::done;
  add_run_command(app, status, registry);
  add_fit_command(app, status, registry);
  add_merge_command(app, status);
  add_pretrain_command(app, status);
  add_report_command(app, status);
  add_check_command(app, status);
  add_data_command(app, status);
  add_compare_command(app, status);
  add_export_command(app, status);
  add_generate_command(app, status);
  add_loop_command(app, status, registry);
  add_list_command(app, status, registry);
  add_study_command(app, status);
  add_submit_command(app, status, registry);
  add_describe_command(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return report_usage(app, error);
  }
  return exit_code(status);
}

}  // namespace

int run_program(int argc, char** argv, const Registry& registry) {
  try {
    if (argc == 2 && std::strcmp(argv[1], kWorkerCommand) == 0) return run_worker(registry);
    return run_command_line(argc, argv, registry);
  } catch (const Error& error) {
    fmt::print(stderr, "tribench: {}\n", error.what());
    return exit_code(error.kind() == ErrorKind::bad_input ? ExitStatus::bad_input
                                                          : ExitStatus::failed);
  } catch (const std::exception& error) {
    fmt::print(stderr, "tribench: {}\n", error.what());
    return exit_code(ExitStatus::failed);
  }
}

}  // namespace tribench
