// SPDX-License-Identifier: MIT
#include "tests/support/paths.hpp"

namespace tribench::testing {
namespace {

std::optional<std::filesystem::path> beside(const std::string& folder) {
  const std::filesystem::path path = source_dir().parent_path() / "shared" / folder;
  if (!std::filesystem::is_directory(path)) return std::nullopt;
  return path;
}

}  // namespace

std::filesystem::path source_dir() { return TRIBENCH_SOURCE_DIR; }
std::filesystem::path program() { return TRIBENCH_PROGRAM; }
std::filesystem::path test_program() { return TRIBENCH_TEST_PROGRAM; }
std::optional<std::filesystem::path> shared_data() { return beside("data"); }
std::optional<std::filesystem::path> shared_reference() { return beside("reference"); }
std::optional<std::filesystem::path> shared_suite(const std::string& name) {
  return beside("suites/" + name);
}

}  // namespace tribench::testing
