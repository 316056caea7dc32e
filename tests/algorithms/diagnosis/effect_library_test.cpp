// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/effect_library.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "problems/kuka/planted.hpp"

namespace tribench::loop {
namespace {

// A campaign of a joint, its angle read as the position of an axis with a stroke of 0.24 m.
Observations linear_axis(std::uint64_t seed) {
  Observations data = observe(kuka::make_planted({}, seed).data);
  for (Signal& signal : data.signals) {
    if (signal.name != "q") continue;
    signal.unit = "m";
    for (double& q : signal.values) q *= 0.06;
  }
  return data;
}

const EffectFamily& family(std::string_view name) {
  return *std::ranges::find(builtin_effects(), name, &EffectFamily::name);
}

std::vector<Atom> atoms_of(std::string_view name, const Observations& data) {
  std::vector<std::string> missing;
  return instantiate(family(name), 0, data, gear_ratios_for(data, {}), missing);
}

TEST(EffectLibrary, ALinearAxisHasRipplesOfItsScrewAndNoneOfAnAngle) {
  const Observations data = linear_axis(1);
  std::set<double> ratios;
  for (const Atom& atom : atoms_of("gear_ripple", data)) ratios.insert(atom.shapes.at(0).value);
  EXPECT_EQ(ratios.size(), 5U);
  EXPECT_EQ(ratios.count(2 * std::numbers::pi / 0.005), 1U);
  EXPECT_TRUE(atoms_of("payload", data).empty());
  EXPECT_TRUE(atoms_of("output_ripple", data).empty());
  EXPECT_EQ(gear_ratios_for(data, std::vector<double>{1000}), std::vector<double>{1000});
}

TEST(EffectLibrary, AJointHasRipplesOfTheUsualGears) {
  const Observations data = observe(kuka::make_planted({}, 1).data);
  const std::vector<double> ratios = gear_ratios_for(data, {});
  EXPECT_EQ(std::ranges::count(ratios, 100.0), 1);
  EXPECT_EQ(std::ranges::count(ratios, 160.0), 1);
  EXPECT_FALSE(atoms_of("output_ripple", data).empty());
}

TEST(EffectLibrary, TheLoopFindsTheRippleOfAScrewWithoutBeingToldItsLead) {
  Observations data = linear_axis(3);
  DiagnosisOptions options;
  EXPECT_EQ(diagnose(data, coulomb_viscous_base, options, 3).verdict, Verdict::none);
  const std::vector<double> q = data.find("q")->values;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    data.target[i] += 0.3 * std::cos(2 * std::numbers::pi * q[i] / 0.01 + 0.7);
  }
  const Diagnosis diagnosis = diagnose(data, coulomb_viscous_base, options, 3);
  ASSERT_EQ(diagnosis.effects.size(), 1U);
  EXPECT_EQ(diagnosis.effects[0].family, "gear_ripple");
  double period = 0;  // 10 mm, whichever lead it is a harmonic of
  for (const ParameterFinding& p : diagnosis.effects[0].parameters) {
    if (p.name != "N") continue;
    const double harmonic = diagnosis.effects[0].atom[4] - '0';  // "cos(2*N*q), ..."
    period = 2 * std::numbers::pi / (harmonic * p.value);
  }
  EXPECT_NEAR(period, 0.01, 1e-12);
}

}  // namespace
}  // namespace tribench::loop
