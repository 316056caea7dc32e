// SPDX-License-Identifier: MIT
//
// The one place that lists every algorithm. Not for methods: what one needs of another it is handed
// (MakeMethod), and a method that includes this fails the include test.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "algorithms/regressor.hpp"

namespace tribench {

class Registry {
 public:
  Registry();

  const std::vector<AlgorithmEntry>& entries() const { return entries_; }
  // One more algorithm: for a program of one's own that links the rooms. Names are unique.
  void add(AlgorithmEntry entry) { entries_.push_back(std::move(entry)); }
  // Throws Error (bad_input) with the nearest name.
  const AlgorithmEntry& find(std::string_view name) const;
  // The algorithm with the given parameters, and in a round after the first with what its entry
  // widens besides them; throws as Parameters does.
  std::unique_ptr<Regressor> make(std::string_view name,
                                  const std::map<std::string, ParameterValue>& given = {},
                                  int round = 0) const;

 private:
  std::vector<AlgorithmEntry> entries_;
};

}  // namespace tribench
