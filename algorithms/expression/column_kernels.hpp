// SPDX-License-Identifier: MIT
//
// Elementwise operations and sums over short columns of doubles: what derivatives and fits are
// made of. Each is compiled for several instruction sets and chosen when the program starts; all
// give the same bits, because no multiply-add is fused and every sum runs in eight lanes that are
// added in one fixed order.
//
// Columns may be the same as `out`, but must not overlap in part. NaN and infinity travel as IEEE
// 754 says.
#pragma once

#include <cstddef>

namespace tribench::columns {

// out[i] = a[i] op b[i], and with a scalar on either side.
void add(const double* a, const double* b, double* out, std::size_t n);
void add(const double* a, double b, double* out, std::size_t n);
void sub(const double* a, const double* b, double* out, std::size_t n);
void sub(double a, const double* b, double* out, std::size_t n);
void mul(const double* a, const double* b, double* out, std::size_t n);
void mul(const double* a, double b, double* out, std::size_t n);
void div(const double* a, const double* b, double* out, std::size_t n);
void div(double a, const double* b, double* out, std::size_t n);
void div(const double* a, double b, double* out, std::size_t n);

void sqrt(const double* a, double* out, std::size_t n);
void abs(const double* a, double* out, std::size_t n);
void sgn(const double* a, double* out, std::size_t n);  // -1, 0, 1; NaN of NaN
// a^exponent as a product of squares, the reciprocal of it where the exponent is negative.
void integer_power(const double* a, int exponent, double* out, std::size_t n);
void one_minus_square(const double* a, double* out, std::size_t n);

void exp(const double* a, double* out, std::size_t n);
void log(const double* a, double* out, std::size_t n);
void sin(const double* a, double* out, std::size_t n);
void cos(const double* a, double* out, std::size_t n);
void tanh(const double* a, double* out, std::size_t n);
void atan(const double* a, double* out, std::size_t n);
void pow(const double* a, const double* b, double* out, std::size_t n);

// out[i] = sum_j coefficients[j] columns[j][i]; 0 where count is 0.
void combine(const double* const* columns, const double* coefficients, std::size_t count,
             double* out, std::size_t n);
// The same added to what is there.
void add_combination(const double* const* columns, const double* coefficients, std::size_t count,
                     double* out, std::size_t n);

double sum(const double* a, std::size_t n);
double dot(const double* a, const double* b, std::size_t n);
// sums[j] = sum_i a[i] b[j][i] for j < 4: one reading of a serves four columns.
void dot4(const double* a, const double* const b[4], std::size_t n, double sums[4]);

// out += a b of matrices stored by columns: a is rows x inner, b inner x count, out rows x count.
// Every element sums over `inner` in order. Fastest where rows is a multiple of 16.
void add_product(const double* a, const double* b, std::size_t rows, std::size_t inner,
                 std::size_t count, double* out);

// products[i * count + j] = sum_r columns[i][r] columns[j][r], both triangles.
void gram(const double* const* columns, std::size_t count, std::size_t n, double* products);
// products[i * right_count + j] = sum_r left[i][r] right[j][r], the same sums as gram's.
void cross_products(const double* const* left, std::size_t left_count, const double* const* right,
                    std::size_t right_count, std::size_t n, double* products);

}  // namespace tribench::columns
