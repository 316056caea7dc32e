// SPDX-License-Identifier: MIT
//
// What a run was asked to do, and on which data: two runs that differ in it are not two answers to
// one question. Code and machine are no conditions: they are what a comparison is about.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "reports/run_folder.hpp"

namespace tribench {

// The settings of a run's grid.toml as the program writes it, flattened: {"budget.evaluations",
// "500000000"}, {"method pysr.parameters.populations", "8"}. Empty where there is no such file.
std::map<std::string, std::string> read_settings(const std::filesystem::path& grid_toml);

// One line each, for people: "budget.evaluations: 500000000 -> 2000000", "the data differ". The
// grid's name does not count. Empty where nothing differs or neither run has a grid.toml.
std::vector<std::string> condition_differences(const RunFolder& base, const RunFolder& now);

}  // namespace tribench
