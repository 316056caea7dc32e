// SPDX-License-Identifier: MIT
#include "foundation/scratch_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>

#include "foundation/error.hpp"

namespace tribench {

ScratchFolder::ScratchFolder() {
  std::error_code error;
  const std::filesystem::path parent = std::filesystem::temp_directory_path(error);
  std::string name = (parent / "tribench-XXXXXX").string();
  // mkdtemp gives it to its owner alone (0700).
  if (error || ::mkdtemp(name.data()) == nullptr) {
    throw Error(ErrorKind::environment,
                fmt::format("cannot make a temporary folder: {}",
                            error ? error.message() : std::strerror(errno)),
                name, "set TMPDIR to a folder that can be written");
  }
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;  // a file left behind is no reason to lose a result
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace tribench
