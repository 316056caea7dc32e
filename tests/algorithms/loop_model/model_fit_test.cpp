// SPDX-License-Identifier: MIT
#include "algorithms/loop_model/model_fit.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "algorithms/expression/text.hpp"
#include "tests/algorithms/diagnosis/half_sines.hpp"

namespace tribench::loop {
namespace {

// Every presliding of the library in one column, however many lengths its grid has.
std::vector<Atom> presliding_atoms(const Observations& data) {
  const std::vector<EffectFamily>& library = builtin_effects();
  const auto family = std::ranges::find(library, "hysteresis", &EffectFamily::name);
  const auto number = static_cast<std::size_t>(family - library.begin());
  std::vector<std::string> missing;
  std::vector<Atom> atoms = instantiate(*family, number, data, {}, missing);
  std::erase_if(atoms, [&](const Atom& atom) {
    return atom.coefficients != atoms[0].coefficients ||
           atom.columns.size() != atoms[0].columns.size();
  });
  return atoms;
}

// The difference of two lengths that come together is a derivative: it comes nearest to this
// friction, which is greatest some way after a reversal, with 4 500 N m on either side.
TEST(ModelFit, TwoEffectsOfOneKindDoNotBecomeOne) {
  Observations data =
      half_sines_over({.movements = 12, .rows = 200, .seed = 7}, [](double) { return 0; });
  const std::vector<double>& v = data.find("v")->values;
  const std::vector<double>& d = data.find("d")->values;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    const double way = d[i] / 0.1;
    data.target[i] -= std::copysign(6 * way * way * way * std::exp(-way), v[i]);
  }
  const std::vector<Atom> atoms = presliding_atoms(data);
  ASSERT_GE(atoms.size(), 2U);
  LoopModel model{coulomb_viscous_base(data), {}, {}};
  model.coefficients =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model.base.linear_terms.size()));
  model.add(atoms.front());
  model.add(atoms.back());
  Noise noise;
  noise.within_sd = kHalfSinesNoise;
  fit_model(model, data, make_clusters(data.movement, 1), noise, FitScope::everything);
  const double ratio = model.atoms[0].shapes[0].value / model.atoms[1].shapes[0].value;
  EXPECT_GE(std::max(ratio, 1 / ratio), 1.5);
  EXPECT_LT(model.coefficients.cwiseAbs().maxCoeff(), 20);
}

// A constant at its bound, as Fc = 0 is: its first step must not be one of a unit of ours.
TEST(ModelFit, AConstantAtZeroIsFittedTheSameInAnotherUnit) {
  constexpr double kUnit = 1024;
  Observations data =
      half_sines_over({.movements = 12, .rows = 200, .seed = 7}, [](double) { return 0; });
  const std::vector<double>& v = data.find("v")->values;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    data.target[i] -= std::copysign(0.3 - 2 * std::exp(-std::abs(v[i]) / 0.4), v[i]);
  }
  const auto fitted = [](const Observations& rows, double unit) {
    LoopModel model{
        formula_base(rows, fmt::format("sgn_v*(0 + {}*exp(-abs(v/0.3)))", unit)), {}, {}};
    model.coefficients =
        Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model.base.linear_terms.size()));
    Noise noise;
    noise.within_sd = kHalfSinesNoise * unit;
    fit_model(model, rows, make_clusters(rows.movement, 1), noise, FitScope::everything);
    return predict(model, rows);
  };
  const Eigen::VectorXd once = fitted(data, 1);
  for (double& y : data.target) y *= kUnit;
  EXPECT_EQ(fitted(data, kUnit), kUnit * once);
}

TEST(ModelFit, WhatHasAConstantOfItsOwnIsLinear) {
  const Observations data =
      half_sines_over({.movements = 12, .rows = 200, .seed = 7}, [](double) { return 0; });
  BaseModel base;
  const Expression formula =
      parse("2*v - 4*sgn_v - sgn_v*(5 + 3*exp(-abs(v/0.2)^1.5)) + 6*v", data.names());
  const std::vector<ConstantRange> ranges = {{0, 9}, {1, 9}, {2, 9}, {3, 9},
                                             {4, 9}, {5, 9}, {6, 9}};
  add_formula(base, formula, ranges);
  ASSERT_EQ(base.linear_terms.size(), 2U);  // v once
  EXPECT_EQ(print(base.linear_terms[0], data.names()), "v");
  EXPECT_EQ(print(base.linear_terms[1], data.names()), "sgn_v");
  EXPECT_EQ(print(base.formula, data.names()), "-(sgn_v*(5 + 3*exp(-abs(v/0.2)^1.5)))");
  ASSERT_EQ(base.ranges.size(), 4U);
  EXPECT_EQ(base.ranges.front().low, 2);
  EXPECT_EQ(base.ranges.back().low, 5);
}

// As Fc >= 0 of a joint whose friction falls and falls. The others reckon with what is held.
TEST(ModelFit, ABasesConstantsKeepTheirRanges) {
  Observations data =
      half_sines_over({.movements = 12, .rows = 200, .seed = 7}, [](double) { return 0; });
  const std::vector<double>& v = data.find("v")->values;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    data.target[i] =
        std::copysign(1, v[i]) * (3 * std::exp(-std::pow(std::abs(v[i]) / 0.9, 1.2)) - 1);
  }
  const auto fitted = [&data](double start, const ConstantRange& coulomb) {
    const std::string text = fmt::format("0.5*sgn_v*({} + exp(-abs(v/0.3)^1.5)*1)*2", start);
    const std::vector<ConstantRange> ranges = {{0.5, 0.5}, coulomb, {0.01, 0.5},
                                               {0.6, 4},   {0, 99}, {2, 2}};
    LoopModel model;
    add_formula(model.base, parse(text, data.names()), ranges);
    Noise noise;
    noise.within_sd = kHalfSinesNoise;
    fit_model(model, data, make_clusters(data.movement, 1), noise, FitScope::everything);
    return model;
  };
  const LoopModel free = fitted(0.2, {-99, 99});
  const LoopModel bounded = fitted(0.2, {0, 99});
  const auto constant = [](const LoopModel& model, std::size_t k) {
    return model.base.formula.node(constant_positions(model.base.formula)[k]).value;
  };
  EXPECT_LT(constant(free, 1), -0.1);
  EXPECT_EQ(constant(bounded, 1), 0);
  EXPECT_EQ(constant(bounded, 0), 0.5);
  EXPECT_EQ(constant(bounded, 5), 2);
  EXPECT_LE(constant(bounded, 2), 0.5);
  const LoopModel held = fitted(0, {0, 0});
  const auto miss = [&data](const LoopModel& model) {
    return (target_vector(data) - predict(model, data)).squaredNorm();
  };
  EXPECT_GT(miss(bounded), miss(free));
  EXPECT_NEAR(miss(bounded), miss(held), 1e-3 * miss(held));
}

}  // namespace
}  // namespace tribench::loop
