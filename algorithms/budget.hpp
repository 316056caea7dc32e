// SPDX-License-Identifier: MIT
//
// What a fit may spend: evaluations (node-rows: the reproducible track) and CPU seconds (the
// safety net). A method asks before it evaluates and stops when told; it never reads a clock.
//
// Results depend only on the evaluations as long as the seconds do not run out; a record says
// which of the two ended a fit.
#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>

namespace tribench {

struct BudgetLimits {
  std::uint64_t evaluations = std::numeric_limits<std::uint64_t>::max();  // node-rows
  double cpu_seconds = std::numeric_limits<double>::infinity();           // of the process
  // From when on the seconds are spent, whatever is left of them: a user's Ctrl-C. May be null;
  // outlives the budget.
  const std::atomic<bool>* stop = nullptr;
};

// Thread safety: one Budget per thread; shares of one budget may be spent in different threads.
class Budget {
 public:
  explicit Budget(const BudgetLimits& limits);

  // Takes `node_rows` from the budget. False, with nothing taken, once it would be overdrawn or
  // the seconds have run out; from then on always false.
  bool spend(std::uint64_t node_rows);
  bool exhausted() const { return exhausted_; }
  // Looks at the clock now: for work that spends nothing, or much at once. False once the seconds
  // have run out; it changes nothing as long as they have not.
  bool in_time();
  std::uint64_t spent() const { return spent_; }
  std::uint64_t remaining() const;
  // CPU seconds left; infinite without a limit. For a program run beside this one, which cannot
  // ask; a method must not decide by it.
  double remaining_seconds() const;
  // Books what such a program says it has spent, overdrawn or not.
  void book(std::uint64_t node_rows);
  // Whether the user has asked to stop: such a program is to be told.
  bool is_stopped() const;
  bool out_of_time() const { return out_of_time_->load(std::memory_order_relaxed); }
  // Whether the clock, rather than the evaluations, ended it or a part of it: such a result is not
  // reproducible.
  bool was_cut_by_clock() const { return cut_by_clock_->load(std::memory_order_relaxed); }

  // A part of what remains, to be spent independently (by an island, a structure), so that the
  // outcome does not depend on which thread runs first. `settle` books what the part has spent.
  // The seconds are common to all, but for a part of a share of them (0 .. 1 of what is left): what
  // comes after a search needs a reserve.
  Budget share(std::uint64_t node_rows) const;
  Budget share(std::uint64_t node_rows, double of_seconds) const;
  void settle(const Budget& part);

 private:
  BudgetLimits limits_;
  std::uint64_t spent_ = 0;
  std::uint64_t spent_at_next_clock_check_ = 0;
  bool exhausted_ = false;
  double cpu_start_ = 0;
  std::shared_ptr<std::atomic<bool>> out_of_time_;   // shared by all with the same seconds
  std::shared_ptr<std::atomic<bool>> cut_by_clock_;  // shared by all parts
};

// Why a fit that takes so many node-rows at the least gives nothing: more than are left, or no
// time.
std::string shortage(const Budget& budget, std::uint64_t node_rows);

// CPU seconds of this process so far, all threads.
double process_cpu_seconds();

}  // namespace tribench
