// SPDX-License-Identifier: MIT
#include "problems/preparation/test_movements.hpp"

#include <algorithm>
#include <cmath>

#include "problems/preparation/canonical.hpp"

namespace tribench::loop {
namespace {

// The strata of the split: movements in one direction or in both, by speed.
struct Kind {
  int movement;
  bool one_way;
  double speed;
};

std::vector<Kind> kinds(const Observations& data) {
  const Signal* v = data.find("v");
  std::vector<Kind> all;
  std::size_t i = 0;
  for (const int m : data.movements()) {
    double sum = 0;
    double magnitude = 0;
    const std::size_t begin = i;
    for (; i < data.rows() && data.movement[i] == m; ++i) {
      sum += v == nullptr ? 0 : v->values[i];
      magnitude += v == nullptr ? 0 : std::abs(v->values[i]);
    }
    const bool one_way = std::abs(sum) > 0.9 * magnitude;
    all.push_back({m, one_way, magnitude / static_cast<double>(i - begin)});
  }
  return all;
}

}  // namespace

std::vector<int> choose_test_movements(const Observations& data, double share) {
  std::vector<Kind> all = kinds(canonical(data).data);
  const auto wanted =
      static_cast<std::size_t>(std::lround(share * static_cast<double>(all.size())));
  if (share <= 0 || all.size() < 2) return {};
  std::ranges::stable_sort(all, [](const Kind& a, const Kind& b) {
    return a.one_way != b.one_way ? b.one_way
                                  : static_cast<float>(a.speed) < static_cast<float>(b.speed);
  });
  // The middle one of every run of neighbours, so that every speed is held out alike.
  const std::size_t count = std::max<std::size_t>(1, wanted);
  std::vector<int> chosen;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t begin = all.size() * k / count;
    const std::size_t end = all.size() * (k + 1) / count;
    chosen.push_back(all[(begin + end) / 2].movement);
  }
  std::ranges::sort(chosen);
  return chosen;
}

}  // namespace tribench::loop
