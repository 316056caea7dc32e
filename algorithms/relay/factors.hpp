// SPDX-License-Identifier: MIT
//
// The quantities that products are made of, besides the inputs: functions of an input of order one,
// sums and differences of alike inputs. One list for all searches of this room.
#pragma once

#include <vector>

#include "algorithms/relay/log_rows.hpp"

namespace tribench::relay {

// Of more inputs pairs are no factors: hundreds of them would leave time for nothing else.
inline constexpr std::size_t kMostPaired = 12;
// Of which a sparse sum is sought: 0.2 s and 50 MB for the products of any two.
inline constexpr std::size_t kMostColumns = 2000;

enum class FactorKind {
  input,
  wave,          // sine, cosine of an input or of a difference
  angle_sum,     // sine, cosine of the sum of two inputs, as in chains of links
  wave_product,  // of sines and cosines of different inputs, of few inputs
  difference,    // of two inputs
  sum,
  root,          // of a positive input
  root_product,  // of two positive inputs
  power,         // x^y; (1 - x)^y and (1 + x)^y of a share x
  logarithm,     // of a positive input x; of 1 - x of a share
  exponential,   // of an input of order one
  decay,         // exp(-x y) of two of them
  other,         // 1 + x, tanh x, ...
};

struct KnownFactor {
  Factor factor;
  FactorKind kind = FactorKind::input;
  std::vector<std::size_t> inputs;  // that it is made of
};

// The inputs, then what `kinds` names, as far as operators have it. Finite on all rows.
std::vector<KnownFactor> known_factors(const LogRows& rows, const OperatorSet& operators,
                                       std::initializer_list<FactorKind> kinds);

}  // namespace tribench::relay
