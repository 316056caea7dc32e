// SPDX-License-Identifier: MIT
//
// --pictures of the commands that render a run: every picture of its page as a file.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

namespace tribench {

void add_pictures_option(CLI::App& command, std::string& folder);

// SVG and PNG of each into `folder`, and a line that says how many; nothing where `folder` is
// empty. Throws Error (failed) with the package to install.
void write_run_pictures(const std::filesystem::path& run, const std::string& folder);

}  // namespace tribench
