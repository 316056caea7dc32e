// SPDX-License-Identifier: MIT
#include "harness/cli/interrupt.hpp"

#include <csignal>

namespace tribench {
namespace {

// A signal handler can reach nothing but a global.
std::atomic<bool> stop_requested{false};

extern "C" void request_stop(int signal) {
  stop_requested = true;
  std::signal(signal, SIG_DFL);
}

}  // namespace

const std::atomic<bool>& stop_requested_by_signal() {
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, request_stop);
  if (std::signal(SIGHUP, request_stop) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  return stop_requested;
}

}  // namespace tribench
