// SPDX-License-Identifier: MIT
//
// What a search's choice is worth on rows that the search has not seen, and how complex a formula
// does better where it is worth little.
//
// On some dozen rows a long search finds forms that fit their noise. Folds that fit the constants
// of such a form anew do not see it (held_out_choice.hpp): the form itself was chosen with the rows
// held out. So the whole search is made again without each fold, and its fronts are judged there.
//
// The choice stands unless the folds' choices err more than the mean would, or half more than
// their formulas of some bounded complexity do: then nothing is chosen beyond the simplest bound
// that is as good as any. Where it stands, what more searching finds may be as complex as it is.
//
// Of the formulas that stand so, the most typical: a search that has gone astray on few rows (a
// power of 40 for one row, a pole between two) differs from what the others found.
//
// Not for exact formulas (exact_choice.hpp), nor where searches are dear: it costs one a fold.
// Sources: Stone 1974 (assessment of a choice by cross-validation of all of its steps); Breiman
// 1996 (the mean of what resamples found errs less than one of them; we keep one, to be read).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/expression.hpp"

namespace tribench {

class SearchValidation {
 public:
  // A front that was found without these rows, by increasing complexity, and the place of what its
  // search chose. At least one formula and one row; all values finite.
  void add(std::span<const Expression> front, std::size_t chosen, const Inputs& held_out,
           std::span<const double> target);

  // With at least one fold: the mean square of the folds' choices on the rows held out, and the
  // greatest complexity that the folds speak for, of a front that was found on all rows, by
  // increasing complexity, and the place of its choice.
  double mean_square() const;
  int bound(std::span<const Expression> front, std::size_t chosen) const;

 private:
  struct Fold {
    std::vector<int> complexity;
    std::vector<double> mean_square;  // of each formula; infinite where it is not finite
    std::size_t chosen = 0;
    std::vector<double> target;

    double up_to(int complexity_bound) const;
  };
  double variance() const;  // of all targets
  template <typename Error>
  double mean_over_rows(const Error& error) const;

  std::vector<Fold> folds_;
};

// The place of the candidate whose values have the least mean squared distance, over the rows, from
// the median of what `searched` says there; the first where none is finite. Rows without a finite
// median do not count. At least one of both.
std::size_t most_typical(std::span<const Expression> candidates,
                         std::span<const Expression> searched, const Inputs& inputs);

}  // namespace tribench
