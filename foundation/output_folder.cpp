// SPDX-License-Identifier: MIT
#include "foundation/output_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>

#include "foundation/error.hpp"

namespace tribench {

void make_output_folder(const std::filesystem::path& folder) {
  constexpr const char* kMend = "choose a folder that can be written to";
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw Error(ErrorKind::failed, fmt::format("cannot make the folder: {}", error.message()),
                folder.string(), kMend);
  }
  std::string probe = (folder / ".probe-XXXXXX").string();
  const int descriptor = ::mkstemp(probe.data());
  if (descriptor < 0) {
    throw Error(ErrorKind::failed, fmt::format("cannot write here: {}", std::strerror(errno)),
                folder.string(), kMend);
  }
  ::close(descriptor);
  ::unlink(probe.c_str());
}

}  // namespace tribench
