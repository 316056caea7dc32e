// SPDX-License-Identifier: MIT
//
// A study's cases in threads, with a progress line. The first case that fails ends the study: a
// program that does not answer would else be waited for in every case.
#pragma once

#include <omp.h>

#include <atomic>
#include <cstddef>

#include "foundation/parallel_for.hpp"
#include "harness/progress_line.hpp"

namespace tribench {

// work(i) for i = 0 .. count - 1, in no order. threads: 0 for as many as there are processors.
// Throws what the first failing case threw; cases that had begun are ended first.
template <typename Work>
void for_each_case(std::size_t count, int threads, bool quiet, Work work) {
  ProgressLine progress(count, static_cast<double>(count), quiet);
  std::atomic<bool> failed = false;
  parallel_for(count, threads > 0 ? threads : omp_get_max_threads(), [&](std::size_t i) {
    if (failed) return;
    try {
      work(i);
    } catch (...) {
      failed = true;
      throw;
    }
    progress.cell_ended(1, false);
  });
}

}  // namespace tribench
