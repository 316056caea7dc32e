// SPDX-License-Identifier: MIT
//
// A formula with states as code for a controller (C, in double or single precision), Python and
// MATLAB: what it remembers, `init`, and one `step` a sample.
//
// C has a fixed memory (a struct), no allocation, and is the same operations in the same order as
// the evaluator and state_column: with -ffp-contract=off (and a processor or library with fma) a
// step has their bits, exp included, in double and in float alike; log, sin, cos, tanh and other
// powers are the library's. Python and MATLAB use their own exp: a few units in the last place off.
//
// A step takes the inputs at the sample and the seconds since the one before. The first one after
// `init` starts the states from rest; its seconds count for nothing. A step without time (dt 0)
// changes no state; after a break, call init.
#pragma once

#include <span>
#include <string>

#include "algorithms/expression/export.hpp"
#include "algorithms/states/state_text.hpp"

namespace tribench {

struct StatefulExportOptions {
  std::string function = "friction";
  std::optional<NamedBox> box;  // of the inputs; its names come first among the arguments
  bool single = false;          // C in float
};

// names: of the inputs. Throws Error (bad_input) for a form that has no steps (latex, sympy), for
// single precision in another language than C, and as export_code.
std::string export_stateful(const StatefulFormula& formula, std::span<const std::string> names,
                            CodeForm form, const StatefulExportOptions& options = {});

}  // namespace tribench
