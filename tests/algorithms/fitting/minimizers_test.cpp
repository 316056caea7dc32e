// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <numbers>
#include <thread>

#include "algorithms/fitting/basin_hopping.hpp"
#include "algorithms/fitting/bfgs.hpp"
#include "algorithms/fitting/ipopt_minimizer.hpp"
#include "algorithms/fitting/nlopt_minimizer.hpp"
#include "foundation/error.hpp"

namespace tribench {
namespace {

constexpr double kTau = 2 * std::numbers::pi;

double rosenbrock(std::span<const double> x, std::span<double> gradient) {
  const double a = 1 - x[0];
  const double b = x[1] - x[0] * x[0];
  if (!gradient.empty()) {
    gradient[0] = -2 * a - 400 * x[0] * b;
    gradient[1] = 200 * b;
  }
  return a * a + 100 * b * b;
}

double rastrigin(std::span<const double> x, std::span<double> gradient) {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sum += x[i] * x[i] + 10 * (1 - std::cos(kTau * x[i]));
    if (!gradient.empty()) gradient[i] = 2 * x[i] + 10 * kTau * std::sin(kTau * x[i]);
  }
  return sum;
}

// Minimum 0 at the origin, in a slope covered with shallow basins.
double ackley(std::span<const double> x, std::span<double> gradient) {
  const auto n = static_cast<double>(x.size());
  double squares = 1e-300;
  double cosines = 0;
  for (double value : x) {
    squares += value * value / n;
    cosines += std::cos(kTau * value) / n;
  }
  const double root = std::sqrt(squares);
  const double bowl = -20 * std::exp(-0.2 * root);
  const double ripple = -std::exp(cosines);
  for (std::size_t i = 0; i < gradient.size(); ++i) {
    gradient[i] = -0.2 * bowl * x[i] / (n * root) - ripple * kTau * std::sin(kTau * x[i]) / n;
  }
  return bowl + ripple + 20 + std::numbers::e;
}

LocalMinimizer lbfgs(const Objective& objective) {
  return [objective](std::span<const double> start) {
    return minimize_nlopt(NloptMethod::lbfgs, objective, start);
  };
}

TEST(Nlopt, LocalMethodsSolveRosenbrock) {
  for (NloptMethod method :
       {NloptMethod::lbfgs, NloptMethod::slsqp, NloptMethod::truncated_newton}) {
    const std::vector<double> start = {-1.2, 1};
    const Minimum minimum = minimize_nlopt(method, rosenbrock, start);
    EXPECT_NEAR(minimum.x[0], 1, 1e-4) << nlopt_method_name(method);
    EXPECT_GT(minimum.evaluations, 5U);
  }
}

TEST(Bfgs, SolvesRosenbrockFromTheClassicalStartAndSaysSo) {
  const std::vector<double> start = {-1.2, 1};
  const Minimum minimum = minimize_bfgs(rosenbrock, start);
  EXPECT_EQ(minimum.status, MinimizeStatus::converged);
  EXPECT_NEAR(minimum.x[0], 1, 1e-5);
  EXPECT_NEAR(minimum.x[1], 1, 1e-5);
  EXPECT_LT(minimum.evaluations, 60U);
}

TEST(Bfgs, EndsAQuadraticAfterAsManyStepsAsDimensions) {
  // Exact line searches would need 5; a Wolfe search a few more.
  const Objective bowl = [](std::span<const double> x, std::span<double> gradient) {
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double weight = std::pow(10.0, static_cast<double>(i));
      sum += weight * x[i] * x[i];
      if (!gradient.empty()) gradient[i] = 2 * weight * x[i];
    }
    return sum;
  };
  const std::vector<double> start = {1, 1, 1, 1, 1};
  const Minimum minimum = minimize_bfgs(bowl, start);
  EXPECT_EQ(minimum.status, MinimizeStatus::converged);
  EXPECT_LT(minimum.value, 1e-10);
  EXPECT_LT(minimum.evaluations, 60U);
}

