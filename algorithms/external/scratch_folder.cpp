// SPDX-License-Identifier: MIT
#include "algorithms/external/scratch_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <system_error>

#include "foundation/error.hpp"

namespace tribench {

ScratchFolder::ScratchFolder() {
  const std::filesystem::path parent = external_scratch_folder(::getpid());
  std::filesystem::create_directories(parent);
  std::string name = (parent / "XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw Error(ErrorKind::failed, fmt::format("cannot make a folder in {}", parent.string()));
  }
  path_ = name;
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
