// SPDX-License-Identifier: MIT
//
// The mean of the straight lines through all subsets of a few columns, each weighed by what the
// rows say for it: one line again, of all columns, its slopes shrunk towards nothing the less the
// rows speak for them. On few rows, where many subsets fit nearly alike, it errs less than any of
// them that one could choose (Raftery, Madigan & Hoeting 1997).
//
// Not for choosing columns: the line has a slope for each. Not for columns that are many: there are
// 2^m subsets.
//
// Source: Zellner's prior of the slopes, its width g averaged over (hyper-g/n with a = 3: Liang et
// al. 2008, equation 18; here on a grid of powers of ten), no number of columns likelier than
// another (Scott & Berger 2010).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tribench {

inline constexpr std::size_t kMostAveraged = 15;
// Of a column\'s square that no other column explains: with less it adds nothing.
inline constexpr double kNewShare = 1e-8;

// Slopes of the m <= kMostAveraged columns. products: the (m + 1) x (m + 1) matrix of the products
// of centred columns, the target's last; `rows`: of how many rows, at least 3; `of`: of how many
// columns these are the ones that say most, which the prior pays for. A column that is a sum of
// others counts in the subsets without these. Zeros where the target does not vary. All finite.
// Cost: some 4 ms for 15 columns.
std::vector<double> average_over_subsets(std::span<const double> products, std::size_t rows,
                                         std::size_t of);

}  // namespace tribench
