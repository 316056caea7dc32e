// SPDX-License-Identifier: MIT
//
// The folder that a command writes its answer to, made and tried before the work and not after it.
#pragma once

#include <filesystem>

namespace tribench {

// Makes the folder and those above it, and sees that a file can be written there. Throws Error
// (failed) where not.
void make_output_folder(const std::filesystem::path& folder);

}  // namespace tribench
