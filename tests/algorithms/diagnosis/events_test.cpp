// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/events.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "algorithms/inference/student_law.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kMovements = 60;
constexpr std::size_t kRows = 60;

Observations empty_recording() {
  Observations data;
  for (std::size_t i = 0; i < kMovements * kRows; ++i) {
    data.target.push_back(0);
    data.time.push_back(static_cast<double>(i));
    data.movement.push_back(static_cast<int>(i / kRows));
  }
  return data;
}

// Student noise with 5 degrees of freedom, neighbours correlated by 0.6, unit variance.
Eigen::VectorXd noise(RandomStream random) {
  const StudentLaw law{5, std::sqrt(3.0 / 5.0)};
  Eigen::VectorXd r(static_cast<Eigen::Index>(kMovements * kRows));
  for (Eigen::Index i = 0; i < r.size(); ++i) {
    const bool first = i % static_cast<Eigen::Index>(kRows) == 0;
    r[i] = first ? law.draw(random) : 0.6 * r[i - 1] + 0.8 * law.draw(random);
  }
  return r;
}

std::vector<EventFinding> events_of(const Eigen::VectorXd& residual, std::uint64_t seed) {
  std::vector<char> masked;
  return find_events(empty_recording(), residual, masked, RandomStream(seed));
}

TEST(Events, CleanRecordingsWithHeavyTailsHardlyEverHoldOne) {
  int with = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    with += events_of(noise(RandomStream(seed)), seed).empty() ? 0 : 1;
  }
  EXPECT_LE(with, 6);  // 2 are expected; more than 6 in one of 200
}

TEST(Events, APulseIsFoundWhereItIsAndMasked) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Eigen::VectorXd residual = noise(RandomStream(seed));
    for (Eigen::Index k = 0; k < 6; ++k) {
      residual[630 + k] -= 8 * std::sin(3.14159265 * (static_cast<double>(k) + 0.5) / 6);
    }
    std::vector<char> masked;
    const std::vector<EventFinding> events =
        find_events(empty_recording(), residual, masked, RandomStream(seed));
    for (const EventFinding& event : events) {
      if (event.movement != 10 || event.begin > 636 || event.end < 630) continue;
      ++found;
      EXPECT_GT(event.peak, 4);
      EXPECT_EQ(masked[632], 1);
    }
  }
  EXPECT_GE(found, 93);
}

// A wild row fades away by the noise's own correlation: four rows on one side, and no burst.
TEST(Events, OneWildRowThatFadesAwayIsNoBurst) {
  Eigen::VectorXd residual = noise(RandomStream(7));
  for (Eigen::Index k = 0; k < 12; ++k) {
    residual[1230 + k] += 14 * std::pow(0.6, static_cast<double>(k));
  }
  EXPECT_TRUE(events_of(residual, 7).empty());
}

TEST(Events, ARecordingWithoutNoiseHasNone) {
  EXPECT_TRUE(events_of(Eigen::VectorXd::Zero(kMovements * kRows), 1).empty());
}

TEST(StudentLaw, IsRecoveredFromItsDraws) {
  RandomStream random(3);
  for (const double freedom : {3.0, 5.0, 40.0}) {
    const StudentLaw law{freedom, 0.7};
    std::vector<double> z;
    for (int i = 0; i < 40000; ++i) z.push_back(law.draw(random));
    const StudentLaw fitted = fit_student(z);
    EXPECT_EQ(fitted.freedom, freedom);
    EXPECT_NEAR(fitted.scale, 0.7, 0.02);
  }
}

}  // namespace
}  // namespace tribench::loop
