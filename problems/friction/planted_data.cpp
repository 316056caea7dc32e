// SPDX-License-Identifier: MIT
#include "problems/friction/planted_data.hpp"

namespace tribench {

std::vector<double> PlantedTruth::noise_free() const {
  std::vector<double> sum = base;
  for (const PlantedEffect& effect : effects) {
    for (std::size_t r = 0; r < sum.size(); ++r) sum[r] += effect.values[r];
  }
  return sum;
}

}  // namespace tribench
