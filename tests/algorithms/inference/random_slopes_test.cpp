// SPDX-License-Identifier: MIT
#include "algorithms/inference/random_slopes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "tests/algorithms/inference/rows_with_noise.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kFlipsOfSlopes = 1999;

// A movement there and back: the sign of its direction, and where it is.
struct Strokes {
  std::vector<Eigen::MatrixXd> terms;
  std::vector<RowRange> movements;
};

Strokes strokes(std::size_t movements, std::size_t rows, double rad_a_row = 0.3) {
  Strokes out;
  const auto all = static_cast<Eigen::Index>(movements * rows);
  out.terms = {Eigen::MatrixXd(all, 1), Eigen::MatrixXd(all, 2)};
  for (std::size_t m = 0; m < movements; ++m) {
    out.movements.push_back({m * rows, (m + 1) * rows});
    for (std::size_t i = 0; i < rows; ++i) {
      const auto at = static_cast<Eigen::Index>(m * rows + i);
      const double phase = 0.7 * static_cast<double>(m) + rad_a_row * static_cast<double>(i);
      out.terms[0](at, 0) = std::cos(phase) > 0 ? 1 : -1;
      out.terms[1].row(at) << std::sin(2 * std::sin(phase)), std::cos(2 * std::sin(phase));
    }
  }
  return out;
}

// Each movement's own part of a term, of this rms over the campaign.
Eigen::VectorXd own_parts(const Strokes& data, std::size_t term, double rms, RandomStream random) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(data.terms[term].rows());
  for (const RowRange& movement : data.movements) {
    const auto begin = static_cast<Eigen::Index>(movement.begin);
    const auto size = static_cast<Eigen::Index>(movement.size());
    for (Eigen::Index j = 0; j < data.terms[term].cols(); ++j) {
      out.segment(begin, size) += random.normal() * data.terms[term].col(j).segment(begin, size);
    }
  }
  return out * (rms * std::sqrt(static_cast<double>(out.size())) / out.norm());
}

struct Told : RandomSlopes {
  std::size_t term = 0;
};

// The term that foretells most, where one foretells anything.
std::optional<Told> slopes_of(const Strokes& data, const Eigen::VectorXd& residual) {
  const std::vector<RandomSlopes> all =
      random_slopes(data.terms, residual, data.movements, kFlipsOfSlopes, RandomStream(1));
  EXPECT_EQ(all.size(), data.terms.size());
  const auto most = std::ranges::max_element(all, {}, &RandomSlopes::mean_share);
  if (!(most->mean_share > 0)) return std::nullopt;
  return Told{*most, static_cast<std::size_t>(most - all.begin())};
}

// White, and so slow that a movement holds ten correlation times and less.
TEST(RandomSlopes, NoiseAloneForetellsNothingHoweverLongItLasts) {
  for (const double rho : {0.0, 0.9, 0.98}) {
    for (const std::size_t rows : {25U, 100U, 500U}) {
      // One stroke a movement: as slow as the noise.
      const Strokes data = strokes(30, rows, 3.0 / static_cast<double>(rows));
      int found = 0;
      for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const Eigen::VectorXd noise = slow_under_white(
            rho > 0 ? 0.8 : 0, rho, static_cast<Eigen::Index>(30 * rows), RandomStream(100 + seed));
        const auto slopes = slopes_of(data, noise);
        found += slopes && slopes->p <= 0.02 ? 1 : 0;
      }
      EXPECT_LE(found, 4) << "rho " << rho << ", rows " << rows;  // 1.2 are expected
    }
  }
}

TEST(RandomSlopes, TellsTheTermThatDiffersAndHowMuch) {
  const Strokes data = strokes(20, 200);
  for (const std::size_t term : {0U, 1U}) {
    const Eigen::VectorXd own = own_parts(data, term, 0.5, RandomStream(3));
    const auto slopes = slopes_of(data, own + slow_under_white(0.5, 0.8, 4000, RandomStream(4)));
    ASSERT_TRUE(slopes) << term;
    EXPECT_EQ(slopes->term, term);
    EXPECT_LE(slopes->p, 0.002);
    EXPECT_NEAR(slopes->share, 0.2, 0.07);  // 0.25 of 1.25
    // The ridge takes a tenth.
    const Eigen::VectorXd told = slopes->slopes(7, 0) * data.terms[term].col(0).segment(1400, 200) +
                                 (term == 1 ? slopes->slopes(7, 1) : 0) *
                                     data.terms[term].rightCols(1).middleRows(1400, 200);
    EXPECT_NEAR(told.dot(own.segment(1400, 200)) / own.segment(1400, 200).squaredNorm(), 0.9, 0.25);
  }
}

// The unit is the movement: eight of them cannot be surer than 1 in 256, nine can.
TEST(RandomSlopes, FewMovementsCannotTell) {
  const Strokes eight = strokes(8, 300);
  const auto few = slopes_of(eight, own_parts(eight, 0, 3, RandomStream(5)) +
                                        slow_under_white(0, 0, 2400, RandomStream(6)));
  ASSERT_TRUE(few);
  EXPECT_GT(few->share, 0.5);
  EXPECT_GT(few->p, 0.002);
}

// Its squares are most of all squares; the other nineteen gain nothing.
TEST(RandomSlopes, OneOddMovementIsMuchAndNotSure) {
  const Strokes data = strokes(20, 200);
  Eigen::VectorXd residual = slow_under_white(0, 0, 4000, RandomStream(7));
  residual.segment(600, 200) += 4 * data.terms[0].col(0).segment(600, 200);
  const std::vector<RandomSlopes> all =
      random_slopes(data.terms, residual, data.movements, kFlipsOfSlopes, RandomStream(1));
  EXPECT_GT(all[0].p, 0.05);
  EXPECT_GT(all[0].share, 0.3);
  EXPECT_LT(all[1].share, all[0].share);
}

TEST(RandomSlopes, UnitsChangeNothing) {
  const Strokes data = strokes(20, 200);
  const Eigen::VectorXd residual =
      own_parts(data, 1, 0.3, RandomStream(8)) + slow_under_white(0.3, 0.7, 4000, RandomStream(9));
  Strokes other = data;
  for (Eigen::MatrixXd& term : other.terms) term *= 1024;
  const auto one = slopes_of(data, residual);
  const auto two = slopes_of(other, residual / 4096);
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->p, two->p);
  EXPECT_EQ(one->share, two->share);
  EXPECT_EQ(one->slopes, two->slopes * 1024 * 4096);
}

TEST(RandomSlopes, ShortMovementsAndColumnsOfZerosAreHarmless) {
  Strokes data = strokes(12, 9);
  EXPECT_FALSE(slopes_of(data, slow_under_white(0, 0, 108, RandomStream(2))));
  data = strokes(12, 100);
  data.terms[0].setZero();
  const auto slopes = slopes_of(
      data, own_parts(data, 1, 1, RandomStream(3)) + slow_under_white(0, 0, 1200, RandomStream(2)));
  ASSERT_TRUE(slopes);
  EXPECT_EQ(slopes->term, 1U);
  EXPECT_FALSE(slopes_of(data, Eigen::VectorXd::Zero(1200)));
}

}  // namespace
}  // namespace tribench::loop
