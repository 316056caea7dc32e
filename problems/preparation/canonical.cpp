// SPDX-License-Identifier: MIT
#include "problems/preparation/canonical.hpp"

#include <algorithm>
#include <cmath>

namespace tribench::loop {
namespace {

// What a movement is known by: even under mirroring, in the same order under any unit. In single
// precision, so that what is equal but for rounding is equal.
struct MovementKey {
  std::size_t begin;
  std::size_t end;
  bool is_last;
  std::vector<float> sizes;  // mean magnitudes of the velocity, the target and the other signals
};

std::vector<const std::vector<double>*> channels_of(const Observations& data) {
  std::vector<std::string> names = data.names();
  std::ranges::sort(names);
  std::vector<const std::vector<double>*> all;
  if (const Signal* v = data.find("v")) all.push_back(&v->values);
  all.push_back(&data.target);
  for (const std::string& name : names) {
    if (name != "v" && name != "t") all.push_back(&data.find(name)->values);
  }
  return all;
}

float mean_magnitude(const std::vector<double>& values, std::size_t begin, std::size_t end) {
  double sum = 0;
  for (std::size_t i = begin; i < end; ++i) sum += std::abs(values[i]);
  return static_cast<float>(sum / static_cast<double>(end - begin));
}

std::vector<MovementKey> movement_keys(const Observations& data, const std::vector<int>& last) {
  const std::vector<const std::vector<double>*> channels = channels_of(data);
  std::vector<MovementKey> keys;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    if (i == 0 || data.movement[i] != data.movement[i - 1])
      keys.push_back({i, i, std::ranges::binary_search(last, data.movement[i]), {}});
    keys.back().end = i + 1;
  }
  for (MovementKey& key : keys) {
    for (const std::vector<double>* values : channels) {
      key.sizes.push_back(mean_magnitude(*values, key.begin, key.end));
    }
  }
  return keys;
}

}  // namespace

std::vector<char> Canonical::as_told(const std::vector<char>& marks) const {
  std::vector<char> out(marks.size());
  for (std::size_t i = 0; i < marks.size(); ++i) out[row_of[i]] = marks[i];
  return out;
}

Canonical canonical(const Observations& told, const std::vector<int>& last) {
  std::vector<MovementKey> keys = movement_keys(told, last);
  std::ranges::stable_sort(keys, [](const MovementKey& a, const MovementKey& b) {
    if (a.is_last != b.is_last) return b.is_last;
    return a.sizes != b.sizes ? a.sizes < b.sizes : a.end - a.begin < b.end - b.begin;
  });
  Canonical out;
  for (const MovementKey& key : keys) {
    for (std::size_t i = key.begin; i < key.end; ++i) out.row_of.push_back(i);
  }
  const auto reorder = [&](auto& values) {
    if (values.empty()) return;
    auto sorted = values;
    for (std::size_t i = 0; i < sorted.size(); ++i) sorted[i] = values[out.row_of[i]];
    values = std::move(sorted);
  };
  out.data = told;
  for (auto* signals : {&out.data.signals, &out.data.unused}) {
    for (Signal& signal : *signals) reorder(signal.values);
  }
  reorder(out.data.target);
  reorder(out.data.movement);
  reorder(out.data.time);
  reorder(out.data.place);
  std::ranges::sort(out.data.rigid);
  return out;
}

double mirror_sign(const Observations& data) {
  double sum = 0;
  for (const double y : data.target) sum += y;
  for (const char* name : {"v", "q", "g"}) {
    if (sum != 0) break;
    const Signal* signal = data.find(name);
    if (signal == nullptr) continue;
    for (const double x : signal->values) sum += x;
  }
  return sum < 0 ? -1 : 1;
}

}  // namespace tribench::loop
