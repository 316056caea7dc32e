// SPDX-License-Identifier: MIT
#include "algorithms/pysr/hall_of_fame.hpp"

#include <algorithm>

namespace tribench::pysr {

bool HallOfFame::offer(const Member& member) {
  if (member.size < 1 || member.size > max_size()) return false;
  std::optional<Member>& slot = slots_[static_cast<std::size_t>(member.size - 1)];
  if (slot && !(member.cost < slot->cost)) return false;
  slot = member;
  return true;
}

void HallOfFame::offer(const HallOfFame& other) {
  for (const std::optional<Member>& slot : other.slots_) {
    if (slot) offer(*slot);
  }
}

std::vector<Member> HallOfFame::front() const {
  std::vector<Member> front;
  for (const std::optional<Member>& slot : slots_) {
    if (slot && (front.empty() || slot->loss < front.back().loss)) front.push_back(*slot);
  }
  return front;
}

std::vector<Member> HallOfFame::members() const {
  std::vector<Member> members;
  for (const std::optional<Member>& slot : slots_) {
    if (slot) members.push_back(*slot);
  }
  return members;
}

std::optional<double> HallOfFame::best_loss_up_to(int size) const {
  std::optional<double> best;
  for (int s = 1; s <= std::min(size, max_size()); ++s) {
    const std::optional<Member>& slot = at_size(s);
    if (slot && (!best || slot->loss < *best)) best = slot->loss;
  }
  return best;
}

}  // namespace tribench::pysr
