// SPDX-License-Identifier: MIT
#include "algorithms/inference/within_movements.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "foundation/random.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kStretchRows = 30;
constexpr std::size_t kStretchesOfMovement = 12;
constexpr std::size_t kFlipsOfTest = 999;

// Movements of twelve stretches there and back: an offset and the sign of the direction.
struct Campaign {
  Clusters clusters;
  Eigen::MatrixXd terms;

  explicit Campaign(std::size_t movements) {
    const std::size_t length = kStretchRows * kStretchesOfMovement;
    std::vector<int> movement;
    for (std::size_t m = 0; m < movements; ++m) {
      movement.insert(movement.end(), length, static_cast<int>(m));
    }
    clusters = make_clusters(movement, 1);
    terms.setOnes(static_cast<Eigen::Index>(movement.size()), 2);
    for (Eigen::Index i = 0; i < terms.rows(); ++i) terms(i, 1) = i % 20 < 10 ? 1 : -1;
  }

  // A number for each movement times the direction.
  Eigen::VectorXd by_movement(RandomStream random) const {
    Eigen::VectorXd out = terms.col(1);
    for (const RowRange& movement : clusters.movements) {
      out.segment(static_cast<Eigen::Index>(movement.begin),
                  static_cast<Eigen::Index>(movement.size())) *= random.normal();
    }
    return out;
  }

  Eigen::VectorXd noise(RandomStream random) const {
    Eigen::VectorXd out(terms.rows());
    for (double& one : out) one = random.normal();
    return out;
  }
};

struct Share {
  int within = 0;
  int of_movements = 0;
};

// Of 40 campaigns, how many tests say at 5 % that `column` is in `column_share` times itself and
// friction that is another in each movement.
Share found(const Campaign& campaign, double column_share, bool changes_within) {
  Share share;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    RandomStream random(seed);
    Eigen::VectorXd column = campaign.by_movement(random.split("column"));
    if (changes_within) {
      const Eigen::ArrayXd phase = Eigen::ArrayXd::LinSpaced(column.size(), 0, 200);
      column = (column.array() * phase.cos()).matrix();
    }
    const AskedColumn asked = {column, campaign.terms,
                               column_share * column + campaign.noise(random.split("noise")) +
                                   0.5 * campaign.by_movement(random.split("friction"))};
    const Flips flips(kFlipsOfTest, campaign.clusters.stretches.size(), random.split("flips"));
    share.within +=
        p_within_movements(asked, campaign.terms, campaign.clusters, flips) <= 0.05 ? 1 : 0;
    share.of_movements +=
        p_of_movements(asked, campaign.clusters, kFlipsOfTest, random.split("whole")) <= 0.05 ? 1
                                                                                              : 0;
  }
  return share;
}

TEST(WithinMovements, WhatChangesBetweenThemOnlyShowsByWholeMovementsOrNotAtAll) {
  const Share nothing = found(Campaign(40), 0, false);
  EXPECT_EQ(nothing.within, 0);
  EXPECT_LE(nothing.of_movements, 6);  // 2 are expected
  const Share all = found(Campaign(40), 0.5, false);
  EXPECT_EQ(all.within, 0);
  EXPECT_GE(all.of_movements, 38);
  // Four movements have eight signs.
  EXPECT_EQ(found(Campaign(4), 5, false).of_movements, 0);
}

TEST(WithinMovements, WhatChangesWithinThemShowsThereHoweverFewTheyAre) {
  const Share nothing = found(Campaign(4), 0, true);
  EXPECT_LE(nothing.within, 6);
  const Share all = found(Campaign(4), 0.5, true);
  EXPECT_GE(all.within, 38);
  EXPECT_EQ(all.of_movements, 0);
}

TEST(WithinMovements, ColumnsLessTheFitOfEachMovementAreOrthogonalToItsTerms) {
  const Campaign campaign(3);
  const Eigen::MatrixXd rest = within_movements(campaign.noise(RandomStream(3)), campaign.terms,
                                                campaign.clusters.movements);
  for (const RowRange& movement : campaign.clusters.movements) {
    const auto begin = static_cast<Eigen::Index>(movement.begin);
    const auto size = static_cast<Eigen::Index>(movement.size());
    const Eigen::MatrixXd products =
        campaign.terms.middleRows(begin, size).transpose() * rest.middleRows(begin, size);
    EXPECT_LT(products.cwiseAbs().maxCoeff(), 1e-9);
  }
}

}  // namespace
}  // namespace tribench::loop
