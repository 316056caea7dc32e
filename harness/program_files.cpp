// SPDX-License-Identifier: MIT
#include "harness/program_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "foundation/child_process.hpp"
#include "problems/file_hash.hpp"

namespace tribench {

std::map<std::string, std::string> program_files(const Grid& grid) {
  std::map<std::string, std::string> files;
  for (const Method& method : grid.methods) {
    for (const std::string& word : method.command) {
      const bool is_program = &word == &method.command.front();
      const std::string file = is_program ? found_in_path(word) : word;
      std::error_code missing;
      const bool is_file = std::filesystem::is_regular_file(file, missing);
      if (!is_file || ::access(file.c_str(), R_OK) != 0) continue;
      files[fmt::format("{}: {}", method.name, word)] = sha256_of(file);
    }
  }
  return files;
}

}  // namespace tribench
