// SPDX-License-Identifier: MIT
#include "harness/instruction_counter.hpp"

#include <linux/perf_event.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <limits>

namespace tribench {

InstructionCounter::InstructionCounter() {
  perf_event_attr wanted{};
  wanted.size = sizeof wanted;
  wanted.type = PERF_TYPE_HARDWARE;
  wanted.config = PERF_COUNT_HW_INSTRUCTIONS;
  wanted.exclude_kernel = 1;
  wanted.exclude_hv = 1;
  wanted.inherit = 1;
  wanted.read_format = PERF_FORMAT_TOTAL_TIME_ENABLED | PERF_FORMAT_TOTAL_TIME_RUNNING;
  constexpr int kThisThread = 0;
  constexpr int kAnyProcessor = -1;
  constexpr int kNoGroup = -1;
  descriptor_ = static_cast<int>(::syscall(SYS_perf_event_open, &wanted, kThisThread, kAnyProcessor,
                                           kNoGroup, PERF_FLAG_FD_CLOEXEC));
}

InstructionCounter::~InstructionCounter() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

double InstructionCounter::count() const {
  std::array<std::uint64_t, 3> counted{};  // instructions, time enabled, time running
  const bool is_whole = descriptor_ >= 0 &&
                        ::read(descriptor_, counted.data(), sizeof counted) == sizeof counted &&
                        counted[1] == counted[2] && counted[0] > 0;
  return is_whole ? static_cast<double>(counted[0]) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace tribench
