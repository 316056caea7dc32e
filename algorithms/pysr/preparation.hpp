// SPDX-License-Identifier: MIT
//
// What stands between the training rows and a search: the form of the formulas, by a template or
// by the inputs that matter most, and the rows the search sees, where it does not see all as they
// are. What was decided here is told in the record's note.
#pragma once

#include <string>

#include "algorithms/pysr/form.hpp"
#include "algorithms/pysr/options.hpp"
#include "algorithms/regressor.hpp"

namespace tribench::pysr {

// Appends to the one line of a record's note.
void add_to_note(std::string& note, const std::string& what);

std::vector<std::string> names_of(std::span<const Input> inputs);

// `rows` has the inputs alone. Throws Error (bad_input) for a template that does not fit them.
Form prepare_form(const Options& options, const Rows& rows, FitContext& context, std::string& note);

// A sample of the rows, or all; their targets smoothed where that is asked for.
Rows prepare_rows(const Options& options, const Form& form, const Rows& all, FitContext& context,
                  std::string& note);

}  // namespace tribench::pysr
