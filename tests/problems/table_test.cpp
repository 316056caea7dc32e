// SPDX-License-Identifier: MIT
#include "problems/table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "foundation/error.hpp"

namespace tribench {
namespace {

KnownDataset two_movements() {
  KnownDataset known;
  known.data.channels = {{"v", "rad/s", Role::velocity, {-1, 0, 2, 3}},
                         {"y", "N m", Role::friction_torque, {10, 20, 30, 40}}};
  known.data.movement = {0, 0, 1, 1};
  known.data.movement_names = {"a", "b"};
  known.truth = {1, 2, 3, 4};
  return known;
}

TEST(Table, TakesWholeMovementsAndDerivesSigns) {
  std::vector<Input> inputs = {{"sgn_v", "-", Role::velocity_sign, -1, 1, {}},
                               {"v", "rad/s", Role::velocity, -3, 3, {}}};
  link_signs(inputs);
  EXPECT_EQ(inputs[0].sign_of, std::optional<std::size_t>(1));
  EXPECT_FALSE(inputs[1].sign_of.has_value());
  const std::vector<char> first = {1, 0};
  const Table table = make_table(two_movements(), inputs, "y", first);
  EXPECT_EQ(table.columns[0], (std::vector<double>{-1, 0}));
  EXPECT_EQ(table.columns[1], (std::vector<double>{-1, 0}));
  EXPECT_EQ(table.target, (std::vector<double>{10, 20}));
  EXPECT_EQ(table.truth, (std::vector<double>{1, 2}));
}

TEST(Table, AnUnknownInputIsAnsweredWithTheNearestColumn) {
  try {
    const KnownDataset known = two_movements();
    input_values(ChannelIndex(known.data), "sgn_w");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("sgn_w"), std::string::npos);
  }
}

TEST(Table, RefusesASignThatIsNoneOfTheInputBesideIt) {
  KnownDataset known = two_movements();
  const std::vector<std::string> inputs = {"sgn_v", "v"};
  require_signs(known.data, inputs);
  known.data.channels.push_back({"sgn_v", "-", Role::none, {-1, 0, 1, std::nan("")}});
  require_signs(known.data, inputs);
  known.data.channels.back().values[2] = -2;
  try {
    require_signs(known.data, inputs);
    FAIL() << "no error";
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("'sgn_v' is -2 where 'v' is 2"), std::string::npos) << text;
    EXPECT_NE(text.find("rename the column"), std::string::npos) << text;
  }
  require_signs(known.data, std::vector<std::string>{"sgn_v"});
}

TEST(Table, TimeBreaksWhereItLeapsOrFalls) {
  const std::vector<double> time = {0, 1, 2, 3, 12, 13, 14, 0, 1, 2, 2};
  EXPECT_EQ(run_starts(time), (std::vector<std::size_t>{0, 4, 7, 10}));
  EXPECT_EQ(run_starts(std::vector<double>{3}), (std::vector<std::size_t>{0}));
}

// Each movement has a clock of its own, so that times alone do not tell where a row stands.
TEST(Table, RowsDrawnFromARecordingKnowWhereTheyStandInIt) {
  KnownDataset whole;
  whole.data.channels = {{"t", "s", Role::time, {}}, {"v", "rad/s", Role::velocity, {}}};
  whole.data.movement_names = {"a", "b", "c"};
  for (int r = 0; r < 90; ++r) {
    whole.data.channels[0].values.push_back(0.1 * (r % 30));
    whole.data.channels[1].values.push_back(r);
    whole.data.movement.push_back(r / 30);
  }
  const std::vector<Input> inputs = {{"v", "rad/s", Role::velocity, 0, 90, {}}};
  const Dataset drawn = thin(whole, 7, RandomStream(2)).data;
  Table table = make_table({drawn, {}}, inputs, "v", std::vector<char>{1, 0, 1});
  ASSERT_EQ(table.trail->time.size(), 21U);
  lay_trail(whole.data, drawn, inputs, table);
  ASSERT_EQ(table.trail->time.size(), 90U);
  EXPECT_EQ(table.trail->starts, (std::vector<std::size_t>{0, 30, 60}));
  ASSERT_EQ(table.trail_row.size(), table.rows());
  for (std::size_t r = 0; r < table.rows(); ++r) {
    EXPECT_EQ(table.trail->columns[0][table.trail_row[r]], table.columns[0][r]);
  }
}

TEST(Table, ThinningTakesTheSameNumberOfEveryMovementInOrder) {
  KnownDataset known;
  known.data.channels = {{"x", "-", Role::none, {}}};
  known.data.movement_names = {"long", "short", "tiny"};
  for (int i = 0; i < 113; ++i) {
    known.data.channels[0].values.push_back(i);
    known.data.movement.push_back(i < 80 ? 0 : (i < 110 ? 1 : 2));
  }
  const KnownDataset thinned = thin(known, 10, RandomStream(3));
  ASSERT_EQ(thinned.data.rows(), 23U);  // the tiny movement is kept whole
  for (std::size_t r = 1; r < thinned.data.rows(); ++r) {
    EXPECT_LT(thinned.data.channels[0].values[r - 1], thinned.data.channels[0].values[r]);
  }
  EXPECT_EQ(thinned.data.movement[9], 0);
  EXPECT_EQ(thinned.data.movement[10], 1);
  EXPECT_EQ(thinned.data.movement[20], 2);
}

}  // namespace
}  // namespace tribench
