// SPDX-License-Identifier: MIT
#include "algorithms/effects/effect_library.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "foundation/error.hpp"
#include "problems/kuka/planted.hpp"
#include "tests/support/paths.hpp"

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

// Where a joint moves one way alone, what is there in one direction is the whole effect.
TEST(EffectLibrary, AnEffectOfOneDirectionNeedsMotionBothWays) {
  Observations data = observe(kuka::make_planted({}, 1).data);
  EXPECT_EQ(std::ranges::count(atoms_of("stribeck", data), true, &Atom::one_way), 16);
  for (Signal& signal : data.signals) {
    if (signal.name != "v" && signal.name != "sgn_v") continue;
    for (double& v : signal.values) v = std::abs(v);
  }
  EXPECT_EQ(std::ranges::count(atoms_of("stribeck", data), true, &Atom::one_way), 0);
}

// The viscous part of late friction is next to an inertia: where one is fitted it has no room.
TEST(EffectLibrary, LateFrictionHasAViscousPartWhereNoInertiaIsFitted) {
  Observations data = observe(kuka::make_planted({}, 1).data);
  const auto with_viscous = [&data] {
    return std::ranges::count_if(atoms_of("lag", data), [](const Atom& atom) {
      return std::ranges::count(atom.coefficients, "late_viscous") > 0;
    });
  };
  EXPECT_EQ(with_viscous(), 15);
  data.rigid = {"a"};
  EXPECT_EQ(with_viscous(), 0);
}

// Whether the rigid body is in the recording's torque or was taken off before.
TEST(EffectLibrary, TheLoadHoldsTheInertiaBehindTheGear) {
  Observations data = observe(kuka::make_planted({}, 1).data);
  const auto with_inertia = [&] {
    return std::ranges::count_if(atoms_of("load_coulomb", data), [](const Atom& atom) {
      return atom.label == "sgn_v*abs(g + J*a)";
    });
  };
  for (const std::vector<std::string>& rigid :
       {std::vector<std::string>{}, {"g", "a"}, {"sin_q", "cos_q", "a"}}) {
    data.rigid = rigid;
    EXPECT_GT(with_inertia(), 0) << rigid.size();
  }
  std::erase_if(data.signals, [](const Signal& signal) { return signal.name == "a"; });
  EXPECT_EQ(with_inertia(), 0) << "no acceleration";
}

TEST(EffectLibrary, TheLoopFindsTheRippleOfAScrewWithoutBeingToldItsLead) {
  Observations data = linear_axis(3);
  DiagnosisOptions options;
  EXPECT_EQ(diagnose(data, coulomb_viscous_base, options).verdict, Verdict::none);
  const std::vector<double> q = data.find("q")->values;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    data.target[i] += 0.3 * std::cos(2 * std::numbers::pi * q[i] / 0.01 + 0.7);
  }
  const Diagnosis diagnosis = diagnose(data, coulomb_viscous_base, options);
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

// A pump, a cable, another joint: what swings in time shakes the joint a little, and the sign of
// that little acceleration is the sign of what swings.
TEST(EffectLibrary, ADisturbanceThatShakesTheJointIsNoLateFriction) {
  Observations data = observe(kuka::make_planted({}, 7).data);
  const std::vector<double> t = data.find("t")->values;
  const double scale = signal_scale(data, "a");
  for (Signal& signal : data.signals) {
    if (signal.name != "a") continue;
    for (std::size_t i = 0; i < data.rows(); ++i) {
      double& a = signal.values[i];
      const double swing = std::sin(2 * std::numbers::pi * 1.37 * t[i]);
      a = (std::abs(a) < 0.3 * scale ? 0 : a) + 0.01 * scale * swing;
      data.target[i] += 0.3 * swing;
    }
  }
  const Diagnosis diagnosis = diagnose(data, coulomb_viscous_base, {});
  for (const EffectFinding& effect : diagnosis.effects) EXPECT_NE(effect.family, "lag");
}

