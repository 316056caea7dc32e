// SPDX-License-Identifier: MIT
//
// Planted memory, simulated by Runge and Kutta's step from the published equations and not by the
// code that fits: stiffness comes back within a tenth, and friction without memory gets none.
#include "algorithms/model_based/dynamic_friction.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "algorithms/model_based/dynamic_models.hpp"
#include "algorithms/states/state_column.hpp"
#include "foundation/random.hpp"
#include "problems/data_problem.hpp"
#include "tests/support/fit.hpp"

namespace tribench {
namespace {

using testing::FitOptions;
using ::testing::HasSubstr;
using testing::run_fit;
using testing::Training;

// A joint that reverses often: two sines, 20 s at 500 Hz.
double velocity_at(double t) { return 0.05 * std::sin(2.4 * t) + 0.03 * std::sin(7.1 * t); }
double acceleration_at(double t) { return 0.12 * std::cos(2.4 * t) + 0.213 * std::cos(7.1 * t); }

struct Planted {
  std::vector<double> z;  // at the start: as many as the law has
  std::function<double(double v, const std::vector<double>& z, std::size_t i)> rate;
  std::function<double(double v, double a, const std::vector<double>& z)> force;
};

Dataset simulate(Planted planted, std::size_t rows, double noise) {
  constexpr double kStep = 0.002;
  constexpr int kSmall = 40;
  Dataset data;
  data.name = "planted";
  data.movement_names = {"one"};
  Channel time{"t", "s", Role::time, {}};
  Channel velocity{"v", "rad/s", Role::velocity, {}};
  Channel acceleration{"a", "rad/s^2", Role::acceleration, {}};
  Channel friction{"tau", "N m", Role::friction_torque, {}};
  RandomStream random(5);
  std::vector<double>& z = planted.z;
  for (std::size_t r = 0; r < rows; ++r) {
    const double t = kStep * static_cast<double>(r);
    const double v = velocity_at(t);
    time.values.push_back(t);
    velocity.values.push_back(v);
    acceleration.values.push_back(acceleration_at(t));
    friction.values.push_back(planted.force(v, acceleration_at(t), z) + noise * random.normal());
    data.movement.push_back(0);
    for (int k = 0; k < kSmall; ++k) {
      const double h = kStep / kSmall;
      const double at = t + k * h;
      std::vector<double> next = z;
      for (std::size_t i = 0; i < z.size(); ++i) {
        std::vector<double> trial = z;
        const double k1 = planted.rate(velocity_at(at), trial, i);
        trial[i] = z[i] + h / 2 * k1;
        const double k2 = planted.rate(velocity_at(at + h / 2), trial, i);
        trial[i] = z[i] + h / 2 * k2;
        const double k3 = planted.rate(velocity_at(at + h / 2), trial, i);
        trial[i] = z[i] + h * k3;
        const double k4 = planted.rate(velocity_at(at + h), trial, i);
        next[i] = z[i] + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      }
      z = next;
    }
  }
  data.channels = {time, velocity, acceleration, friction};
  return data;
}

FitResult fit(const Dataset& data, const std::string& method, const FitOptions& options = {}) {
  const std::vector<std::string> inputs = {"v", "a"};
  const Problem problem = make_data_problem(data, nullptr, "tau", inputs);
  const Training training(problem);
  return run_fit(training.data(), method, options);
}

// The formula's coefficient of a state: its first constant, as the methods write it.
double stiffness_of(const FitResult& result) { return result.front.at(0).node(0).value; }

double rms_left(const Dataset& data, const FitResult& result) {
  const std::vector<std::string> inputs = {"v", "a"};
  const Problem problem = make_data_problem(data, nullptr, "tau", inputs);
  const Training training(problem);
  const TrainingData rows = training.data();
  std::vector<std::vector<double>> states;
  std::vector<const double*> columns(rows.columns.begin(), rows.columns.end());
  for (const StateDeclaration& state : result.states) {
    states.emplace_back(rows.rows());
    state_column(state, rows.motion, states.back());
    columns.push_back(states.back().data());
  }
  std::vector<double> values(rows.rows());
  Evaluator().evaluate(result.front.at(0), {columns, rows.rows()}, values);
  double sum = 0;
  for (std::size_t r = 0; r < values.size(); ++r) {
    sum += (values[r] - rows.target[r]) * (values[r] - rows.target[r]);
  }
  return std::sqrt(sum / static_cast<double>(values.size()));
}

Planted dahl(double stiffness, double coulomb) {
  return {{0},
          [=](double v, const std::vector<double>& z, std::size_t) {
            return v - stiffness / coulomb * std::abs(v) * z[0];
          },
          [=](double v, double a, const std::vector<double>& z) {
            return stiffness * z[0] + 6 * v + 0.8 * a + 0.3;
          }};
}

Planted lugre(double stiffness, double damping) {
  const auto rate = [=](double v, double z) {
    const double g = 4 + 2 * std::exp(-(v / 0.01) * (v / 0.01));
    return v - stiffness * std::abs(v) * z / g;
  };
  return {{0},
          [=](double v, const std::vector<double>& z, std::size_t) { return rate(v, z[0]); },
          [=](double v, double a, const std::vector<double>& z) {
            return stiffness * z[0] + damping * rate(v, z[0]) + 10 * v + 0.8 * a;
          }};
}

TEST(DynamicFriction, FindsThePlantedStiffnessOfDahl) {
  for (const double stiffness : {1000.0, 5000.0}) {
    const Dataset data = simulate(dahl(stiffness, 4), 5000, 0.1);
    const FitResult result = fit(data, "dahl");
    EXPECT_NEAR(stiffness_of(result), stiffness, 0.1 * stiffness);
    EXPECT_NEAR(stiffness_of(result) * result.states.at(0).parameters[0], 4, 0.1);
    EXPECT_LT(rms_left(data, result), 0.105);
  }
}

TEST(DynamicFriction, FindsThePlantedStiffnessOfLuGre) {
  for (const double stiffness : {2000.0, 8000.0}) {
    const Dataset data = simulate(lugre(stiffness, 20), 5000, 0.1);
    const FitResult result = fit(data, "lugre");
    EXPECT_NEAR(stiffness_of(result), stiffness, 0.1 * stiffness);
    const std::vector<double>& p = result.states.at(0).parameters;
    EXPECT_NEAR(stiffness_of(result) * p[0], 4, 0.2);
    EXPECT_NEAR(stiffness_of(result) * p[1], 6, 0.5);
    EXPECT_NEAR(p[2], 0.01, 0.002);
    EXPECT_LT(rms_left(data, result), 0.105);
  }
}

// Four elements with limits that grow by 2.2: what the joint feels at rest is their sum.
TEST(DynamicFriction, FindsThePlantedStiffnessOfMaxwellSlip) {
  Planted planted;
  planted.z.assign(4, 0);
  const std::vector<double> stiffness = {2000, 1200, 600, 300};
  const double attraction = 0.01;
  const auto limit = [](std::size_t i) { return 4e-4 * std::pow(2.2, static_cast<double>(i)); };
  planted.rate = [=](double v, const std::vector<double>& z, std::size_t i) {
    const double level = limit(i) * (1 + 0.3 * std::exp(-(v / 0.02) * (v / 0.02)));
    const double s = v > 0 ? 1 : -1;
    if (z[i] * s < level) return v;
    return s * limit(i) / attraction * (1 - z[i] * s / level);
  };
  planted.force = [=](double v, double a, const std::vector<double>& z) {
    double sum = 6 * v + 0.8 * a;
    for (std::size_t i = 0; i < 4; ++i) sum += stiffness[i] * z[i];
    return sum;
  };
  const Dataset data = simulate(planted, 5000, 0.05);
  const FitResult result = fit(data, "maxwell_slip");
  ASSERT_EQ(result.states.size(), 4U);
  // Where all stick; an element that the rows do not need has no term.
  double sum = 0;
  const Expression& formula = result.front.at(0);
  for (std::size_t i = 0; i + 2 < formula.size(); ++i) {
    const bool is_term = formula.node(i).is_constant() && formula.node(i + 1).is_variable() &&
                         formula.node(i + 1).variable >= 2 && formula.node(i + 2).op == Op::mul;
    if (is_term) sum += formula.node(i).value;
  }
  EXPECT_NEAR(sum, 4100, 410);
  EXPECT_LT(rms_left(data, result), 0.06);
}

// Presliding that is not there is found shorter than what the joint travels in a step or two.
TEST(DynamicFriction, FrictionWithoutMemoryGetsNone) {
  Planted planted;
  planted.z = {0};
  planted.rate = [](double, const std::vector<double>&, std::size_t) { return 0.0; };
  planted.force = [](double v, double a, const std::vector<double>&) {
    return (v > 0 ? 4 : v < 0 ? -4 : 0) + 6 * v + 0.8 * a;
  };
  const Dataset data = simulate(planted, 5000, 0.1);
  const FitResult result = fit(data, "dahl");
  EXPECT_LT(result.states.at(0).parameters[0], 2 * 0.002 * 0.04);
}

// What Levenberg-Marquardt walks by: each feature's slope against a difference quotient.
TEST(DynamicFriction, SlopesOfItsFeaturesAreExact) {
  Dataset data = simulate(dahl(2000, 4), 800, 0.1);
  data.channels[2].role = Role::gravity_torque;  // any second column will do
  const std::vector<std::string> names = {"v", "a"};
  const Problem problem = make_data_problem(data, nullptr, "tau", names);
  const Training training(problem);
  const TrainingData rows = training.data();
  std::vector<std::size_t> used;
  for (std::size_t r = 0; r < rows.rows(); r += 2) used.push_back(r);
  for (const DynamicModel model :
       {DynamicModel::dahl, DynamicModel::lugre, DynamicModel::maxwell_slip}) {
    Budget budget({});
    DynamicFeatures features(model, {true, true, true}, *find_friction_inputs(rows.inputs), rows,
                             used, budget);
    std::vector<double> theta = {std::log(1e-3), 1.5, std::log(0.02), 0.7, std::log(0.01)};
    theta.resize(features.parameters());
    const std::size_t size = features.features() * features.rows();
    std::vector<double> slopes(features.parameters() * size);
    ASSERT_TRUE(features.differentiate(theta, slopes));
    for (std::size_t j = 0; j < theta.size(); ++j) {
      std::vector<double> up(size);
      std::vector<double> down(size);
      std::vector<double> moved = theta;
      moved[j] = theta[j] + 1e-6;
      ASSERT_TRUE(features.evaluate(moved, up));
      moved[j] = theta[j] - 1e-6;
      ASSERT_TRUE(features.evaluate(moved, down));
      for (std::size_t k = 0; k < features.features(); ++k) {
        double largest = 0;
        std::size_t off = 0;
        for (std::size_t r = 0; r < used.size(); ++r) {
          largest = std::max(largest, std::abs(slopes[j * size + k * used.size() + r]));
        }
        for (std::size_t r = 0; r < used.size(); ++r) {
          const std::size_t place = k * used.size() + r;
          const double slope = (up[place] - down[place]) / 2e-6;
          off += std::abs(slope - slopes[j * size + place]) > 1e-4 * largest + 1e-12 ? 1U : 0U;
        }
        // An element that lets go between the two points has no slope there.
        EXPECT_LE(off, used.size() / 50)
            << static_cast<int>(model) << " theta " << j << " feature " << k;
      }
    }
  }
}

TEST(DynamicFriction, SaysWhatIsMissing) {
  Dataset data = simulate(dahl(1000, 4), 200, 0.1);
  data.channels[0].role = Role::none;
  const FitResult without_time = fit(data, "lugre");
  EXPECT_EQ(without_time.reason, StopReason::unsupported);
  EXPECT_THAT(without_time.note, HasSubstr("time"));
  data.channels[0].role = Role::time;
  data.channels[1].role = Role::none;
  const FitResult without_velocity = fit(data, "dahl");
  EXPECT_EQ(without_velocity.reason, StopReason::unsupported);
  EXPECT_THAT(without_velocity.note, HasSubstr("velocity"));
}

TEST(DynamicFriction, ALuGreFitOfTenThousandRowsTakesLessThanASecond) {
  const Dataset data = simulate(lugre(4000, 20), 10000, 0.1);
  const double start = process_cpu_seconds();
  fit(data, "lugre");
  // Seen: a quarter of it; a debug or a sanitizer build has no such limit.
#if defined(NDEBUG) && !defined(TRIBENCH_SANITIZED)
  EXPECT_LT(process_cpu_seconds() - start, 1.0);
#else
  EXPECT_LT(process_cpu_seconds() - start, 60.0);
#endif
}

}  // namespace
}  // namespace tribench
