// SPDX-License-Identifier: MIT
//
// Products of tall matrices, many rows and few columns: the Gram matrices and projections that a
// diagnosis spends most of its time on. Not for square matrices (Eigen's own products).
//
// The program is compiled for any x86-64, and Eigen's products with it: two numbers an instruction.
// These are the column kernels' (expression/column_kernels.hpp), which take what the processor has
// and give the same bits on each. NaN and infinity spread as in any sum.
//
// Cost: n p q multiplications and additions, half of it for a Gram matrix; a Gram matrix takes
// about half of the time of Eigen's with AVX2, a third with AVX-512 (14 000 rows, 4 to 60 columns:
// bench/diagnosis_bench).
#pragma once

#include <Eigen/Core>

namespace tribench::loop {

using ColumnsRef = Eigen::Ref<const Eigen::MatrixXd>;

// a' b; as many rows in both.
Eigen::MatrixXd cross_products(const ColumnsRef& a, const ColumnsRef& b);

// a' a, symmetric to the bit.
Eigen::MatrixXd gram_of(const ColumnsRef& a);

// from - columns * coefficients. columns: n x p, coefficients: p x q, from: n x q.
Eigen::MatrixXd less_combination(Eigen::MatrixXd from, const ColumnsRef& columns,
                                 const ColumnsRef& coefficients);

}  // namespace tribench::loop
