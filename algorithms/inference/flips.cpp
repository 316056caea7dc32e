// SPDX-License-Identifier: MIT
#include "algorithms/inference/flips.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "algorithms/expression/vector/each_level.hpp"
#include "algorithms/inference/float_lanes.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kGroup = Flips::kGroup;
constexpr std::size_t kCodes = std::size_t{1} << kGroup;
constexpr std::size_t kLanesOfTile = 2;
constexpr std::size_t kTile =
    kLanesOfTile * kLanes;            // columns at once: their sums stay in registers
constexpr std::size_t kTogether = 2;  // flips at once

using Tile = std::array<float, kTile>;

// Entry `code` of each group: the sum of its clusters' scores, those whose bit is set with a plus.
// scores: of a tile, padded with zeros, a row of kTile after the other, kGroup rows a group.
TRIBENCH_EACH_LEVEL void fill_groups(const float* scores, std::size_t groups, Tile* entries) {
  for (std::size_t g = 0; g < groups; ++g, scores += kGroup * kTile, entries += kCodes) {
    for (std::size_t lane = 0; lane < kTile; lane += kLanes) {
      Lanes sums[kCodes] = {};
      for (std::size_t k = 0; k < kGroup; ++k) {
        Lanes own;
        std::memcpy(&own, scores + k * kTile + lane, sizeof own);
        for (std::size_t code = 0; code < (std::size_t{1} << k); ++code) {
          sums[(std::size_t{1} << k) + code] = sums[code] + own;
          sums[code] -= own;
        }
      }
      for (std::size_t code = 0; code < kCodes; ++code) {
        std::memcpy(entries[code].data() + lane, &sums[code], sizeof sums[code]);
      }
    }
  }
}

// A tile of the scores, padded with zeros to whole groups of rows and to the tile's width.
void copy_tile(const FloatRows& scores, std::size_t column, std::vector<float>& tile) {
  const auto width = std::min(kTile, static_cast<std::size_t>(scores.cols()) - column);
  for (std::size_t c = 0; c < static_cast<std::size_t>(scores.rows()); ++c) {
    std::copy_n(scores.data() + c * static_cast<std::size_t>(scores.cols()) + column, width,
                tile.begin() + static_cast<std::ptrdiff_t>(c * kTile));
  }
  if (width == kTile) return;
  for (std::size_t c = 0; c < static_cast<std::size_t>(scores.rows()); ++c) {
    std::fill_n(tile.begin() + static_cast<std::ptrdiff_t>(c * kTile + width), kTile - width, 0.0F);
  }
}

// The sums of two flips, group after group: four chains, so that no addition waits for another. A
// macro: a function could not give lanes back that some instruction sets pass differently.
#define TRIBENCH_SUM_GROUPS(total, entries, codes, groups)                                  \
  Lanes total[2 * kLanesOfTile] = {};                                                       \
  for (std::size_t g = 0; g < (groups); ++g) {                                              \
    const Tile* table = (entries) + g * kCodes;                                             \
    const Tile* own[2] = {&table[(codes)[g]], &table[(codes)[(groups) + g]]};               \
    for (std::size_t k = 0; k < 2 * kLanesOfTile; ++k) {                                    \
      Lanes x;                                                                              \
      std::memcpy(&x, own[k / kLanesOfTile]->data() + k % kLanesOfTile * kLanes, sizeof x); \
      (total)[k] += x;                                                                      \
    }                                                                                       \
  }

TRIBENCH_EACH_LEVEL void add_groups(const Tile* entries, const std::uint8_t* codes,
                                    std::size_t groups, Tile* sums) {
  TRIBENCH_SUM_GROUPS(total, entries, codes, groups)
  std::memcpy(sums, total, sizeof total);
}

// largest: of either flip, by the place in the tile.
TRIBENCH_EACH_LEVEL void raise_largest(const Tile* entries, const std::uint8_t* codes,
                                       std::size_t groups, float* largest) {
  TRIBENCH_SUM_GROUPS(total, entries, codes, groups)
  for (std::size_t k = 0; k < kTogether; ++k) {
    const Lanes* pair = total + k * kLanesOfTile;
    const Lanes square = pair[0] * pair[0] + pair[1] * pair[1];
    Lanes most;
    std::memcpy(&most, largest + k * kLanes, sizeof most);
    most = square > most ? square : most;
    std::memcpy(largest + k * kLanes, &most, sizeof most);
  }
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
  std::vector<float> tile(groups_ * kGroup * kTile, 0.0F);
  std::array<Tile, kTogether> sums;
  for (std::size_t column = 0; column < columns; column += kTile) {
    const std::size_t width = std::min(kTile, columns - column);
    copy_tile(scores, column, tile);
    fill_groups(tile.data(), groups_, entries.data());
    for (std::size_t b = 0; b < rows; b += kTogether) {
      add_groups(entries.data(), codes_.data() + (first + b) * groups_, groups_, sums.data());
      for (std::size_t k = 0; k < std::min(kTogether, rows - b); ++k) {
        std::copy_n(sums[k].begin(), width, out.data() + (b + k) * columns + column);
      }
    }
  }
  return out;
}

std::vector<float> Flips::largest_squares(const FloatRows& pairs, std::size_t first,
                                          std::size_t rows) const {
  std::vector<float> lanes((rows + kTogether) * kLanes, 0.0F);
  std::vector<Tile> entries(groups_ * kCodes);
  std::vector<float> tile(groups_ * kGroup * kTile, 0.0F);
  for (std::size_t column = 0; column < static_cast<std::size_t>(pairs.cols()); column += kTile) {
    copy_tile(pairs, column, tile);
    fill_groups(tile.data(), groups_, entries.data());
    for (std::size_t b = 0; b < rows; b += kTogether) {
      raise_largest(entries.data(), codes_.data() + (first + b) * groups_, groups_,
                    lanes.data() + b * kLanes);
    }
  }
  std::vector<float> largest(rows);
  for (std::size_t b = 0; b < rows; ++b) {
    largest[b] = *std::max_element(lanes.begin() + static_cast<std::ptrdiff_t>(b * kLanes),
                                   lanes.begin() + static_cast<std::ptrdiff_t>((b + 1) * kLanes));
  }
  return largest;
}

}  // namespace tribench::loop
