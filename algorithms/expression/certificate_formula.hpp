// SPDX-License-Identifier: MIT
//
// The checker's own reading of a certificate's formula and box: a second, smaller parser that
// shares nothing with the one that the prover used (parse.cpp, input_box.cpp), and counts inputs
// without a bound. What a certificate claims is what stands here.
//
// Not for anything else: no names are suggested, no places counted.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/expression/expression.hpp"

namespace tribench {

struct ClaimedNode {
  Op op = Op::constant;
  double value = 0;       // of a constant
  std::size_t input = 0;  // of a variable
};
using ClaimedFormula = std::vector<ClaimedNode>;  // postfix

struct PieceRange {
  double low = 0;
  double high = 0;
  bool operator==(const PieceRange&) const = default;
};
using Piece = std::vector<PieceRange>;  // per input of the box

// Inputs with a range, then the signs sgn_X that the formula looks at.
struct ClaimedBox {
  std::vector<std::string> names;
  Piece ranges;
  std::vector<std::optional<std::size_t>> sign_of;  // the place of X

  std::optional<std::size_t> place_of(std::string_view name) const;
  void add_name(std::string_view name);

 private:
  std::map<std::string, std::size_t, std::less<>> places_;
};

// Both throw Error (bad_input) on whatever is not as print and print_box write it, and on ranges
// that are none; the formula's signs are added to the box.
ClaimedBox read_claimed_box(std::string_view text);
ClaimedFormula read_claimed_formula(std::string_view text, ClaimedBox& box);

}  // namespace tribench