bool same(const AtomTemplate& a, const AtomTemplate& b) {
  const auto same_shape = [](const ShapeTemplate& x, const ShapeTemplate& y) {
    return x.name == y.name && x.scale == y.scale && x.grid == y.grid && x.low == y.low &&
           x.high == y.high && x.recorded == y.recorded && x.reference == y.reference &&
           x.values == y.values;
  };
  return a.columns == b.columns && a.coefficients == b.coefficients &&
         a.beside_another == b.beside_another && a.by_direction == b.by_direction &&
         a.one_way == b.one_way && a.last_resort == b.last_resort &&
         a.without_inertia == b.without_inertia && a.curve == b.curve &&
         std::ranges::equal(a.shapes, b.shapes, same_shape);
}

bool same(const EffectFamily& a, const EffectFamily& b) {
  const auto same_sanity = [](const Sanity& x, const Sanity& y) {
    return x.coefficient == y.coefficient && x.sign == y.sign && x.largest == y.largest &&
           x.why == y.why;
  };
  const auto same_alias = [](const KnownAlias& x, const KnownAlias& y) {
    return x.name == y.name && x.separate_by == y.separate_by && x.coefficient == y.coefficient &&
           x.unless_known == y.unless_known;
  };
  const auto same_atom = [](const AtomTemplate& x, const AtomTemplate& y) { return same(x, y); };
  return a.name == b.name && a.id == b.id && a.summary == b.summary && a.phrase == b.phrase &&
         a.source == b.source && a.angular == b.angular && a.changeable == b.changeable &&
         a.separate_by == b.separate_by && std::ranges::equal(a.atoms, b.atoms, same_atom) &&
         std::ranges::equal(a.sanity, b.sanity, same_sanity) &&
         std::ranges::equal(a.known_aliases, b.known_aliases, same_alias);
}

TEST(EffectFile, HoldsAllThatABuiltInEffectHas) {
  const std::filesystem::path file = testing::scratch_folder() / "tribench_effects.toml";
  std::ofstream(file) << write_effects(builtin_effects());
  const std::vector<EffectFamily> read = read_effects(file);
  ASSERT_EQ(read.size(), builtin_effects().size());
  for (std::size_t f = 0; f < read.size(); ++f) {
    EXPECT_TRUE(same(read[f], builtin_effects()[f])) << read[f].name;
  }
}

// What a shape is called says nothing of where its values come from.
TEST(EffectFile, AShapeIsTheGearRatioBecauseItSaysSoWhateverItsName) {
  const std::filesystem::path file = testing::scratch_folder() / "tribench_gear_shapes.toml";
  std::ofstream(file)
      << "[[effect]]\nname = 'x'\nphrase = 'y'\ncolumns = ['exp(-abs(v)/N)']\n"
         "shape = [{name = 'N', scale = 'v', grid = [0.5, 2.0], low = 0.1, high = 3}]\n"
         "[[effect]]\nname = 'z'\nphrase = 'y'\ncolumns = ['cos(ratio*q)']\n"
         "shape = [{name = 'ratio', gear_ratio = true}]\n";
  const std::vector<EffectFamily> read = read_effects(file);
  ASSERT_EQ(read.size(), 2U);
  const Observations data = observe(kuka::make_planted({}, 1).data);
  const std::vector<double> ratios = {30, 70, 90};
  std::vector<std::string> missing;
  const std::vector<Atom> curves = instantiate(read[0], 0, data, ratios, missing);
  ASSERT_EQ(curves.size(), 2U);
  EXPECT_EQ(curves[1].shapes[0].value, 2 * signal_scale(data, "v"));
  EXPECT_TRUE(curves[1].shapes[0].refined());
  const std::vector<Atom> ripples = instantiate(read[1], 1, data, ratios, missing);
  ASSERT_EQ(ripples.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(ripples[k].shapes[0].value, ratios[k]);
    EXPECT_FALSE(ripples[k].shapes[0].refined());
  }
  EXPECT_EQ(write_effects(read).find("grid = []"), std::string::npos);
}

