// SPDX-License-Identifier: MIT
//
// The places of names in a list that may grow meanwhile, found without going through it: a formula
// may name tens of thousands of columns. Of a name that stands twice, the first place. Internal to
// the room.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tribench {

class NameIndex {
 public:
  // names: read again where it has grown; must outlive the index and only grow.
  explicit NameIndex(const std::vector<std::string>& names) : names_(names) {}

  std::optional<std::size_t> find(std::string_view name) {
    for (; known_ < names_.size(); ++known_) places_.try_emplace(names_[known_], known_);
    const auto found = places_.find(name);
    if (found == places_.end()) return std::nullopt;
    return found->second;
  }

 private:
  const std::vector<std::string>& names_;
  std::size_t known_ = 0;
  std::map<std::string, std::size_t, std::less<>> places_;
};

}  // namespace tribench
