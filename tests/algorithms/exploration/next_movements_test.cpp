// SPDX-License-Identifier: MIT
#include "algorithms/exploration/next_movements.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "problems/kuka/planted.hpp"

namespace tribench::loop {
namespace {

struct Proposals {
  Observations data;
  std::vector<ProposedMovement> movements;
};

Proposals proposals_for(const kuka::PlantedCase& planted, std::size_t count) {
  Observations data = observe(kuka::make_planted(planted, 1).data);
  DiagnosisOptions options;
  options.physical_vetoes = false;
  options.gear_ratios = {160};
  const Diagnosis diagnosis = diagnose(data, coulomb_viscous_base, options);
  std::vector<ProposedMovement> movements = propose_movements(diagnosis, data, count);
  return {std::move(data), std::move(movements)};
}

TEST(ProposedMovements, RunInTheDirectionOfTheirVelocityAndEndBeforeAnyoneTires) {
  const Proposals proposals = proposals_for({.effects = {{"load_coulomb", 0.5}}}, 50);
  ASSERT_GE(proposals.movements.size(), 3U);
  double last = proposals.movements.front().separation;
  for (const ProposedMovement& one : proposals.movements) {
    EXPECT_LE(one.separation, last);
    last = one.separation;
    EXPECT_LE(one.duration, 120);
    if (one.kind != "constant") continue;
    EXPECT_GT((one.to - one.from) * one.velocity, 0);
    EXPECT_NEAR(one.duration, (one.to - one.from) / one.velocity, 1e-9);
  }
}

TEST(ProposedMovements, TwoTonesStayWithinTheirRangeAndReachTheirSpeed) {
  const Proposals proposals = proposals_for({.effects = {{"lag", 2.0}}}, 50);
  int seen = 0;
  for (const ProposedMovement& one : proposals.movements) {
    if (one.kind != "two_tone") continue;
    ++seen;
    double fastest = 0;
    for (int i = 0; i <= 1000; ++i) {
      double q = 0.5 * (one.from + one.to);
      double v = 0;
      for (const Tone& tone : one.tones) {
        const double w = 2 * std::numbers::pi * tone.frequency;
        const double time = one.duration * i / 1000;
        q += tone.amplitude * std::sin(w * time);
        v += tone.amplitude * w * std::cos(w * time);
      }
      EXPECT_GE(q, one.from);
      EXPECT_LE(q, one.to);
      fastest = std::max(fastest, std::abs(v));
    }
    EXPECT_NEAR(fastest, one.velocity, 1e-6 * one.velocity);
  }
  // Reversals are what tells a lag: it needs them.
  EXPECT_GT(seen, 0);
  EXPECT_EQ(proposals.movements.front().kind, "two_tone");
}

TEST(ProposedMovements, PreslidingIsSoughtWhereItIsNearAReversal) {
  const Proposals proposals = proposals_for({.effects = {{"hysteresis", 2.0}}}, 1);
  ASSERT_EQ(proposals.movements.size(), 1U);
  const ProposedMovement& best = proposals.movements.front();
  const auto positions = std::ranges::minmax(proposals.data.find("q")->values);
  EXPECT_LT(std::abs(best.to - best.from), 0.25 * (positions.max - positions.min));
}

TEST(ProposedMovements, AreNoneWhereNothingWasFound) {
  EXPECT_TRUE(proposals_for({}, 5).movements.empty());
}

TEST(MovementsCsv, NamesItsUnitsAndGivesEveryRowAsManyCellsAsTheHeader) {
  const Proposals proposals = proposals_for({.effects = {{"lag", 2.0}}}, 20);
  std::istringstream lines(movements_csv(proposals.movements, proposals.data));
  std::string header;
  std::getline(lines, header);
  EXPECT_EQ(header,
            "order,kind,velocity_rad_s,from_rad,to_rad,load_factor,duration_s,tone1_rad,tone1_Hz,"
            "tone2_rad,tone2_Hz,separation,between");
  std::size_t rows = 0;
  for (std::string line; std::getline(lines, line); ++rows) {
    EXPECT_EQ(std::ranges::count(line, ','), std::ranges::count(header, ',')) << line;
  }
  EXPECT_EQ(rows, proposals.movements.size());
}

}  // namespace
}  // namespace tribench::loop
