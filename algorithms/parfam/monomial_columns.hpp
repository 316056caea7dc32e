// SPDX-License-Identifier: MIT
//
// The values of a structure's monomials over rows of data: those in the inputs once, shared by all
// polynomials; those with base functions as groups, one for each product of functions.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "algorithms/parfam/family.hpp"

namespace tribench::parfam {

// Columns of monomials in the inputs, computed when first asked for; addresses stay valid.
class MonomialColumns {
 public:
  MonomialColumns(std::span<const double* const> inputs, std::size_t rows)
      : inputs_(inputs.begin(), inputs.end()), rows_(rows) {}

  std::size_t rows() const { return rows_; }
  // monomial may have exponents of functions behind those of the inputs; they are ignored.
  const double* column(const Monomial& monomial);

 private:
  std::vector<const double*> inputs_;
  std::size_t rows_;
  std::map<Monomial, std::vector<double>> columns_;
};

// The monomials of a list that share the same product of functions (bit i: function i).
struct MonomialGroup {
  unsigned functions = 0;
  std::vector<const double*> columns;  // the part in the inputs
  std::vector<std::size_t> places;     // in the list
};

std::vector<MonomialGroup> group_by_functions(std::span<const Monomial> monomials,
                                              std::size_t inputs, MonomialColumns& columns);

}  // namespace tribench::parfam
