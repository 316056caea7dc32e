// SPDX-License-Identifier: MIT
//
// The model in the loop: a base (a formula with its own constants, or linear terms) plus the
// columns of the effects added so far. Fits all of them together: linear coefficients by least
// squares, the base's constants and the effects' shapes by Levenberg-Marquardt with the linear
// part projected out.
//
// Source: Golub and Pereyra 1973 (variable projection), Kaufman 1975 (its Jacobian).
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "algorithms/effects/effect_library.hpp"
#include "algorithms/inference/clusters.hpp"
#include "algorithms/loop_model/signal_table.hpp"
#include "algorithms/regressor.hpp"

namespace tribench::loop {

struct BaseModel {
  std::string name;  // "coulomb_viscous", a method, "formula"
  // Over the signals; may be empty. Its free constants are fitted; addends with one that is a
  // factor stand in linear_terms instead.
  Expression formula;
  std::vector<ConstantRange> ranges;     // of the formula's constants; empty: all have any value
  std::vector<Expression> linear_terms;  // each with a coefficient
};

struct FittedConstant {
  std::size_t place;  // node of the base's formula
  ConstantRange range;
};

// The formula's constants that are fitted: those of its form and fixed ones are not.
std::vector<FittedConstant> fitted_constants(const BaseModel& base);

// Makes the base from training movements; the loop calls it on nothing else.
using BaseMaker = std::function<BaseModel(const Observations&)>;

// {sgn_v, 1, v, |v|} and the rigid signals. Throws Error where there is no velocity.
BaseModel coulomb_viscous_base(const Observations& data);
// A formula over the signals' names (or the channels'), with the rigid signals beside it. Throws
// Error (bad_input) that names what is unknown.
BaseModel formula_base(const Observations& data, std::string_view text);
// What is fitted exactly, wherever its constants stand at first, goes to the linear terms.
// `ranges`: of the formula's constants in the order of its tape, or empty. Those of linear terms
// are dropped.
void add_formula(BaseModel& base, const Expression& formula,
                 std::span<const ConstantRange> ranges = {});
void add_rigid_terms(BaseModel& base, const Observations& data);

struct LoopModel {
  BaseModel base;
  std::vector<Atom> atoms;
  // Of base.linear_terms, then of the atoms' columns, in order.
  Eigen::VectorXd coefficients;

  // Adds an atom with coefficients 0.
  void add(Atom atom);
  void remove(std::size_t atom);
  std::size_t first_column(std::size_t atom) const;  // of its coefficients
  std::size_t atoms_of(std::size_t family) const;
  LoopModel without(std::size_t family) const;
};

// Values of formulas, one a column.
Eigen::MatrixXd evaluate_columns(std::span<const Expression> formulas, const Observations& data);
Eigen::VectorXd evaluate_column(const Expression& formula, const SignalTable& table);
Eigen::VectorXd predict(const LoopModel& model, const Observations& data);
Eigen::Map<const Eigen::VectorXd> target_vector(const Observations& data);

// The share of one family in the prediction.
Eigen::VectorXd contribution(const LoopModel& model, std::size_t family, const Observations& data);
// The signals that a family's columns read, each once, in the order of the formulas.
std::vector<const Signal*> signals_read(const LoopModel& model, std::size_t family,
                                        const Observations& data);

// The columns that the coefficients multiply.
std::vector<Expression> linear_columns(const LoopModel& model);

// The model as one formula over the signals.
Expression formula_of(const LoopModel& model);
// The same over the signals' names.
std::string formula_text(const LoopModel& model, const Observations& data);

}  // namespace tribench::loop
