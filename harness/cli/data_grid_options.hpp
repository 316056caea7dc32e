// SPDX-License-Identifier: MIT
//
// The options by which `tribench run` takes the user's own files without a grid.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>

#include "harness/data_grid.hpp"

namespace tribench {

// Adds --data-file and what goes with it; what is given is in the request when the command's
// callback runs. The request must live as long as the command. Returns the option --data-file.
CLI::Option* add_data_grid_options(CLI::App& command, std::shared_ptr<DataGridRequest> request);

}  // namespace tribench
