// SPDX-License-Identifier: MIT
#include "algorithms/inference/flips.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "algorithms/expression/vector/each_level.hpp"
#include "algorithms/inference/float_lanes.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kCodes = std::size_t{1} << Flips::kGroup;
constexpr std::size_t kLanesOfTile = 2;
constexpr std::size_t kTile =
    kLanesOfTile * kLanes;            // columns at once: their sums stay in registers
constexpr std::size_t kTogether = 2;  // flips at once

using Tile = std::array<float, kTile>;

// Entry `code` of a group: the sum of its clusters' scores, those whose bit is set with a plus.
void fill_group(const FloatRows& scores, std::size_t first_cluster, std::size_t column,
                Tile* entries) {
  const auto width = std::min(kTile, static_cast<std::size_t>(scores.cols()) - column);
  for (std::size_t code = 0; code < kCodes; ++code) entries[code].fill(0);
  std::size_t filled = 1;
  for (std::size_t k = 0; k < Flips::kGroup; ++k) {
    Tile own{};
    if (first_cluster + k < static_cast<std::size_t>(scores.rows())) {
      const float* row = scores.data() + (first_cluster + k) * scores.cols() + column;
      std::copy_n(row, width, own.begin());
    }
    for (std::size_t code = 0; code < filled; ++code) {
      for (std::size_t j = 0; j < kTile; ++j) {
        entries[filled + code][j] = entries[code][j] + own[j];
        entries[code][j] -= own[j];
      }
    }
    filled *= 2;
  }
}

// The sums of two flips, group after group: four chains, so that no addition waits for another.
TRIBENCH_EACH_LEVEL void add_groups(const Tile* entries, const std::uint8_t* codes,
                                    std::size_t groups, Tile* sums) {
  Lanes total[2 * kLanesOfTile] = {};
  for (std::size_t g = 0; g < groups; ++g, entries += kCodes) {
    const Tile* own[2] = {&entries[codes[g]], &entries[codes[groups + g]]};
    for (std::size_t k = 0; k < 2 * kLanesOfTile; ++k) {
      Lanes x;
      std::memcpy(&x, own[k / kLanesOfTile]->data() + k % kLanesOfTile * kLanes, sizeof x);
      total[k] += x;
    }
  }
  std::memcpy(sums, total, sizeof total);
}

}  // namespace

Flips::Flips(std::size_t count, std::size_t clusters, RandomStream random)
    : count_(count), clusters_(clusters), groups_((clusters + kGroup - 1) / kGroup) {
  codes_.reserve((count + kTogether) * groups_);
  std::uint64_t word = 0;
  std::size_t left = 0;
  for (std::size_t b = 0; b < count; ++b) {
    for (std::size_t g = 0; g < groups_; ++g) {
      unsigned code = 0;
      for (std::size_t k = 0; k < std::min(kGroup, clusters - g * kGroup); ++k) {
        if (left == 0) {
          word = random.next();
          left = 64;
        }
        code |= static_cast<unsigned>(word & 1) << k;
        word >>= 1;
        --left;
      }
      codes_.push_back(static_cast<std::uint8_t>(code));
    }
  }
  codes_.resize((count + kTogether) * groups_, 0);  // so that the last ones may be read in pairs
}

FloatRows Flips::sums(const FloatRows& scores, std::size_t first, std::size_t rows) const {
  const auto columns = static_cast<std::size_t>(scores.cols());
  FloatRows out(static_cast<Eigen::Index>(rows), scores.cols());
  std::vector<Tile> entries(groups_ * kCodes);
  std::array<Tile, kTogether> sums;
  for (std::size_t column = 0; column < columns; column += kTile) {
    const std::size_t width = std::min(kTile, columns - column);
    for (std::size_t g = 0; g < groups_; ++g) {
      fill_group(scores, g * kGroup, column, entries.data() + g * kCodes);
    }
    for (std::size_t b = 0; b < rows; b += kTogether) {
      add_groups(entries.data(), codes_.data() + (first + b) * groups_, groups_, sums.data());
      for (std::size_t k = 0; k < std::min(kTogether, rows - b); ++k) {
        std::copy_n(sums[k].begin(), width, out.data() + (b + k) * columns + column);
      }
    }
  }
  return out;
}

}  // namespace tribench::loop
