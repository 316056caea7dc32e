// SPDX-License-Identifier: MIT
//
// A loop over independent pieces of work in threads (OpenMP). An exception that leaves a parallel
// region ends the process: here the first one, by index, is thrown when all pieces have ended, for
// any number of threads the same. For loops inside a method; the loop over cells has its own rules.
#pragma once

#include <cstddef>
#include <exception>
#include <mutex>

namespace tribench {

// work(i) for i = 0 .. count - 1, in no order; one thread works where `threads` is below 2.
// `chunk`: pieces that a thread takes at a time.
template <typename Work>
void parallel_for(std::size_t count, int threads, Work work, int chunk = 1) {
  std::exception_ptr failure;
  std::size_t failed_at = count;
  std::mutex mutex;
  const auto guarded = [&](std::size_t i) {
    try {
      work(i);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (i < failed_at) {
        failed_at = i;
        failure = std::current_exception();
      }
    }
  };
#pragma omp parallel for schedule(dynamic, chunk) num_threads(threads) if (threads > 1)
  for (std::size_t i = 0; i < count; ++i) guarded(i);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace tribench
