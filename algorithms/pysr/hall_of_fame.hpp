// SPDX-License-Identifier: MIT
//
// The best member of each size seen so far, and the front it implies.
#pragma once

#include <optional>
#include <vector>

#include "algorithms/pysr/member.hpp"

namespace tribench::pysr {

class HallOfFame {
 public:
  explicit HallOfFame(int max_size) : slots_(static_cast<std::size_t>(max_size)) {}

  // Takes the member where its cost is strictly below that of the one of its size; whether it did.
  bool offer(const Member& member);
  void offer(const HallOfFame& other);

  const std::optional<Member>& at_size(int size) const {
    return slots_[static_cast<std::size_t>(size - 1)];
  }
  // By increasing size: members whose loss is strictly below that of every smaller one.
  std::vector<Member> front() const;
  // By increasing size, dominated ones too.
  std::vector<Member> members() const;
  // The smallest loss of any size up to `size`; none where there is no member.
  std::optional<double> best_loss_up_to(int size) const;
  int max_size() const { return static_cast<int>(slots_.size()); }

 private:
  std::vector<std::optional<Member>> slots_;  // slots_[i] has size i + 1
};

}  // namespace tribench::pysr
