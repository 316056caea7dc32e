// SPDX-License-Identifier: MIT
#include "harness/cli/data_grid_options.hpp"

#include <string>

#include "harness/cli/data_options.hpp"

namespace tribench {

CLI::Option* add_data_grid_options(CLI::App& command, std::shared_ptr<DataGridRequest> request) {
  CLI::Option* files = command.add_option(
      "--data-file", request->files,
      "instead of a grid: CSV files, folders of them or 'patterns*', each file a problem");
  user::UserProblem& problem = request->problem;
  const auto goes_with = [files](CLI::Option* option) { return option->needs(files); };
  CLI::Option* target = goes_with(
      command.add_option("--target", problem.target, "of --data-file: the column to explain"));
  files->needs(target);
  goes_with(command.add_option("--inputs", problem.inputs,
                               "the columns to explain it by (default: every other)"))
      ->delimiter(',');
  goes_with(command.add_option("--methods", request->methods, "names of `tribench list methods`"))
      ->delimiter(',')
      ->capture_default_str();
  goes_with(
      command.add_option("--operators", request->operators, "names of `tribench list operators`"))
      ->delimiter(',')
      ->capture_default_str();
  goes_with(command.add_option("--group", problem.group,
                               "the column whose equal values are kept whole in the split"));
  goes_with(command.add_option("--category", problem.category,
                               "the column of numbers that tells categories apart: one shape for "
                               "all, constants of each one's own"));
  CLI::Option* split = goes_with(command.add_option_function<std::string>(
      "--split",
      [&problem](const std::string& text) {
        problem.held_out = user::parse_held_out(text, "--split");
      },
      "what tests: a share of the groups (default 0.25), or COLUMN=VALUE"));
  goes_with(command.add_option("--test", request->test, "files that test, instead"))
      ->excludes(split);
  goes_with(command.add_option("--law", problem.law, "the formula behind the target, if known"));
  goes_with(command.add_option("--together", request->together,
                               "NAME: all files are one problem of that name"));
  add_data_options(command, std::shared_ptr<DataOptions>(request, &problem.reading));
  return files;
}

}  // namespace tribench
