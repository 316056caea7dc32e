// SPDX-License-Identifier: MIT
#include "foundation/random.hpp"

#include <Random123/philox.h>

#include <cmath>
#include <numbers>

#include "foundation/elementary.hpp"

namespace tribench {
namespace {

// Words of the counter that keep the streams' uses apart: draws, splits, keys from text.
constexpr std::uint32_t kDraw = 0;
constexpr std::uint32_t kSplit = 1;
constexpr std::uint32_t kText = 2;

std::array<std::uint64_t, 2> block_of(std::uint64_t key, std::uint64_t counter, std::uint32_t use) {
  const auto words = philox_block(
      {static_cast<std::uint32_t>(counter), static_cast<std::uint32_t>(counter >> 32), use, 0},
      {static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32)});
  return {words[0] | (static_cast<std::uint64_t>(words[1]) << 32),
          words[2] | (static_cast<std::uint64_t>(words[3]) << 32)};
}

}  // namespace

std::array<std::uint32_t, 4> philox_block(std::array<std::uint32_t, 4> counter,
                                          std::array<std::uint32_t, 2> key) {
  const r123::Philox4x32::ctr_type c = {{counter[0], counter[1], counter[2], counter[3]}};
  const r123::Philox4x32::key_type k = {{key[0], key[1]}};
  const auto out = r123::Philox4x32{}(c, k);
  return {out[0], out[1], out[2], out[3]};
}

std::uint64_t key_of(std::string_view text) {
  // Merkle-Damgard over Philox: each 8-byte piece keys the next block, the length closes it.
  std::uint64_t key = 0x7472'6962'656e'6368;  // "tribench"
  for (std::size_t i = 0; i < text.size(); i += 8) {
    std::uint64_t piece = 0;
    for (std::size_t j = i; j < text.size() && j < i + 8; ++j) {
      piece |= static_cast<std::uint64_t>(static_cast<unsigned char>(text[j])) << (8 * (j - i));
    }
    key = block_of(key, piece, kText)[0];
  }
  return block_of(key, text.size(), kText)[1];
}

RandomStream RandomStream::split(std::uint64_t part) const {
  return RandomStream(block_of(key_, part, kSplit)[0]);
}

std::uint64_t RandomStream::next() {
  const std::uint64_t word = position_ & 1;
  if (word == 0) block_ = block_of(key_, position_ >> 1, kDraw);
  ++position_;
  return block_[word];
}

double RandomStream::uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }

double RandomStream::uniform(double low, double high) { return low + (high - low) * uniform(); }

double RandomStream::normal() {
  // 1 - u is in (0, 1], so the logarithm is finite.
  const double radius = std::sqrt(-2.0 * elementary::log(1.0 - uniform()));
  return radius * elementary::cos(2.0 * std::numbers::pi * uniform());
}

std::uint64_t RandomStream::below(std::uint64_t bound) {
  // Lemire 2019, "Fast random integer generation in an interval".
  __extension__ using Wide = unsigned __int128;
  Wide product = static_cast<Wide>(next()) * bound;
  auto low = static_cast<std::uint64_t>(product);
  if (low < bound) {
    const std::uint64_t threshold = (0 - bound) % bound;
    while (low < threshold) {
      product = static_cast<Wide>(next()) * bound;
      low = static_cast<std::uint64_t>(product);
    }
  }
  return static_cast<std::uint64_t>(product >> 64);
}

std::uint64_t RandomStream::poisson(double mean) {
  const double limit = elementary::exp(-mean);
  std::uint64_t count = 0;
  for (double product = uniform(); product > limit; product *= uniform()) ++count;
  return count;
}

}  // namespace tribench
