// SPDX-License-Identifier: MIT
#include "tests/fuzz/fuzz_target.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "foundation/error.hpp"

namespace tribench::fuzz {

std::map<std::string, Target>& targets() {
  static std::map<std::string, Target> all;
  return all;
}

void wrong(const std::string& what) { throw std::logic_error(what); }

bool reads(void (*work)(void*), void* context) {
  try {
    work(context);
    return true;
  } catch (const Error& error) {
    expect(error.kind() == ErrorKind::bad_input, std::string("no bad input: ") + error.what());
    return false;
  }
}

MemoryFile::MemoryFile(std::string_view text)
    : descriptor_(memfd_create("fuzz", MFD_CLOEXEC)),
      path_("/proc/self/fd/" + std::to_string(descriptor_)) {
  if (descriptor_ < 0 || write(descriptor_, text.data(), text.size()) < 0) {
    wrong("no file in memory");
  }
}

MemoryFile::~MemoryFile() { close(descriptor_); }

std::uint8_t Decisions::byte() {
  if (input_.empty()) return 0;
  const auto first = static_cast<std::uint8_t>(input_.front());
  input_.remove_prefix(1);
  return first;
}

double Decisions::number() {
  constexpr double kEdges[] = {0.0,
                               -0.0,
                               std::numeric_limits<double>::denorm_min(),
                               std::numeric_limits<double>::min(),
                               std::numeric_limits<double>::max(),
                               -std::numeric_limits<double>::max(),
                               std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::quiet_NaN()};
  switch (below(4)) {
    case 0:
      return static_cast<std::int8_t>(byte());
    case 1:
      return std::ldexp(static_cast<std::int8_t>(byte()), static_cast<std::int8_t>(byte()) / 8);
    case 2:
      return kEdges[below(std::size(kEdges))];
    default: {
      std::uint64_t bits = 0;
      for (int i = 0; i < 8; ++i) bits = bits << 8U | byte();
      return std::bit_cast<double>(bits);
    }
  }
}

double Decisions::finite_number() {
  const double value = number();
  return std::isfinite(value) ? value : 1.0;
}

}  // namespace tribench::fuzz
