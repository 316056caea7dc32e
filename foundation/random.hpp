// SPDX-License-Identifier: MIT
//
// Random streams that give the same bits on any machine, in any order, with any number of threads.
// A stream is keyed (by a cell's key, an island's number, ...), never seeded from the clock; a
// stream handed to a part of the work is split off by name or number and does not depend on how
// far the parent has advanced.
//
// Not for cryptography. Never use the standard library's distributions with it: their results
// differ between standard libraries.
//
// Source: Salmon, Moraes, Dror, Shaw 2011, "Parallel random numbers: as easy as 1, 2, 3"
// (Philox4x32-10), through Random123.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

namespace tribench {

// A 64-bit key from a text; the one place where names become keys.
std::uint64_t key_of(std::string_view text);

class RandomStream {
 public:
  using result_type = std::uint64_t;

  explicit RandomStream(std::uint64_t key) : key_(key) {}

  // An independent stream for part `part` (or a named part) of this stream's work.
  RandomStream split(std::uint64_t part) const;
  RandomStream split(std::string_view part) const { return split(key_of(part)); }

  std::uint64_t next();                      // uniform over all 64-bit integers
  double uniform();                          // [0, 1), 53 bits
  double uniform(double low, double high);   // [low, high)
  double normal();                           // N(0, 1), Box-Muller
  std::uint64_t below(std::uint64_t bound);  // uniform in 0 .. bound - 1, unbiased; bound >= 1
  bool chance(double probability) { return uniform() < probability; }
  double sign() { return (next() >> 63) != 0 ? 1.0 : -1.0; }
  std::uint64_t poisson(double mean);  // Knuth's method; mean up to about 500

  template <typename T>
  void shuffle(std::span<T> items) {
    for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[below(i)]);
  }

  // UniformRandomBitGenerator
  static constexpr std::uint64_t min() { return 0; }
  static constexpr std::uint64_t max() { return std::numeric_limits<std::uint64_t>::max(); }
  std::uint64_t operator()() { return next(); }

  std::uint64_t key() const { return key_; }

 private:
  std::uint64_t key_;
  std::uint64_t position_ = 0;  // 64-bit words drawn so far
  std::array<std::uint64_t, 2> block_{};
};

// One Philox4x32-10 block, exposed for the known-answer test.
std::array<std::uint32_t, 4> philox_block(std::array<std::uint32_t, 4> counter,
                                          std::array<std::uint32_t, 2> key);

}  // namespace tribench
