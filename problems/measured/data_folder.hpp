// SPDX-License-Identifier: MIT
//
// Where measured sets lie, and whether they are what their manifests say. A data folder has one
// folder a set, named as the set, with its files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "problems/measured/manifest.hpp"

namespace tribench::measured {

// The folder given, else $TRIBENCH_DATA, else ./data; nothing where none of these is there. A
// folder that is given (either way) and is not there throws Error (bad_input).
std::optional<std::filesystem::path> find_data_folder(
    const std::optional<std::filesystem::path>& given);

enum class FileState { good, missing, changed };
struct FileCheck {
  std::string set;
  std::string file;
  FileState state = FileState::missing;
  std::string found;  // the hash that was found, where the file is changed
};

// Every file of the set against its hash; the order is the manifest's.
std::vector<FileCheck> check_set(const Manifest& manifest, const std::filesystem::path& folder);

// Copies a set from `from` (the set's folder, or one that holds it) into the data folder after
// checking every hash there; nothing is copied unless all are good. Returns the set's new folder.
std::filesystem::path add_set(const Manifest& manifest, const std::filesystem::path& from,
                              const std::filesystem::path& data_folder);

}  // namespace tribench::measured
