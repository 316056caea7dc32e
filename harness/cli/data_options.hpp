// SPDX-License-Identifier: MIT
//
// The options by which a command is told what a data file means: the same words everywhere.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "problems/preparation/data_options.hpp"

namespace tribench {

// Adds --roles, --joint, --where, --drop-missing, --flip-sign, --counts-per-turn, --sample-rate,
// --gear-ratio and --torque-constant; what is given is in the options when the command's callback
// runs. The options must live as long as the command. Returns the option --gear-ratio.
CLI::Option* add_data_options(CLI::App& command, const std::shared_ptr<DataOptions>& options);

// A file's columns where their names mean nothing (problems/preparation/data_options.hpp), all
// where none is named; what was dropped or converted is told on standard error. Throws Error
// (bad_input).
Dataset read_columns(const std::string& file, const DataOptions& options,
                     std::vector<std::string> used);

// What explains the target where nobody names the inputs, as in a grid (problems/user); said on
// standard error. Throws Error (bad_input): the file cannot be read twice, the target is no column,
// there is no other column.
std::vector<std::string> every_other_column(const std::string& file, const DataOptions& options,
                                            const std::string& target, std::set<std::string> taken);

// Reads the file once more and throws Error (bad_input) with the line of the first row that breaks
// the rule; returns where none does.
void require_rule(const std::string& file, const DataOptions& told, const ColumnRule& rule);

}  // namespace tribench
