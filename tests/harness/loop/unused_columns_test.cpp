// SPDX-License-Identifier: MIT
#include "harness/loop/unused_columns.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "foundation/random.hpp"
#include "harness/loop/judged_diagnosis.hpp"
#include "problems/kuka/planted.hpp"

namespace tribench::loop::unused_columns_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// A campaign in which nobody has told what the other joint's columns are, with columns that say
// nothing beside them.
Dataset told_without_the_other_joint(const kuka::PlantedCase& planted, std::uint64_t seed) {
  Dataset data = kuka::make_planted(planted, seed).data;
  std::erase_if(data.channels, [](const Channel& c) { return c.role == Role::other_acceleration; });
  for (Channel& channel : data.channels) {
    if (channel.role != Role::other_velocity) continue;
    channel.role = Role::none;
    channel.name = "neighbour";
  }
  RandomStream random(seed);
  Channel noise{"voltage", "", Role::none, {}};
  Channel walk{"counter", "", Role::none, {}};
  Channel constant{"state", "", Role::none, std::vector<double>(data.rows(), 3)};
  double at = 0;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    noise.values.push_back(random.normal());
    walk.values.push_back(at += random.normal());
  }
  for (Channel* channel : {&noise, &walk, &constant}) data.channels.push_back(std::move(*channel));
  return data;
}

std::vector<std::string> hints(const kuka::PlantedCase& planted, std::uint64_t seed) {
  JudgingOptions judging;
  judging.bounds = true;
  const JudgedDiagnosis diagnosis =
      diagnose_and_judge(observe(told_without_the_other_joint(planted, seed)), coulomb_viscous_base,
                         {.gear_ratios = {160}}, judging);
  std::vector<std::string> names;
  for (const UnusedColumn& one : diagnosis.unused_columns) {
    EXPECT_GT(one.share, 0.05);
    EXPECT_LT(one.share, 1);
    names.push_back(one.column);
  }
  return names;
}

TEST(UnusedColumns, TheOtherJointIsPointedAtWhereItDisturbs) {
  EXPECT_THAT(hints({.effects = {{"coupling", 2.0}}}, 3), ElementsAre("neighbour"));
  EXPECT_THAT(hints({.effects = {{"coupling", 2.0}, {"stribeck", 2.0}}}, 4),
              ElementsAre("neighbour"));
}

TEST(UnusedColumns, NothingIsSaidWhereTheyExplainNothing) {
  for (std::uint64_t seed = 5; seed < 9; ++seed) {
    EXPECT_THAT(hints({}, seed), IsEmpty()) << seed;
    EXPECT_THAT(hints({.effects = {{"stribeck", 2.0}}}, seed), IsEmpty()) << seed;
  }
}

// What follows the weather follows the time, too: a function of the time alone must not take it
// off.
TEST(UnusedColumns, AColumnIsARivalOfTheTime) {
  Dataset data = kuka::make_planted({}, 3).data;
  const std::vector<double> v = data.find(Role::velocity)->values;
  Channel humidity{"humidity", "%", Role::none, {}};
  const auto target = std::ranges::find(data.channels, Role::friction_torque, &Channel::role);
  for (std::size_t i = 0; i < data.rows(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(data.rows());
    humidity.values.push_back(50 + 15 * std::sin(9 * share));
    target->values[i] += std::copysign(0.2, v[i]) * (humidity.values.back() - 50);
  }
  data.channels.push_back(std::move(humidity));
  JudgingOptions judging;
  judging.bounds = true;
  const JudgedDiagnosis diagnosis =
      diagnose_and_judge(observe(data), coulomb_viscous_base, {.gear_ratios = {160}}, judging);
  EXPECT_NE(diagnosis.verdict, Verdict::none);
  ASSERT_EQ(diagnosis.unused_columns.size(), 1U);
  EXPECT_EQ(diagnosis.unused_columns[0].column, "humidity");
}

TEST(UnusedColumns, ShareIsOfRowsThatTheCorrectionHasNotSeen) {
  Observations data;
  RandomStream random(1);
  Signal told{"column", "column", "", Role::none, {}, {}};
  Eigen::VectorXd residual(2000);

  for (int i = 0; i < 2000; ++i) {
    const double x = random.uniform(-1, 1);
    told.values.push_back(x);
    residual[i] = 3 * x * x - 1 + 0.1 * random.normal();
    data.movement.push_back(i / 100);
  }
  data.target.assign(2000, 0);
  data.unused = {told};
  const auto found = unused_columns_that_explain(data, residual, RandomStream(2));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].column, "column");
  // Mean |3 x^2 - 1| is 0.77, of the noise 0.08.
  EXPECT_NEAR(found[0].share, 0.9, 0.03);
  // A residual of one movement alone is no rule.
  for (int i = 0; i < 2000; ++i) residual[i] = (i < 100 ? residual[i] : 0.1 * random.normal());
  EXPECT_THAT(unused_columns_that_explain(data, residual, RandomStream(2)), IsEmpty());
}

}  // namespace
}  // namespace tribench::loop::unused_columns_test
