// SPDX-License-Identifier: MIT
#include "harness/cli/interrupt.hpp"

#include <unistd.h>

#include <csignal>
#include <string_view>

namespace tribench {
namespace {

// A signal handler can reach nothing but a global.
std::atomic<bool> stop_requested{false};
std::atomic<bool> end_requested{false};

constexpr std::string_view kStopping =
    "\nstopping once what is under way has ended; Ctrl-C again stops at once\n";

// What it calls may be called in a signal handler.
extern "C" void request_stop(int signal) {
  stop_requested = true;
  if (signal == SIGTERM) end_requested = true;
  if (signal == SIGINT) {
    [[maybe_unused]] const auto told = ::write(STDERR_FILENO, kStopping.data(), kStopping.size());
  }
  std::signal(signal, SIG_DFL);
}

}  // namespace

const std::atomic<bool>& stop_requested_by_signal() {
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, request_stop);
  if (std::signal(SIGHUP, request_stop) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  return stop_requested;
}

const std::atomic<bool>& end_requested_by_signal() { return end_requested; }

}  // namespace tribench
