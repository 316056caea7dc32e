// SPDX-License-Identifier: MIT
#include "algorithms/budget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>

namespace tribench {
namespace {

// The clock is read once in so many node-rows (about a millisecond of evaluation).
constexpr std::uint64_t kClockInterval = 2'000'000;

}  // namespace

std::string shortage(const Budget& budget, std::uint64_t node_rows) {
  if (budget.out_of_time()) return "the CPU seconds are spent";
  return fmt::format("it takes {} evaluations (node-rows), and {} are left", node_rows,
                     budget.remaining());
}

double process_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Budget::Budget(const BudgetLimits& limits)
    : limits_(limits),
      cpu_start_(process_cpu_seconds()),
      out_of_time_(std::make_shared<std::atomic<bool>>(false)),
      cut_by_clock_(std::make_shared<std::atomic<bool>>(false)) {}

std::uint64_t Budget::remaining() const {
  return limits_.evaluations - std::min(spent_, limits_.evaluations);
}

bool Budget::is_stopped() const {
  return limits_.stop != nullptr && limits_.stop->load(std::memory_order_relaxed);
}

double Budget::remaining_seconds() const {
  if (is_stopped()) return 0;
  return std::max(0.0, limits_.cpu_seconds - (process_cpu_seconds() - cpu_start_));
}

void Budget::book(std::uint64_t node_rows) {
  spent_ += node_rows;
  if (remaining() == 0) exhausted_ = true;
}

bool Budget::in_time() {
  spent_at_next_clock_check_ = spent_ + kClockInterval;
  if (is_stopped() || process_cpu_seconds() - cpu_start_ > limits_.cpu_seconds) {
    out_of_time_->store(true);
    cut_by_clock_->store(true);
  }
  return !out_of_time();
}

bool Budget::spend(std::uint64_t node_rows) {
  if (exhausted_ || node_rows > remaining() ||
      (spent_ + node_rows >= spent_at_next_clock_check_ && !in_time())) {
    exhausted_ = true;
    return false;
  }
  spent_ += node_rows;
  return true;
}

Budget Budget::share(std::uint64_t node_rows) const {
  Budget part = *this;
  part.limits_.evaluations = std::min(node_rows, remaining());
  part.spent_ = 0;
  part.spent_at_next_clock_check_ = 0;
  part.exhausted_ = false;
  return part;
}

Budget Budget::share(std::uint64_t node_rows, double of_seconds) const {
  Budget part = share(node_rows);
  if (!std::isfinite(limits_.cpu_seconds)) return part;
  const double so_far = process_cpu_seconds() - cpu_start_;
  part.limits_.cpu_seconds = so_far + of_seconds * std::max(0.0, limits_.cpu_seconds - so_far);
  part.out_of_time_ = std::make_shared<std::atomic<bool>>(false);
  return part;
}

void Budget::settle(const Budget& part) {
  spent_ += part.spent_;
  if (out_of_time() || remaining() == 0) exhausted_ = true;
}

}  // namespace tribench
