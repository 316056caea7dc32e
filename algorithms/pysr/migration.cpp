// SPDX-License-Identifier: MIT
#include "algorithms/pysr/migration.hpp"

#include <algorithm>

namespace tribench::pysr {

std::vector<Member> best_members(std::span<const Member> members, int count) {
  std::vector<Member> best(members.begin(), members.end());
  std::ranges::stable_sort(best, {}, &Member::cost);
  best.resize(std::min(best.size(), static_cast<std::size_t>(count)));
  return best;
}

std::size_t migrate(std::span<const Member> migrants, std::span<Member> members, double fraction,
                    std::uint64_t& clock, RandomStream& random) {
  if (migrants.empty() || members.empty()) return 0;
  const auto drawn = random.poisson(static_cast<double>(members.size()) * fraction);
  const std::size_t count = std::min<std::size_t>(drawn, members.size());
  for (std::size_t i = 0; i < count; ++i) {
    Member& place = members[random.below(members.size())];
    place = migrants[random.below(migrants.size())];
    place.birth = clock++;
  }
  return count;
}

}  // namespace tribench::pysr
