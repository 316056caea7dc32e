// SPDX-License-Identifier: MIT
#include "foundation/standard_streams.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>

namespace tribench {

void take_standard_streams() {
  // Output that was closed is opened for reading, so that writing there fails.
  constexpr int kModes[] = {O_RDONLY, O_RDONLY, O_WRONLY};
  for (int descriptor = 0; descriptor < 3; ++descriptor) {
    const bool is_closed = ::fcntl(descriptor, F_GETFD) < 0 && errno == EBADF;
    // The lowest free number, which is this one.
    if (is_closed && ::open("/dev/null", kModes[descriptor]) < 0) return;
  }
  std::signal(SIGXFSZ, SIG_IGN);
}

void print_message(std::string_view text) { std::fwrite(text.data(), 1, text.size(), stderr); }

bool has_output_arrived() { return std::fflush(stdout) == 0 && std::ferror(stdout) == 0; }

}  // namespace tribench
