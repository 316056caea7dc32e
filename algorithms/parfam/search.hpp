// SPDX-License-Identifier: MIT
//
// Our ParFam: polynomials by best subset, then families with denominators and functions in order of
// cost on a sample of the rows, the best of them made sparse on all rows; every formula on the way
// is a candidate for the front.
#pragma once

#include "algorithms/parfam/front.hpp"
#include "algorithms/parfam/inner_search.hpp"
#include "algorithms/regressor.hpp"

namespace tribench::parfam {

struct SearchOptions {
  InnerSearchOptions inner;
  std::optional<Family> family;  // the only one that is searched, where given
  int polynomial_degree = 5;
  int functions = 1;              // at once
  std::size_t sample_rows = 500;  // for the search over families
  std::size_t refined = 6;        // families made sparse on all rows
  Choice choice = Choice::bic;
};

FitResult search(FitContext& context, const SearchOptions& options);

}  // namespace tribench::parfam
