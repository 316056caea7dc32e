// SPDX-License-Identifier: MIT
#include "tests/fuzz/box_samples.hpp"

#include <algorithm>
#include <cmath>

#include "algorithms/expression/interval.hpp"
#include "foundation/random.hpp"

namespace tribench::fuzz {
namespace {

double sample(const InputRange& range, RandomStream& random) {
  const double choices[] = {
      range.low,          range.high,           0.0,
      next_up(0.0),       next_down(0.0),       range.low / 2 + range.high / 2,
      next_up(range.low), next_down(range.high)};
  const std::uint64_t choice = random.below(2 * std::size(choices));
  const double share = random.uniform();
  const double value =
      choice < std::size(choices) ? choices[choice] : range.low * (1 - share) + range.high * share;
  return std::clamp(value, range.low, range.high);
}

double sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

}  // namespace

std::vector<std::vector<double>> samples_of(const InputBox& box, std::size_t count) {
  RandomStream random(key_of("samples"));
  std::vector<std::vector<double>> points(count, std::vector<double>(box.size()));
  for (std::vector<double>& point : points) {
    for (std::size_t j = 0; j < box.size(); ++j) {
      if (!box[j].sign_of) point[j] = sample(box[j], random);
    }
    for (std::size_t j = 0; j < box.size(); ++j) {
      if (box[j].sign_of) point[j] = sign(point[*box[j].sign_of]);
    }
  }
  return points;
}

}  // namespace tribench::fuzz
