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

const std::atomic<bool>& stop_requested_by(std::initializer_list<int> signals) {
  for (const int signal : signals) std::signal(signal, request_stop);
  return stop_requested;
}

}  // namespace tribench
