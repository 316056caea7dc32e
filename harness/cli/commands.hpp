// SPDX-License-Identifier: MIT
//
// One function per subcommand, each in a file of its own (<name>_command.cpp): it adds the
// subcommand to the program and, where it is given, runs it and leaves the exit status.
#pragma once

#include <CLI/App.hpp>

#include "algorithms/registry.hpp"

namespace tribench {

// Exit statuses that every subcommand keeps to.
enum class ExitStatus : int {
  done = 0,
  found = 1,  // what it was asked to look for: a regression, a singularity
  bad_input = 2,
  failed = 3,
  undecided = 4,
};

// The hidden word that makes the program a worker process.
inline constexpr const char* kWorkerCommand = "worker";

void add_challenge_command(CLI::App& app, ExitStatus& status);
void add_check_command(CLI::App& app, ExitStatus& status);
void add_data_command(CLI::App& app, ExitStatus& status);
void add_fit_command(CLI::App& app, ExitStatus& status, const Registry& registry);
void add_generate_command(CLI::App& app, ExitStatus& status);
void add_history_command(CLI::App& app, ExitStatus& status);
void add_nightly_command(CLI::App& app, ExitStatus& status, const Registry& registry);
void add_list_command(CLI::App& app, ExitStatus& status, const Registry& registry);
void add_loop_command(CLI::App& app, ExitStatus& status, const Registry& registry);
void add_merge_command(CLI::App& app, ExitStatus& status);
void add_pretrain_command(CLI::App& app, ExitStatus& status);
void add_report_command(CLI::App& app, ExitStatus& status);
void add_run_command(CLI::App& app, ExitStatus& status, const Registry& registry);
void add_study_command(CLI::App& app, ExitStatus& status, const Registry& registry);
void add_submit_command(CLI::App& app, ExitStatus& status, const Registry& registry);
void add_compare_command(CLI::App& app, ExitStatus& status);
void add_explore_command(CLI::App& app, ExitStatus& status);
void add_export_command(CLI::App& app, ExitStatus& status);
void add_predict_command(CLI::App& app, ExitStatus& status);
void add_simulate_command(CLI::App& app, ExitStatus& status);
void add_world_command(CLI::App& app, ExitStatus& status);
void add_describe_command(CLI::App& app);
// Under `list`.
void add_problem_listing(CLI::App& list);
// Under `study`.
void add_comparison_study(CLI::App& study, ExitStatus& status);
void add_night_study(CLI::App& study, ExitStatus& status, const Registry& registry);
void add_exploration_study(CLI::App& study);
void add_recordings_study(CLI::App& study);
void add_recovery_study(CLI::App& study);

}  // namespace tribench