TEST(Bfgs, ReportsAKinkALimitAndAStartThatIsNotFinite) {
  const Objective kink = [](std::span<const double> x, std::span<double> gradient) {
    if (!gradient.empty()) gradient[0] = x[0] > 0 ? 1 : -1;
    return std::abs(x[0]);
  };
  const std::vector<double> one = {1.3};
  const Minimum at_kink = minimize_bfgs(kink, one);
  EXPECT_EQ(at_kink.status, MinimizeStatus::failed);
  EXPECT_LE(at_kink.value, 1.3);
  const std::vector<double> start = {-1.2, 1};
  EXPECT_EQ(minimize_bfgs(rosenbrock, start, {.max_iterations = 3}).status, MinimizeStatus::limit);
  const bool stop = true;
  EXPECT_EQ(minimize_bfgs(rosenbrock, start, {.stop = &stop}).status, MinimizeStatus::limit);
  const Objective nowhere = [](std::span<const double>, std::span<double>) { return NAN; };
  EXPECT_EQ(minimize_bfgs(nowhere, start).status, MinimizeStatus::failed);
}

TEST(Nlopt, GlobalMethodsFindTheGlobalMinimumAndRepeatIt) {
  const Bounds box{{-3.1, -4.2}, {5.3, 4.9}};
  const std::vector<double> start = {4.3, -3.7};
  for (NloptMethod method : {NloptMethod::mlsl, NloptMethod::crs2, NloptMethod::isres,
                             NloptMethod::direct_l, NloptMethod::esch}) {
    const bool evolves = method == NloptMethod::isres || method == NloptMethod::esch;
    const MinimizeOptions options{.max_evaluations = evolves ? 30000U : 4000U, .seed = 7};
    const Minimum minimum = minimize_nlopt(method, rastrigin, start, box, options);
    EXPECT_LT(minimum.value, evolves ? 0.1 : 1e-3) << nlopt_method_name(method);
    EXPECT_EQ(minimum.x, minimize_nlopt(method, rastrigin, start, box, options).x);
  }
}

TEST(Nlopt, GlobalMethodsSayThatTheyNeedBounds) {
  const std::vector<double> start = {1, 1};
  EXPECT_THROW(minimize_nlopt(NloptMethod::crs2, rosenbrock, start), Error);
}

TEST(Nlopt, StopsWhenTold) {
  bool stop = false;
  int calls = 0;
  const Objective objective = [&](std::span<const double> x, std::span<double> gradient) {
    stop = ++calls >= 3;
    return rosenbrock(x, gradient);
  };
  MinimizeOptions options;
  options.stop = &stop;
  const std::vector<double> start = {-1.2, 1};
  EXPECT_EQ(minimize_nlopt(NloptMethod::lbfgs, objective, start, {}, options).status,
            MinimizeStatus::limit);
  EXPECT_EQ(calls, 3);
}

TEST(Ipopt, SolvesRosenbrockWithinBounds) {
  const std::vector<double> start = {-1.2, 1};
  EXPECT_NEAR(minimize_ipopt(rosenbrock, start).x[0], 1, 1e-5);
  // Bound x0 <= 0.5: the minimum lies on it, at x1 = 0.25.
  const Minimum bounded = minimize_ipopt(rosenbrock, start, {{-2, -2}, {0.5, 2}});
  EXPECT_NEAR(bounded.x[0], 0.5, 1e-6);
  EXPECT_NEAR(bounded.x[1], 0.25, 1e-5);
}

