// SPDX-License-Identifier: MIT
#include "tests/support/paths.hpp"

#include <unistd.h>

#include <memory>

#include "foundation/scratch_folder.hpp"

namespace tribench::testing {
namespace {

std::optional<std::filesystem::path> beside(const std::string& folder) {
  const std::filesystem::path path = source_dir().parent_path() / "shared" / folder;
  if (!std::filesystem::is_directory(path)) return std::nullopt;
  return path;
}

// What a test forks may leave by exit(), which ends statics too: the folder is its parent's.
struct OwnScratch {
  std::unique_ptr<const ScratchFolder> folder = std::make_unique<const ScratchFolder>();
  pid_t owner = ::getpid();
  ~OwnScratch() {
    if (owner != ::getpid()) static_cast<void>(folder.release());
  }
};

}  // namespace

const std::filesystem::path& scratch_folder() {
  static const OwnScratch own;
  return own.folder->path();
}

std::filesystem::path source_dir() { return TRIBENCH_SOURCE_DIR; }
std::filesystem::path program() { return TRIBENCH_PROGRAM; }
std::filesystem::path test_program() { return TRIBENCH_TEST_PROGRAM; }
std::optional<std::filesystem::path> shared_data() { return beside("data"); }
std::optional<std::filesystem::path> shared_reference() { return beside("reference"); }
std::optional<std::filesystem::path> shared_suite(const std::string& name) {
  return beside("suites/" + name);
}

}  // namespace tribench::testing
