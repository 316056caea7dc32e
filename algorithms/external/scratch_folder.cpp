// SPDX-License-Identifier: MIT
#include "algorithms/external/scratch_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <system_error>

#include "foundation/error.hpp"

namespace tribench {
namespace {

constexpr int kAttempts = 100;

}  // namespace

ScratchFolder::ScratchFolder() {
  const std::filesystem::path parent = external_scratch_folder(::getpid());
  // Another thread that ends may take the parent away in between.
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    std::error_code ignored;
    std::filesystem::create_directories(parent, ignored);
    std::string name = (parent / "XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) continue;
    path_ = name;
    return;
  }
  throw Error(ErrorKind::failed, fmt::format("cannot make a folder in {}", parent.string()));
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;  // a file left behind is no reason to lose a result
  std::filesystem::remove_all(path_, ignored);
  std::filesystem::remove(path_.parent_path(), ignored);  // unless another one still uses it
}

std::filesystem::path external_scratch_folder(pid_t pid) {
  return std::filesystem::temp_directory_path() / fmt::format("tribench-external-{}", pid);
}

}  // namespace tribench