TEST(Ipopt, KeepsToANonlinearConstraint) {
  // Least x + y on the circle of radius sqrt(2): (-1, -1).
  const Objective sum = [](std::span<const double> x, std::span<double> gradient) {
    for (double& g : gradient) g = 1;
    return x[0] + x[1];
  };
  const Constraints circle{
      {-1e300},
      {2},
      [](std::span<const double> x, std::span<double> values, std::span<double> jacobian) {
        values[0] = x[0] * x[0] + x[1] * x[1];
        for (std::size_t i = 0; i < jacobian.size(); ++i) jacobian[i] = 2 * x[i];
      }};
  const std::vector<double> start = {0.3, 0.8};
  const Minimum minimum = minimize_ipopt(sum, start, {}, circle);
  EXPECT_NEAR(minimum.x[0], -1, 1e-4);
  EXPECT_NEAR(minimum.x[1], -1, 1e-4);
  EXPECT_LE(minimum.x[0] * minimum.x[0] + minimum.x[1] * minimum.x[1], 2 + 1e-8);
}

TEST(Ipopt, SolvesInSeveralThreadsOneAfterTheOther) {
  std::atomic<int> solved = 0;
  std::vector<std::jthread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&solved] {
      for (int i = 0; i < 5; ++i) {
        const std::vector<double> start = {-1.2, 1};
        if (minimize_ipopt(rosenbrock, start).value < 1e-8) ++solved;
      }
    });
  }
  threads.clear();
  EXPECT_EQ(solved, 20);
}

TEST(BasinHopping, FindsTheBottomOfRastriginAndAckley) {
  int rastrigin_solved = 0;
  int ackley_solved = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const std::vector<double> start = {2.9, -1.9};
    BasinHoppingOptions options;
    options.iterations = 200;
    options.step = 1.2;
    const RandomStream random(seed);
    if (basin_hopping(lbfgs(rastrigin), start, options, random).value < 1e-8) ++rastrigin_solved;
    if (basin_hopping(lbfgs(ackley), start, options, random).value < 1e-4) ++ackley_solved;
  }
  EXPECT_GE(rastrigin_solved, 9);
  EXPECT_GE(ackley_solved, 9);
}

// A local minimiser that moves nowhere and says whether it succeeded: the rules by themselves.
Minimum still(std::span<const double> x, double value, MinimizeStatus status) {
  return {{x.begin(), x.end()}, value, status, 1};
}

TEST(BasinHopping, SciPysRuleDropsImprovementsWithoutSuccess) {
  int calls = 0;
  const LocalMinimizer falling = [&](std::span<const double> x) {
    ++calls;
    return still(x, -calls, calls == 1 ? MinimizeStatus::converged : MinimizeStatus::failed);
  };
  const std::vector<double> start = {0};
  BasinHoppingOptions options;
  options.iterations = 5;
  options.best_rule = BestRule::scipy;
  EXPECT_EQ(basin_hopping(falling, start, options, RandomStream(1)).value, -1);
  calls = 0;
  options.best_rule = BestRule::by_value;
  EXPECT_EQ(basin_hopping(falling, start, options, RandomStream(1)).value, -6);
}

TEST(BasinHopping, AdaptsTheStepEveryFiftyIterations) {
  // Everything is accepted, so the step must grow by 1 / 0.9 at iterations 50 and 100.
  std::vector<double> places;
  const LocalMinimizer flat = [&](std::span<const double> x) {
    places.push_back(x[0]);
    return still(x, 0, MinimizeStatus::converged);
  };
  const std::vector<double> start = {0};
  BasinHoppingOptions options;
  options.iterations = 149;
  basin_hopping(flat, start, options, RandomStream(4));
  double largest[3] = {};
  for (std::size_t i = 1; i < places.size(); ++i) {
    const double moved = std::abs(places[i] - places[i - 1]);
    largest[i / 50] = std::max(largest[i / 50], moved);
  }
  EXPECT_LE(largest[0], 0.5);
  EXPECT_GT(largest[1], 0.5);
  EXPECT_LE(largest[1], 0.5 / 0.9);
  EXPECT_GT(largest[2], 0.5 / 0.9);
  EXPECT_LE(largest[2], 0.5 / 0.81);
}

}  // namespace
}  // namespace tribench