TEST(EffectFile, SaysWhereAnEffectIsIncomplete) {
  const std::filesystem::path file = testing::scratch_folder() / "tribench_bad_effects.toml";
  const auto complaint = [&](const std::string& text) {
    std::ofstream(file) << text;
    try {
      read_effects(file);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  const std::string head = "[[effect]]\nname = \"x\"\nphrase = \"y\"\n";
  EXPECT_NE(complaint(head).find("no columns"), std::string::npos);
  EXPECT_NE(complaint(head + "columns = [\"v^2\"]\ncoefficients = [\"a\", \"b\"]\n")
                .find("as many coefficients"),
            std::string::npos);
  EXPECT_NE(complaint(head + "columns = [\"exp(-d/l)\"]\nshape = [{name = \"l\"}]\n")
                .find("'l' has no grid"),
            std::string::npos);
}

// What a file says is used or refused, with the line.
TEST(EffectFile, RefusesWhatItDoesNotKnow) {
  const std::filesystem::path file = testing::scratch_folder() / "tribench_strict_effects.toml";
  const std::string head = "[[effect]]\nname = \"x\"\nphrase = \"y\"\n";
  const auto complaint = [&](const std::string& text) {
    std::ofstream(file) << head << text;
    try {
      read_effects(file);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
      EXPECT_NE(error.place().find("tribench_strict_effects.toml"), std::string::npos);
      return fmt::format("{} | {}", error.what(), error.mend());
    }
    return std::string("none");
  };
  const std::string columns = "columns = [\"v^2\"]\n";
  const std::string shaped = "columns = [\"exp(-d/l)\"]\n";
  EXPECT_EQ(complaint(columns), "none");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {columns + "colunms = [\"v\"]\n", "did you mean columns"},
      {columns + "sumary = 'z'\n", "did you mean summary"},
      {columns + "summary = 3\n", "'summary' is no text"},
      {columns + "angular = 1\n", "'angular' is no true or false"},
      {"columns = \"v^2\"\n", "'columns' is no list"},
      {"columns = [1]\n", "'columns' is no text"},
      {shaped + "shape = [{name = 'l', grid = ['a']}]\n", "'grid' is no finite number"},
      {shaped + "shape = [{name = 'l', grid = [nan]}]\n", "'grid' is no finite number"},
      {shaped + "shape = [{name = 'l', grid = [1.0], hihg = 2}]\n", "did you mean high"},
      {shaped + "shape = [{name = 'l', grid = [1.0], low = 2, high = 1}]\n", "above high"},
      {shaped + "shape = {name = 'l', grid = [1.0]}\n", "'shape' is no list"},
      {shaped + "shape = [{name = 'k', grid = [1.0]}]\n", "no column holds the shape 'k'"},
      {"columns = ['cos(N*q)']\nshape = [{name = 'N', grid = []}]\n", "gear_ratio = true"},
      {"columns = ['cos(N*q)']\nshape = [{name = 'N', gear_ratio = 1}]\n",
       "'gear_ratio' is no true or false"},
      {"columns = ['cos(N*q)']\nshape = [{name = 'N', gear_ratio = true, grid = [7.0]}]\n",
       "is the gear ratio"},
      {columns + "sanity = [{coefficient = 'c1', sign = 2}]\n", "'sign' is 2"},
      {columns + "curve = 'up'\n", "'curve' is 'up'"},
      {columns + "[[efect]]\nname = 'z'\n", "did you mean effect"}};
  for (const auto& [text, wanted] : cases) {
    EXPECT_NE(complaint(text).find(wanted), std::string::npos) << text << complaint(text);
  }
}

// What would be tested and found nowhere: it names what is not there, or says nothing.
TEST(EffectFile, RefusesWhatMeansNothing) {
  const std::filesystem::path file = testing::scratch_folder() / "tribench_idle_effects.toml";
  const auto complaint = [&](const std::string& text) {
    std::ofstream(file) << text;
    try {
      read_effects(file);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
      return fmt::format("{} | {}", error.what(), error.mend());
    }
    return std::string("none");
  };
  const std::string head = "[[effect]]\nname = 'x'\nphrase = 'y'\n";
  const std::string columns = head + "columns = ['v^2']\n";
  const std::string shaped = head + "columns = ['exp(-d/l)']\n";
  EXPECT_EQ(complaint(columns), "none");
  EXPECT_EQ(complaint(columns + "[[effect]]\nname = 'x'\ncolumns = ['v^4']\n"), "none");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {head + "columns = ['velocty*v']\n", "'velocty' is no signal; signals: v sgn_v"},
      {shaped + "shape = [{name = 'l', scale = 'dd', grid = [1.0]}]\n",
       "the scale of 'l', 'dd' is no signal"},
      {shaped + "shape = [{name = 'l', scale = 'g/aa', grid = [1.0]}]\n", "'aa' is no signal"},
      {shaped + "shape = [{name = 'l', reference = true, grid = [1.0]}]\n", "has no scale"},
      {head + "columns = ['exp(-d/a)']\nshape = [{name = 'a', grid = [1.0]}]\n",
       "'a' is called like a signal"},
      {shaped + "shape = [{name = 'l', grid = [1.0]}, {name = 'l', grid = [2.0]}]\n",
       "'l' stands there twice"},
      {shaped + "shape = [{name = 'l', grid = [1.0, 9.0], low = 0.5, high = 2}]\n",
       "has 9 on its grid, outside 0.5 .. 2"},
      {head + "columns = ['sin(n*q)']\nshape = [{name = 'n', grid = [1, 0]}]\n",
       "with n = 0 a column is 0 or no number everywhere"},
      {head + "columns = ['v/l']\nshape = [{name = 'l', grid = [0.0]}]\n", "with l = 0 a column"},
      {head + "columns = ['v^2', 'v^4']\ncoefficients = ['a', 'a']\n",
       "two coefficients are called 'a'"},
      {columns + "separate_by = ['R10']\n", "no experiment 'R10'; give R1 to R9"},
      {columns + "sanity = [{coefficient = 'k', sign = 1}]\n", "has no coefficient 'k'"},
      {columns + "sanity = [{coefficient = 'c1', largest = -1}]\n", "'largest' is -1"},
      {columns + "alias = [{name = 'z', coefficient = 'k'}]\n", "has no coefficient 'k'"},
      {columns + "alias = [{name = 'z', unless_known = 'w'}]\n", "'unless_known' 'w' is no signal"},
      {columns + "[[effect]]\nname = 'x'\nphrase = 'z'\ncolumns = ['v^4']\n",
       "a further table of an effect has 'phrase'"},
      {"[[effect]]\nname = 'a<script>'\nphrase = 'y'\ncolumns = ['v^2']\n",
       "cannot name an effect"},
      {columns + "summary = \"a\\u0007\\nb\"\n", "'summary' is no one line of text"}};
  for (const auto& [text, wanted] : cases) {
    EXPECT_NE(complaint(text).find(wanted), std::string::npos) << text << complaint(text);
  }
}

