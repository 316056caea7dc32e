// SPDX-License-Identifier: MIT
//
// Keeps free denominators 1 + q away from 0 on the whole input box: the constrained form of the
// family. A fit whose denominators sink too low is fitted again by Ipopt with the constraint
// D >= 0.01 at points of the box. The points are the box's corners, the rows where it was broken
// and, as long as the proof engine refutes the formula, its witnesses.
//
// Source: the exchange method for semi-infinite programs (Blankenship & Falk 1976), with the proof
// engine as the oracle of the lower level: it ends with a proof, not with a fine enough grid.
//
// Not for denominators 1 + q^2, which have no poles by construction.
#pragma once

#include <vector>

#include "algorithms/admission.hpp"
#include "algorithms/expression/input_box.hpp"
#include "algorithms/expression/operator_set.hpp"
#include "algorithms/parfam/formula.hpp"

namespace tribench::parfam {

// Threads may share one; Ipopt's solves wait for one another.
class PoleGuard {
 public:
  // columns: the rows of the search, divided by `scales`; they must outlive the guard.
  PoleGuard(std::span<const Input> inputs, std::span<const double> scales,
            std::span<const double* const> columns, std::size_t rows, const OperatorSet& operators);

  // Moves the inner parameters to where the fit is best among those whose denominators keep their
  // distance from 0 at the corners and the rows. They stay where they are if they do already.
  void clear(Projection& projection, std::vector<double>& inner, Budget& budget) const;

  // As clear, until the proof engine finds no singularity on the box; the model's parameters and
  // sum of squares are then those of the proved formula. False where it does not come to that.
  bool make_proved(TrainedModel& model, std::span<const double> y, Budget& budget) const;

 private:
  using Points = std::vector<std::vector<double>>;

  Points lowest(const Structure& structure, std::span<const double> inner) const;
  void clear_at(Projection& projection, std::vector<double>& inner, Points& points,
                Budget& budget) const;

  InputBox box_;
  std::vector<double> scales_;
  std::vector<const double*> columns_;
  std::size_t rows_;
  const OperatorSet& operators_;
  Points corners_;
};

}  // namespace tribench::parfam
