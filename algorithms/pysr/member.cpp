// SPDX-License-Identifier: MIT
#include "algorithms/pysr/member.hpp"

#include <algorithm>
#include <numeric>

namespace tribench::pysr {

SizeFrequencies::SizeFrequencies(int max_size) : counts_(static_cast<std::size_t>(max_size), 1.0) {
  normalise();
}

void SizeFrequencies::count(int size) {
  if (in_range(size)) counts_[static_cast<std::size_t>(size - 1)] += 1;
}

void SizeFrequencies::shrink_to(double window) {
  double excess = std::accumulate(counts_.begin(), counts_.end(), 0.0) - window;
  while (excess > 1e-9) {
    const auto above = std::ranges::count_if(counts_, [](double count) { return count > 1; });
    if (above == 0) return;
    // Lower all that are above 1 by the same amount, at most down to 1.
    double step = excess / static_cast<double>(above);
    for (const double count : counts_) {
      if (count > 1) step = std::min(step, count - 1);
    }
    for (double& count : counts_) {
      if (count > 1) count = std::max(1.0, count - step);
    }
    excess -= step * static_cast<double>(above);
  }
}

void SizeFrequencies::normalise() {
  const double total = std::accumulate(counts_.begin(), counts_.end(), 0.0);
  normalised_ = counts_;
  for (double& share : normalised_) share /= total;
}

double SizeFrequencies::normalised(int size) const {
  return in_range(size) ? normalised_[static_cast<std::size_t>(size - 1)] : 0;
}

}  // namespace tribench::pysr
