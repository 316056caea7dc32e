// SPDX-License-Identifier: MIT
#include "algorithms/exploration/effect_templates.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace tribench::loop {
namespace {

Atom atom_with(const char* label, std::vector<double> shapes, bool beside) {
  Atom atom;
  atom.label = label;
  atom.columns = {Expression::variable(0)};
  for (const double value : shapes) {
    Shape shape;
    shape.name = "vs";
    shape.value = value;
    atom.shapes.push_back(shape);
  }
  atom.beside_another = beside;
  return atom;
}

std::vector<ColumnBlock> columns_of(const std::vector<Atom>& atoms) {
  std::vector<Expression> formulas;
  std::vector<SpeedCurve> curves;
  std::vector<ColumnBlock> all;
  for (const EffectBlock& block : blocks_of(templates_of(atoms, formulas, curves))) {
    all.push_back(block.columns);
  }
  return all;
}

TEST(EffectTemplates, OneCurveOfManyIsABlockWithWhatOfItDiffersByDirection) {
  const std::vector<Atom> atoms = {
      atom_with("fall", {0.02}, false), atom_with("fall", {0.04}, false),
      atom_with("fall", {0.08}, false), atom_with("half_gap", {0.02}, true),
      atom_with("half_gap", {0.08}, true)};
  EXPECT_THAT(columns_of(atoms),
              ::testing::UnorderedElementsAre(ColumnBlock{0}, ColumnBlock{0, 3}, ColumnBlock{1},
                                              ColumnBlock{2}, ColumnBlock{2, 4},
                                              ColumnBlock{0, 1, 2}, ColumnBlock{0, 1, 2, 3, 4}));
}

TEST(EffectTemplates, TwoCurvesAreOneBlock) {
  EXPECT_THAT(columns_of({atom_with("power", {0.5}, false), atom_with("power", {4}, false)}),
              ::testing::ElementsAre(ColumnBlock{0, 1}));
}

}  // namespace
}  // namespace tribench::loop
