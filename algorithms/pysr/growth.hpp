// SPDX-License-Identifier: MIT
//
// Our own two moves, which look at the residual before they change a formula.
//
// Growing: at a fitted formula f with residual e and Jacobian J, adding c t to the value of a node
// n changes f by c a_n t to first order (a_n: the adjoint of n), multiplying it by 1 + c t changes
// f by c a_n n t. With u that direction less its projection on J, the best c lowers the sum of
// squares by (u'e)^2 / u'u. So many pairs of a place and a term t are ranked for the price of one
// fit: orthogonal matching pursuit (Pati, Rezaiifar, Krishnaprasad 1993) in the tangent space of
// the formula, inside exponentials as well as outside.
//
// Pruning: setting the constant c_k to 0 (or a factor to 1) and refitting the others raises the sum
// of squares by c_k^2 / [(J'J)^-1]_kk (Hassibi, Stork 1993, "Optimal brain surgeon", eq. 5).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "algorithms/budget.hpp"
#include "algorithms/expression/differentiate.hpp"
#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/operator_set.hpp"
#include "algorithms/pysr/form.hpp"
#include "algorithms/pysr/rows.hpp"
#include "foundation/random.hpp"

namespace tribench::pysr {

// What a place can be grown by, with its values on the rows: 1, monomials of the inputs up to a
// degree, and functions of the inputs at a few scales, none proportional to an earlier one.
struct Term {
  Expression formula;
  std::vector<double> values;
  std::vector<double> squares;  // of the values

  bool is_one() const { return formula.size() == 1 && formula.node(0).is_constant(); }
};

struct TermLibrary {
  std::vector<Term> terms;  // terms[0] is 1
};

TermLibrary make_term_library(const Rows& rows, const OperatorSet& operators);

// One library for each part of the form: terms of the part's arguments.
using TermLibraries = std::vector<TermLibrary>;
TermLibraries make_term_libraries(const Form& form, const Rows& rows, const OperatorSet& operators);

// A grown or pruned copy of a formula, its constants at their first-order estimate.
struct Proposal {
  Expression formula;
  double decrease = 0;  // of the sum of squares, to first order; negative for pruning
};

// One per thread.
class Grower {
 public:
  Grower(const OperatorSet& operators, const Form& form, const TermLibraries& libraries)
      : operators_(&operators), form_(&form), libraries_(&libraries) {}

  // The best `count` of `samples` drawn places and terms, best first, within the parts of the form;
  // all pairs where samples is 0. Fewer, or none, where the formula is not finite with its
  // derivatives, or the budget ends.
  std::vector<Proposal> grow(const Expression& formula, const Rows& rows, std::size_t samples,
                             std::size_t count, RandomStream& random, Budget& budget);

  // Every single removal of a constant, the cheapest first.
  std::vector<Proposal> prune(const Expression& formula, const Rows& rows, Budget& budget);

 private:
  struct Probe {
    std::size_t place;
    const TermLibrary* library;  // of the part that holds the place
    bool additive;
    bool multiplicative;
  };
  struct Candidate {
    std::size_t probe;
    const Term* term;
    bool multiplicative;
    double coefficient;
    double decrease;  // of the sum of squares, to first order
    double gain;      // evidence, to first order
  };

  std::vector<Probe> probes_of(const Expression& formula) const;
  bool differentiate(const Expression& formula, std::span<const Probe> probes, const Rows& rows,
                     Budget& budget);
  void orthonormalise(std::size_t rows);
  void load_probe(std::size_t probe, bool multiplicative, std::size_t rows);
  Candidate rate(std::size_t probe, const Term& term, bool multiplicative, std::size_t rows) const;
  std::vector<Candidate> ranked(std::span<const Probe> probes, std::size_t samples,
                                std::size_t rows, RandomStream& random);
  std::vector<Candidate> distinct(std::vector<Candidate> candidates) const;
  double price_of(const Candidate& candidate) const;
  void build(const Expression& formula, const Candidate& candidate, std::span<const Probe> probes,
             std::vector<Proposal>& proposals) const;
  std::span<double> column(std::size_t k, std::size_t rows) {
    return std::span(jacobian_).subspan(k * rows, rows);
  }

  const OperatorSet* operators_;
  const Form* form_;
  const TermLibraries* libraries_;
  Differentiator differentiator_;
  std::size_t constants_ = 0;     // columns of J that belong to constants
  std::vector<double> jacobian_;  // then, per probe: its value times its adjoint, its adjoint
  std::vector<double> basis_;     // orthonormal columns that span J
  std::size_t basis_size_ = 0;
  std::vector<double> residual_;  // target - f, less its projection on J
  std::vector<double> loaded_;    // columns of the probe at hand; see load_probe
};

}  // namespace tribench::pysr