// A file of a few hundred bytes whose grids multiply is refused before any column is made.
TEST(EffectFile, RefusesGridsThatMultiply) {
  const std::filesystem::path file = testing::scratch_folder() / "tribench_large_effects.toml";
  std::string grid;
  for (int k = 1; k <= 40; ++k) grid += fmt::format("{}{}.0", k > 1 ? ", " : "", k);
  std::ofstream(file)
      << "[[effect]]\nname = 'x'\nphrase = 'y'\ncolumns = ['exp(-a1*v-b1*v-c1*v)']\n"
      << fmt::format(
             "shape = [{{name = 'a1', grid = [{0}]}}, {{name = 'b1', grid = "
             "[{0}]}}, {{name = 'c1', grid = [{0}]}}]\n",
             grid);
  try {
    read_effects(file);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("more than 2000 columns"), std::string::npos);
  }
}

// Findings are told apart by their names.
TEST(EffectFile, RefusesASecondEffectOfOneName) {
  DiagnosisOptions options;
  options.learned = {family("stribeck")};
  EXPECT_THROW(diagnose(observe(kuka::make_planted({}, 1).data), coulomb_viscous_base, options),
               Error);
}

TEST(EffectFile, OfTheExamplesFindsWhatTheBuiltInLibraryLacks) {
  Observations data = observe(kuka::make_planted({}, 5).data);
  const std::vector<double> q = data.find("q")->values;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    data.target[i] += 0.3 * std::cos(161 * q[i] + 0.7);
  }
  DiagnosisOptions options;
  options.gear_ratios = {160};
  options.learned =
      read_effects(tribench::testing::source_dir() / "examples/effects/transmission.toml");
  EXPECT_EQ(options.learned.size(), 2U);
  const Diagnosis diagnosis = diagnose(data, coulomb_viscous_base, options);
  EXPECT_EQ(diagnosis.verdict, Verdict::effects);
  ASSERT_EQ(diagnosis.effects.size(), 1U);
  EXPECT_EQ(diagnosis.effects[0].family, "gear_side_band");
}

}  // namespace
}  // namespace tribench::loop
