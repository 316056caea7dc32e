// SPDX-License-Identifier: MIT
#include "foundation/free_memory.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <string>

namespace tribench {
namespace {

using std::filesystem::path;

constexpr std::uint64_t kUnknown = std::numeric_limits<std::uint64_t>::max();

// "max", a file that is not there: no number.
std::optional<std::uint64_t> number_in(const path& file) {
  std::ifstream stream(file);
  std::uint64_t number = 0;
  return stream >> number ? std::optional(number) : std::nullopt;
}

// proc_meminfo(5): "MemAvailable:   12345 kB".
std::uint64_t of_machine(const path& root) {
  std::ifstream stream(root / "proc/meminfo");
  std::string name;
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::uint64_t kib = 0;
    if (words >> name >> kib && name == "MemAvailable:") return kib << 10;
  }
  return kUnknown;
}

// What a group and those that it stands in leave.
std::uint64_t of_groups(path group, const path& top, const char* limit, const char* usage) {
  std::uint64_t left = kUnknown;
  for (;; group = group.parent_path()) {
    const std::optional<std::uint64_t> most = number_in(group / limit);
    if (most) left = std::min(left, *most - std::min(*most, number_in(group / usage).value_or(0)));
    if (group == top || group == group.root_path() || group.empty()) return left;
  }
}

// cgroups(7): "0::/a/b" of version 2, "4:memory:/a/b" of version 1.
std::uint64_t of_control_groups(const path& root) {
  const path v2 = root / "sys/fs/cgroup";
  const path v1 = v2 / "memory";
  std::uint64_t left = kUnknown;
  std::ifstream stream(root / "proc/self/cgroup");
  for (std::string line; std::getline(stream, line);) {
    const std::size_t first = line.find(':');
    const std::size_t second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const path inner = path(line.substr(second + 1)).relative_path();
    if (controllers == ",,") {
      left = std::min(left, of_groups(v2 / inner, v2, "memory.max", "memory.current"));
    } else if (controllers.find(",memory,") != std::string::npos) {
      left = std::min(left,
                      of_groups(v1 / inner, v1, "memory.limit_in_bytes", "memory.usage_in_bytes"));
    }
  }
  return left;
}

}  // namespace

std::uint64_t free_memory(const path& root) {
  const std::uint64_t left = std::min(of_machine(root), of_control_groups(root));
  return left == kUnknown ? 0 : left;
}

void hold_to_free_memory() {
#ifndef TRIBENCH_SANITIZED  // whose shadow memory would count
  const std::uint64_t left = free_memory();
  rlimit memory{};
  if (left == 0 || ::getrlimit(RLIMIT_DATA, &memory) != 0) return;
  memory.rlim_cur = std::min<rlim_t>(memory.rlim_cur, left);
  ::setrlimit(RLIMIT_DATA, &memory);
#endif
}

}  // namespace tribench
