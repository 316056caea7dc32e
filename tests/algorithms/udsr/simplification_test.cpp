// SPDX-License-Identifier: MIT
#include "algorithms/udsr/simplification.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace tribench::udsr {
namespace {

class SimplificationTest : public testing::Test {
 protected:
  // Two inputs on [0.5, 2], noise of the given sd.
  std::optional<Reduction> reduction_of(const std::function<double(double, double)>& law,
                                        double noise = 0.0) {
    RandomStream random(21);
    a.clear();
    b.clear();
    y.clear();
    for (int i = 0; i < 220; ++i) {
      a.push_back(random.uniform(0.5, 2));
      b.push_back(random.uniform(0.5, 2));
      y.push_back(law(a.back(), b.back()) + noise * random.normal());
    }
    columns = {a.data(), b.data()};
    smoother.emplace(Inputs{columns, y.size()}, y, RandomStream(22));
    Budget budget({});
    return find_reduction(*smoother, inputs, find_operator_set("full"), RandomStream(23), budget);
  }
  bool finds(ReductionKind kind, const std::function<double(double, double)>& law) {
    const std::optional<Reduction> found = reduction_of(law, 0.002);
    return found && found->kind == kind;
  }

  std::vector<Input> inputs = {{"a", "-", Role::none, 0.5, 2, std::nullopt},
                               {"b", "-", Role::none, 0.5, 2, std::nullopt}};
  std::vector<double> a, b, y;
  std::vector<const double*> columns;
  std::optional<Smoother> smoother;
};

TEST_F(SimplificationTest, SmootherKnowsItsHeldOutError) {
  reduction_of([](double x, double z) { return std::sin(2 * x) * z; }, 0.1);
  // The median absolute error of N(0, 0.1) is 0.067.
  EXPECT_NEAR(smoother->held_out_error(), 0.067, 0.02);
  reduction_of([](double x, double z) { return std::sin(2 * x) * z; });
  EXPECT_LT(smoother->held_out_error(), 1e-3);
}

TEST_F(SimplificationTest, FindsEachOfTheSixReductions) {
  using enum ReductionKind;
  EXPECT_TRUE(finds(difference, [](double x, double z) { return std::sin(3 * (x - z)); }));
  EXPECT_TRUE(finds(sum, [](double x, double z) { return std::sin(2 * (x + z)); }));
  EXPECT_TRUE(finds(ratio, [](double x, double z) { return std::sin(2 * x / z); }));
  EXPECT_TRUE(finds(product, [](double x, double z) { return std::sin(2 * x * z); }));
  EXPECT_TRUE(finds(additive, [](double x, double z) { return std::sin(3 * x) + std::exp(z); }));
  EXPECT_TRUE(finds(multiplicative,
                    [](double x, double z) { return (2 + std::sin(3 * x)) * std::exp(z); }));
}

TEST_F(SimplificationTest, AcceptsNothingWhereNothingHolds) {
  EXPECT_FALSE(
      reduction_of([](double x, double z) { return std::sin(2 * x * z * z) + x * x / z; }, 0.002));
  // An input that plays no part is no reason to split.
  EXPECT_FALSE(reduction_of([](double x, double) { return std::sin(3 * x); }, 0.05));
}

TEST_F(SimplificationTest, PartsRecombineToTheWhole) {
  const auto found = reduction_of([](double x, double z) { return x * x * std::exp(z); }, 0.02);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->kind, ReductionKind::multiplicative);
  const std::vector<Subproblem> parts = split(*found, *smoother, {inputs, columns, y, {}});
  ASSERT_EQ(parts.size(), 2U);
  for (std::size_t r = 0; r < smoother->rows(); ++r) {
    EXPECT_NEAR(parts[0].target[r] * parts[1].target[r], smoother->target(r),
                0.02 * std::abs(smoother->target(r)) + 0.1);
  }
}

TEST_F(SimplificationTest, KeepsAnInputAndItsSignTogether) {
  std::vector<double> v, s, g, target;
  RandomStream random(31);
  for (int i = 0; i < 240; ++i) {
    v.push_back(random.uniform(-1, 1));
    s.push_back(v.back() > 0 ? 1 : -1);
    g.push_back(random.uniform(-1, 1));
    target.push_back(2 * s.back() + v.back() + std::sin(3 * g.back()));
  }
  const std::vector<const double*> all = {v.data(), s.data(), g.data()};
  const std::vector<Input> named = {{"v", "rad/s", Role::velocity, -1, 1, std::nullopt},
                                    {"sgn_v", "-", Role::velocity_sign, -1, 1, 0},
                                    {"g", "N m", Role::gravity_torque, -1, 1, std::nullopt}};
  const Smoother smooth({all, v.size()}, target, RandomStream(32));
  Budget budget({});
  const auto found =
      find_reduction(smooth, named, find_operator_set("paper"), RandomStream(33), budget);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->kind, ReductionKind::additive);
  EXPECT_EQ(found->part, (std::vector<std::size_t>{0, 1}));
}

}  // namespace
}  // namespace tribench::udsr
