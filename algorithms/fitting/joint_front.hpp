// SPDX-License-Identifier: MIT
//
// One front of several searches on the same rows, and one formula to stand for it: the exact one
// where there is one (exact_choice.hpp), else of the formulas that the searches stood for (or what
// is better than these in every respect) the simplest that is typical of what all their fronts say
// together (posterior_choice.hpp), every form priced alike (evidence.hpp). Where the formula will
// be used beyond the rows no evidence speaks, nor what a search stood for: cross-validation that
// holds out the rows as far as the box goes beyond them decides among all on the front: the
// simplest whose held-out mean square is at most a tenth above the least.
//
// The one with the most evidence is no good choice here: of several searches it is the one that
// fits the noise best.
//
// Not for fronts of different rows: their errors cannot be compared.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/input_box.hpp"

namespace tribench {

class JointFront {
 public:
  // Finite rows, kept by reference. movement[r] names the movement of row r; box: the ranges the
  // formula will be used over; none given means those of the rows.
  JointFront(const Inputs& inputs, std::span<const double> target, std::span<const int> movement,
             InputBox box);

  // `chosen`: the place of the formula that the search stands for; none: one that is only looked
  // for what it is worth. One evaluation a formula.
  void add(std::span<const Expression> front, std::optional<std::size_t> chosen);

  bool empty() const { return members_.empty(); }
  // By increasing paper complexity, each with less error than all before it; the chosen one stays.
  const std::vector<Expression>& formulas();
  std::size_t chosen();

  // Those with the most evidence, the best first, at most `most`.
  std::vector<Expression> likeliest(std::size_t most) const;

  // Whether a formula explains the rows to rounding: more search is in vain.
  bool is_explained() const { return is_explained_; }

 private:
  struct Member {
    Expression formula;
    int complexity = 0;
    double error = 0;    // mean squared
    double against = 0;  // nats
    bool is_choice = false;
  };

  void settle();
  bool is_on_front(std::size_t place) const;
  std::size_t better_than(std::size_t place) const;
  std::size_t choose() const;  // a place in members_
  void list(const std::function<bool(std::size_t)>& is_taken);

  Inputs inputs_;
  std::span<const double> target_;
  std::span<const int> movement_;
  InputBox box_;
  double zero_loss_ = 0;
  Evaluator evaluator_;
  std::vector<Member> members_;       // by increasing complexity, then error; no two alike
  std::vector<std::size_t> places_;   // in members_, of the formulas
  std::vector<Expression> formulas_;  // of the front, as far as settled
  std::size_t chosen_ = 0;
  bool is_settled_ = false;
  bool is_exact_ = false;  // the chosen one
  bool is_explained_ = false;
};

}  // namespace tribench
