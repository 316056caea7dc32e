// SPDX-License-Identifier: MIT
//
// What one fit of relay has found so far: the formulas of all its searches on one front
// (fitting/joint_front.hpp), which of them explained the rows, and the record's note.
//
// Not for looking for formulas: structure_search.hpp and the methods do, and ask here whether more
// of it is of use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/admission.hpp"
#include "algorithms/finite_rows.hpp"
#include "algorithms/fitting/joint_front.hpp"
#include "algorithms/regressor.hpp"
#include "algorithms/relay/long_sum.hpp"

namespace tribench::relay {

class Answer {
 public:
  // The context is kept by reference; what is done here is spent from its budget.
  explicit Answer(FitContext& context);

  const FiniteRows& rows() const { return rows_; }
  bool has_formula() const { return !joint_.empty(); }
  // A formula explains the rows to rounding: only a shorter one is still of use.
  bool is_explained() const { return joint_.is_explained(); }
  // Whether the chosen formula is so short that another method hardly finds a shorter one.
  bool is_short();
  // Nothing is left to spend; or the rows are explained and a shorter way is hardly possible, or
  // was looked for long enough: in proportion to what had been spent when they were explained.
  bool is_done();
  // No shorter explanation is looked for.
  void end_look() { look_ends_ = 0; }
  // Evaluations that may still be spent on a shorter explanation of rows that are explained.
  std::uint64_t left_to_look() const;
  // So little time is left that another method would hardly have prepared its rows.
  bool is_late() const;

  // Fits the constants of a formula, if there is one, to all rows and adds it. `found_by` is how
  // the note calls the search.
  void offer(std::optional<Expression> found, std::string_view found_by);
  // Of formulas whose constants are still to be fitted those with the most evidence, without a
  // pole in the ranges of the inputs: that is noise that was fitted.
  void offer_likeliest(std::span<const Expression> formulas, Budget& budget);
  // The formula with the most evidence so far; there is one.
  Expression likeliest() const { return joint_.likeliest(1)[0]; }
  // A sum of many terms, whose error was held out on so many rows (long_sum.hpp): it stands where
  // what is chosen in the end is worse on these, and by more than chance where it is shorter.
  void set_rival(LongSum sum, std::size_t rows);
  // What another method found, or in the note why it found nothing.
  void add(const FitResult& result, std::string_view found_by);
  // The same formula with fewer numbers, where the rows do not mind; nothing once they are
  // explained. of_seconds: at most so much of the seconds that are left.
  void prune(const Expression& formula, double of_seconds);
  void prune_likeliest(double of_seconds);

  FitResult result() &&;

 private:
  void say(std::string_view what);  // in the note
  // `found_by` is noted where the rows are explained by one of these formulas.
  void add_explaining(std::span<const Expression> front, std::optional<std::size_t> chosen,
                      std::string_view found_by);
  std::size_t chosen_nodes();
  std::optional<std::size_t> best_against_rival(std::span<const Expression> front,
                                                std::size_t chosen);

  FitContext& context_;
  FiniteRows rows_;
  Admission admission_;
  JointFront joint_;
  double seconds_;  // to spend, in all
  // Evaluations at which the look for a shorter explanation ends, once there is one.
  std::optional<std::uint64_t> look_ends_;
  std::optional<LongSum> rival_;
  std::size_t rival_rows_ = 0;
  std::string note_;
  std::string explained_by_;
};

}  // namespace tribench::relay
