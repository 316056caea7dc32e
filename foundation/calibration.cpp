// SPDX-License-Identifier: MIT
#include "foundation/calibration.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include "foundation/elementary.hpp"

namespace tribench {
namespace {

double thread_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// A chain of dependent multiplications, additions and exponentials, as fits have them; the result
// is handed out so that the compiler cannot leave it away.
double arithmetic() {
  double x = 0.5;
  double sum = 0;
  for (int i = 0; i < 200'000; ++i) {
    x = 3.7 * x * (1 - x);
    sum += elementary::exp(-x * x) + std::sqrt(x + 1);
  }
  return sum;
}

}  // namespace

CalibrationSample calibrate() {
  constexpr int kRounds = 5;
  CalibrationSample best;
  for (int round = 0; round < kRounds; ++round) {
    const auto wall_start = std::chrono::steady_clock::now();
    const double cpu_start = thread_cpu_seconds();
    const volatile double result = arithmetic();
    static_cast<void>(result);
    const double cpu_s = thread_cpu_seconds() - cpu_start;
    if (round > 0 && cpu_s >= best.cpu_s) continue;
    best.cpu_s = cpu_s;
    best.wall_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start).count();
  }
  return best;
}

double calibration_drift(const std::vector<CalibrationSample>& samples) {
  if (samples.size() < 2) return 0;
  const auto [least, most] = std::ranges::minmax_element(samples, {}, &CalibrationSample::cpu_s);
  return most->cpu_s / least->cpu_s - 1;
}

}  // namespace tribench
