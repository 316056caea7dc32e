// SPDX-License-Identifier: MIT
//
// An effect's atoms as blocks of columns, each of which may be the whole effect.
#pragma once

#include <vector>

#include "algorithms/effects/effect_library.hpp"
#include "algorithms/inference/evidence.hpp"

namespace tribench::loop {

// Atoms of one template: a curve whose shape parameter lies between grid points is nearly a sum of
// its neighbours. What is asked of the speed's curve of some of them is asked of all; the others
// are a template of their own besides.
struct Template {
  struct OneAtom {
    ColumnBlock columns;
    std::vector<double> shapes;  // their values
  };
  ColumnBlock columns;
  bool beside = false;
  ColumnBlock any_curve = {};
  std::vector<OneAtom> atoms = {};
};

// formulas, curves: receive the columns, by whose numbers the templates name them, and what is
// asked of each one's curve.
std::vector<Template> templates_of(const std::vector<Atom>& atoms,
                                   std::vector<Expression>& formulas,
                                   std::vector<SpeedCurve>& curves);

// Each template alone, with what there may be beside it, and all of them where they are few. Of a
// template of many atoms each one, too, alone and with what may be beside it of the same shape:
// where it is nearly the effect, all that the template can draw besides would count against it.
std::vector<EffectBlock> blocks_of(const std::vector<Template>& templates);

}  // namespace tribench::loop
