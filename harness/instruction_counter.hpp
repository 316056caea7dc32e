// SPDX-License-Identifier: MIT
//
// Instructions that a piece of work executed, counted by the processor (perf_event_open): the cost
// of a fit that a busy machine does not change. Kernels and virtual machines that do not allow it,
// or give the counter to others meanwhile, leave the figure out.
#pragma once

namespace tribench {

class InstructionCounter {
 public:
  // Counts from here on: this thread, and threads and processes that it starts.
  InstructionCounter();
  ~InstructionCounter();
  InstructionCounter(const InstructionCounter&) = delete;
  InstructionCounter& operator=(const InstructionCounter&) = delete;

  // In user mode, so far; NaN where they are not counted, or were for a part of the time only.
  double count() const;

 private:
  int descriptor_ = -1;
};

}  // namespace tribench
