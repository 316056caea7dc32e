// SPDX-License-Identifier: MIT
//
// What a fuzz target is made of. One file below targets/ holds one:
//
//   TRIBENCH_FUZZ_TARGET(box) { reads([&] { ... input ... }); }
//
// Under the preset `fuzz` it is a libFuzzer program of its own; in the tests of every day all
// targets are linked together and run over tests/fuzz/corpus/NAME. A target says that something is
// wrong by an exception, a crash or a sanitizer's finding; it must not depend on anything but its
// input.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>

namespace tribench::fuzz {

using Target = void (*)(std::string_view input);

// All targets that are linked in, by name.
std::map<std::string, Target>& targets();

struct Registration {
  Registration(const char* name, Target target) { targets()[name] = target; }
};

// Throws what ends the run as a finding.
[[noreturn]] void wrong(const std::string& what);
inline void expect(bool holds, const std::string& what) {
  if (!holds) wrong(what);
}
// For hot loops: the words are put together only where they are needed.
template <typename Words>
requires std::is_invocable_r_v<std::string, Words>
void expect(bool holds, Words what) {
  if (!holds) wrong(what());
}

// Runs `work`; an Error (bad input) is an answer and gives false, any other exception a finding.
bool reads(void (*work)(void*), void* context);
template <typename Work>
bool reads(Work work) {
  return reads([](void* context) { (*static_cast<Work*>(context))(); }, &work);
}

// A file in memory, for readers that want a path.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view text);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  int descriptor_;
  std::string path_;
};

// The input as a source of decisions, for targets whose input is no text; zeros after its end.
class Decisions {
 public:
  explicit Decisions(std::string_view input) : input_(input) {}
  bool at_end() const { return input_.empty(); }
  std::uint8_t byte();
  // One of 0 .. count - 1.
  std::size_t below(std::size_t count) { return byte() % count; }
  // Any double: small whole numbers, powers of two and values at the edges of the range are likely.
  double number();
  // The same, finite.
  double finite_number();

 private:
  std::string_view input_;
};

}  // namespace tribench::fuzz

#ifdef TRIBENCH_LIBFUZZER
#define TRIBENCH_FUZZ_TARGET(name)                                                    \
  static void fuzz_##name(std::string_view input);                                    \
  extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) { \
    fuzz_##name(std::string_view(reinterpret_cast<const char*>(data), size));         \
    return 0;                                                                         \
  }                                                                                   \
  static void fuzz_##name([[maybe_unused]] std::string_view input)
#else
#define TRIBENCH_FUZZ_TARGET(name)                                                   \
  static void fuzz_##name(std::string_view input);                                   \
  static const tribench::fuzz::Registration registration_##name(#name, fuzz_##name); \
  static void fuzz_##name([[maybe_unused]] std::string_view input)
#endif
