// SPDX-License-Identifier: MIT
//
// The sign flips of the score test: B rows of +-1, one a cluster, and the sums of the clusters'
// scores under each. Internal to the room.
//
// A sum over C clusters is one of sums over groups of four: the sixteen of a group are worked out
// once, and a flip adds a quarter as many terms (the method of four Russians; Arlazarov et al.
// 1970). 2 000 flips of 110 clusters and 70 columns take 0.3 ms.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "foundation/random.hpp"

namespace tribench::loop {

using FloatRows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

class Flips {
 public:
  static constexpr std::size_t kGroup = 4;  // clusters

  Flips() = default;
  // Independent fair signs; the same stream gives the same ones on any machine.
  Flips(std::size_t count, std::size_t clusters, RandomStream random);

  std::size_t count() const { return count_; }
  std::size_t clusters() const { return clusters_; }
  // 1 or -1
  int sign(std::size_t flip, std::size_t cluster) const {
    const unsigned code = codes_[flip * groups_ + cluster / kGroup];
    return ((code >> (cluster % kGroup)) & 1U) != 0 ? 1 : -1;
  }

  // Row b: the sum over clusters c of sign(first + b, c) times row c of `scores` (clusters x
  // columns), for `rows` flips.
  FloatRows sums(const FloatRows& scores, std::size_t first, std::size_t rows) const;

  // The same where columns are pairs: the largest square length of a pair of sums, by flip. A pair
  // are columns j and j + kLanes of every 2 kLanes; their number is a multiple of that. Half as
  // long as `sums` where columns are many, as these are not written down.
  std::vector<float> largest_squares(const FloatRows& pairs, std::size_t first,
                                     std::size_t rows) const;

 private:
  std::size_t count_ = 0;
  std::size_t clusters_ = 0;
  std::size_t groups_ = 0;
  std::vector<std::uint8_t> codes_;  // a flip after the other, one of 16 a group
};

}  // namespace tribench::loop
