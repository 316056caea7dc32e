// SPDX-License-Identifier: MIT
//
// Collects candidate formulas: polishes their constants on all rows, keeps those that no other
// beats in both error and complexity, and chooses one.
#pragma once

#include <optional>
#include <vector>

#include "algorithms/expression/differentiate.hpp"
#include "algorithms/finite_rows.hpp"
#include "algorithms/fitting/constant_fit.hpp"

namespace tribench::parfam {

// How a formula is chosen from the front.
enum class Choice {
  description_length,  // see fitting/description_length.hpp
  bic,                 // (n / 2) ln(RSS / n) + p (ln n / 2 + ln 2) with p constants
  cross_validation,    // over movements
};

class Front {
 public:
  // proved_only: formulas enter only if the proof engine clears them on the input box.
  Front(const FiniteRows& data, FitContext& context, bool proved_only);

  // Takes a formula in where it keeps to the operators, is finite on the rows and, where that is
  // asked for, proved free of singularities: polished, or as it came where the polish loses that.
  void offer(Expression formula);
  // The front by increasing complexity and the formula chosen from it.
  FitResult result(Choice choice);

 private:
  struct Member {
    Expression formula;
    int complexity = 0;
    double sum_squares = 0;
    double description_length = 0;
    double bic = 0;
  };
  std::size_t choose(const std::vector<const Member*>& front, Choice choice) const;
  bool is_proved(const Expression& formula) const;
  std::optional<Member> polished(Expression formula);
  bool is_beaten(const Member& member) const;
  void enter(Member member);

  const FiniteRows& data_;
  FitContext& context_;
  bool proved_only_;
  ConstantFitter fitter_;
  Evaluator evaluator_;
  Differentiator differentiator_;
  std::vector<Member> members_;
  double least_ = 1e308;
  double target_squares_ = 0;
};

}  // namespace tribench::parfam
