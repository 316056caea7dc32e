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

namespace {

// An empty $TMPDIR is none, as for every shell.
std::filesystem::path temporary_files() {
  const char* folder = std::getenv("TMPDIR");  // NOLINT(concurrency-mt-unsafe): nothing sets it
  return folder != nullptr && *folder != '\0' ? folder : "/tmp";
}

}  // namespace

ScratchFolder::ScratchFolder() {
  const std::filesystem::path parent = temporary_files();
  std::string name = (parent / "tribench-XXXXXX").string();
  // mkdtemp gives it to its owner alone (0700).
  if (::mkdtemp(name.data()) == nullptr) {
    throw Error(ErrorKind::environment,
                fmt::format("cannot make a temporary folder: {}", std::strerror(errno)),
                parent.string(), "set TMPDIR to a folder that can be written");
  }
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;  // a file left behind is no reason to lose a result
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace tribench
