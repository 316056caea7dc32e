// SPDX-License-Identifier: MIT
//
// The bristles behind a finding of presliding, as a state. The library's column
// sgn_v exp(-d/lambda) supposes that every stroke bends them all the way; where strokes are short,
// it puts the stiffness a third too low. Here they are carried from row to row, and what comes out
// has units: a stiffness, and a deflection from which on they slide.
//
//   dahl           dz = dx - |dx| z / sliding                        (Dahl 1968)
//   lugre          the same, and a force along dz/dt (Canudas de Wit et al. 1995)
//   maxwell_slip   four elements in parallel, each dz = dx held at |z| <= sliding
//                  (Al-Bender, Lampaert, Swevers 2005, without the rate of slip)
//
// Bristles know the path alone, not the time: rows may be averaged, thinned or cut, as long as the
// position and the distance since the last reversal were told before. Not for LuGre's Stribeck
// curve (an effect of its own beside this one) and not a method: for these there is `lugre`.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "algorithms/loop_model/loop_model.hpp"
#include "algorithms/states/state_text.hpp"

namespace tribench::loop {

enum class BristleLaw { dahl, lugre, maxwell_slip };
std::string_view bristle_law_name(BristleLaw law);  // "dahl", "lugre", "maxwell_slip"

// How they stand where a movement begins; the data choose.
enum class BristleStart {
  relaxed,
  as_left,  // by the movement before, as it stands in the file
  bent,     // as if it had gone on for ever
};

struct Bristles {
  struct Element {
    double sliding = 0;    // deflection at which it slides, in the position's unit
    double stiffness = 0;  // in the target's unit over the position's; above 0
  };
  BristleLaw law = BristleLaw::dahl;
  BristleStart start = BristleStart::relaxed;
  std::size_t family = 0;  // whose columns they stand for
  std::vector<Element> elements;
  double damping = 0;  // of lugre: the target's unit over the velocity's, 0 or above
  // Of all together, relaxed: the mean over the laws by their likelihood, so that it may differ
  // from the elements' sum, which is the likeliest law's.
  double stiffness = 0;
  double low = 0;  // 95 %: a tenth of the data left out in turn, and how far the laws lie apart
  double high = 0;
  double sliding = 0;  // deflection from which on all slide
  LoopModel others;    // the model without the family's columns, its coefficients beside these
};

// The first family of the model whose columns read the distance since a reversal.
std::optional<std::size_t> presliding_family(const LoopModel& model, const Observations& data);

// Replaces the family's columns by bristles and fits them with all linear coefficients to the rows
// with rows[i] != 0; shapes of other effects stay. correlated: the noise lasts from row to row, and
// the fit may trust that (Noise::whitened). Empty where there is no distance since a reversal,
// where the rows do not hold the deflection between two bounds, where the stiffness is not above 0,
// or where the closed form explains the rows decidedly better. Deterministic; some 100 evaluations
// of the columns.
std::optional<Bristles> fit_bristles(const LoopModel& model, std::size_t family,
                                     const Observations& data, const std::vector<char>& rows,
                                     bool correlated);

// Of every row; the rows before it are the motion before it.
Eigen::VectorXd predict(const Bristles& bristles, const Observations& data);

// As a formula with states over the data's signals, relaxed at a movement's start.
StatefulFormula formula_of(const Bristles& bristles, const Observations& data);

}  // namespace tribench::loop
