// SPDX-License-Identifier: MIT
#include "algorithms/parfam/projection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "algorithms/expression/column_kernels.hpp"
#include "algorithms/fitting/cholesky.hpp"

namespace tribench::parfam {
namespace {

constexpr std::size_t kNoFactor = static_cast<std::size_t>(-1);
// A column whose part that is new is smaller than this share of its square adds nothing but noise.
constexpr double kDependent = 1e-11;

// D from its polynomial q.
void denominator_from(Denominators kind, const std::vector<double>& q, std::vector<double>& d) {
  if (kind == Denominators::safe) {
    columns::mul(q.data(), q.data(), d.data(), q.size());
    columns::add(d.data(), 1.0, d.data(), q.size());
  } else {
    columns::add(q.data(), 1.0, d.data(), q.size());
  }
}

// dD / dq.
void denominator_slope(Denominators kind, const std::vector<double>& q,
                       std::vector<double>& slope) {
  if (kind == Denominators::safe) {
    columns::mul(q.data(), 2.0, slope.data(), q.size());
  } else {
    std::ranges::fill(slope, 1.0);
  }
}

// products[i * b.size() + j] = sum_r a_i[r] b_j[r].
void cross_products(std::span<const double* const> a, std::span<const double* const> b,
                    std::size_t rows, std::vector<double>& products) {
  products.assign(a.size() * b.size(), 0.0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); j += 4) {
      const double* four[4];
      for (std::size_t k = 0; k < 4; ++k) four[k] = b[std::min(j + k, b.size() - 1)];
      double sums[4];
      columns::dot4(a[i], four, rows, sums);
      for (std::size_t k = 0; k < 4 && j + k < b.size(); ++k)
        products[i * b.size() + j + k] = sums[k];
    }
  }
}

// The product of the columns named by the bits of `functions`, but for one of them; none: null.
const double* product_of(std::span<const double* const> factors, unsigned functions,
                         std::size_t without, std::vector<double>& space) {
  const double* product = nullptr;
  for (std::size_t i = 0; i < factors.size(); ++i) {
    if (((functions >> i) & 1U) == 0 || i == without) continue;
    if (product == nullptr) {
      product = factors[i];
    } else {
      columns::mul(product, factors[i], space.data(), space.size());
      product = space.data();
    }
  }
  return product;
}

}  // namespace

Projection::Projection(const Structure& structure, std::span<const double* const> inputs,
                       std::span<const double> y, Denominators denominators, Budget& budget)
    : structure_(structure),
      rows_(y.size()),
      y_(y),
      denominators_(denominators),
      budget_(budget),
      columns_(inputs, y.size()),
      arguments_(structure.functions.size()) {
  for (std::size_t i = 0; i < arguments_.size(); ++i) {
    Argument& argument = arguments_[i];
    argument.begin = inner_count_;
    for (const auto& m : structure.numerators[i]) argument.numerator.push_back(columns_.column(m));
    for (const auto& m : structure.denominators[i]) {
      argument.denominator.push_back(columns_.column(m));
    }
    inner_count_ += argument.numerator.size() + argument.denominator.size();
    for (auto* values : {&argument.top, &argument.q, &argument.value, &argument.g}) {
      values->resize(rows_);
    }
    argument.bottom.assign(rows_, 1.0);
    factors_.push_back(argument.g.data());
  }
  denominator_begin_ = inner_count_;
  inner_count_ += structure.out_denominator.size();
  numerator_groups_ = group_by_functions(structure.out_numerator, structure.inputs, columns_);
  denominator_groups_ = group_by_functions(structure.out_denominator, structure.inputs, columns_);
  const std::size_t linear = structure.out_numerator.size();
  basis_memory_.resize(linear * rows_);
  basis_.assign(linear + 1, y_.data());
  bottom_.assign(rows_, 1.0);
  for (auto* values : {&q_, &fitted_, &residual_, &space_, &weight_, &part_, &slope_}) {
    values->resize(rows_);
  }
  jacobian_.resize(inner_count_ * rows_);
  coefficients_.resize(linear);
  // Multiplications of the Gram matrix and of the polynomials, four to a node.
  pass_cost_ = (linear * (linear + 1) / 8 + inner_count_ + linear + 4) * rows_;
}

void Projection::evaluate_arguments(std::span<const double> inner) {
  for (std::size_t i = 0; i < arguments_.size(); ++i) {
    Argument& a = arguments_[i];
    const double* coefficients = inner.data() + a.begin;
    columns::combine(a.numerator.data(), coefficients, a.numerator.size(), a.top.data(), rows_);
    if (a.denominator.empty()) {
      a.value = a.top;
    } else {
      columns::combine(a.denominator.data(), coefficients + a.numerator.size(),
                       a.denominator.size(), a.q.data(), rows_);
      denominator_from(denominators_, a.q, a.bottom);
      columns::div(a.top.data(), a.bottom.data(), a.value.data(), rows_);
    }
    apply_function(structure_.functions[i], Convention::exact, a.value.data(), a.g.data(), rows_);
  }
}

void Projection::evaluate_out_denominator(std::span<const double> inner) {
  if (denominator_groups_.empty()) return;
  std::ranges::fill(q_, 0.0);
  for (const MonomialGroup& group : denominator_groups_) {
    values_.clear();
    for (std::size_t place : group.places) values_.push_back(inner[denominator_begin_ + place]);
    columns::combine(group.columns.data(), values_.data(), values_.size(), part_.data(), rows_);
    const double* product = product_of(factors_, group.functions, kNoFactor, space_);
    if (product != nullptr) columns::mul(part_.data(), product, part_.data(), rows_);
    columns::add(q_.data(), part_.data(), q_.data(), rows_);
  }
  denominator_from(denominators_, q_, bottom_);
}

void Projection::make_basis() {
  const bool divides = !denominator_groups_.empty();
  for (const MonomialGroup& group : numerator_groups_) {
    const double* product = product_of(factors_, group.functions, kNoFactor, space_);
    for (std::size_t k = 0; k < group.columns.size(); ++k) {
      const std::size_t place = group.places[k];
      double* out = basis_memory_.data() + place * rows_;
      const double* column = group.columns[k];
      if (product != nullptr) {
        columns::mul(column, product, out, rows_);
        column = out;
      }
      if (divides) {
        columns::div(column, bottom_.data(), out, rows_);
        column = out;
      }
      basis_[place] = column;
    }
  }
}

// The linear coefficients from the Gram matrix of the basis and y.
bool Projection::solve_linear() {
  const std::size_t p = coefficients_.size();
  const std::size_t stride = p + 1;
  gram_.resize(stride * stride);
  columns::gram(basis_.data(), stride, rows_, gram_.data());
  if (!std::ranges::all_of(gram_, [](double x) { return std::isfinite(x); })) return false;
  factor_.resize(p * p);
  kept_.resize(p);
  for (std::size_t k = 0; k < p; ++k) {
    std::copy_n(gram_.begin() + static_cast<std::ptrdiff_t>(k * stride), p,
                factor_.begin() + static_cast<std::ptrdiff_t>(k * p));
  }
  cholesky_factor_semidefinite(factor_, p, kDependent, kept_);
  for (std::size_t k = 0; k < p; ++k) {
    coefficients_[k] = kept_[k] != 0 ? gram_[k * stride + p] : 0;
  }
  cholesky_solve(factor_, p, coefficients_);
  return true;
}

double Projection::sum_squares(std::span<const double> inner) {
  if (!budget_.spend(pass_cost_)) return std::numeric_limits<double>::quiet_NaN();
  inner_.assign(inner.begin(), inner.end());
  evaluate_arguments(inner);
  evaluate_out_denominator(inner);
  make_basis();
  if (!solve_linear()) return std::numeric_limits<double>::quiet_NaN();
  columns::combine(basis_.data(), coefficients_.data(), coefficients_.size(), fitted_.data(),
                   rows_);
  columns::sub(fitted_.data(), y_.data(), residual_.data(), rows_);
  return columns::dot(residual_.data(), residual_.data(), rows_);
}

// df/du_i times each monomial of the argument's numerator and denominator.
void Projection::write_inner_columns(const Argument& argument, std::span<const double> weight) {
  double* scaled = part_.data();
  columns::div(weight.data(), argument.bottom.data(), scaled, rows_);
  std::size_t k = argument.begin;
  for (const double* column : argument.numerator) {
    columns::mul(scaled, column, jacobian_column(k++), rows_);
  }
  if (argument.denominator.empty()) return;
  denominator_slope(denominators_, argument.q, slope_);
  columns::mul(scaled, argument.value.data(), scaled, rows_);
  columns::mul(scaled, slope_.data(), scaled, rows_);
  columns::mul(scaled, -1.0, scaled, rows_);
  for (const double* column : argument.denominator) {
    columns::mul(scaled, column, jacobian_column(k++), rows_);
  }
}

void Projection::write_out_denominator_columns() {
  if (denominator_groups_.empty()) return;
  denominator_slope(denominators_, q_, slope_);
  // df/dq = -f D' / D
  columns::div(fitted_.data(), bottom_.data(), weight_.data(), rows_);
  columns::mul(weight_.data(), slope_.data(), weight_.data(), rows_);
  columns::mul(weight_.data(), -1.0, weight_.data(), rows_);
  for (const MonomialGroup& group : denominator_groups_) {
    const double* product = product_of(factors_, group.functions, kNoFactor, space_);
    for (std::size_t k = 0; k < group.columns.size(); ++k) {
      double* out = jacobian_column(denominator_begin_ + group.places[k]);
      columns::mul(weight_.data(), group.columns[k], out, rows_);
      if (product != nullptr) columns::mul(out, product, out, rows_);
    }
  }
}

// Columns df / d inner at fixed linear coefficients.
void Projection::make_jacobian() {
  std::vector<double> out_slope(rows_);
  if (!denominator_groups_.empty()) {
    denominator_slope(denominators_, q_, out_slope);
    columns::mul(out_slope.data(), fitted_.data(), out_slope.data(), rows_);
  }
  for (std::size_t i = 0; i < arguments_.size(); ++i) {
    Argument& a = arguments_[i];
    std::ranges::fill(weight_, 0.0);
    // The numerator's part of df/dg_i, then the denominator's.
    const auto add = [&](const MonomialGroup& group, std::span<const double> coefficients,
                         std::size_t begin, bool of_denominator) {
      if (((group.functions >> i) & 1U) == 0) return;
      values_.clear();
      for (std::size_t place : group.places) values_.push_back(coefficients[begin + place]);
      columns::combine(group.columns.data(), values_.data(), values_.size(), part_.data(), rows_);
      const double* others = product_of(factors_, group.functions, i, space_);
      if (others != nullptr) columns::mul(part_.data(), others, part_.data(), rows_);
      if (of_denominator) {
        columns::mul(part_.data(), out_slope.data(), part_.data(), rows_);
        columns::mul(part_.data(), -1.0, part_.data(), rows_);
      }
      columns::add(weight_.data(), part_.data(), weight_.data(), rows_);
    };
    for (const auto& group : numerator_groups_) add(group, coefficients_, 0, false);
    for (const auto& group : denominator_groups_) {
      add(group, inner_, denominator_begin_, true);
    }
    if (!denominator_groups_.empty()) {
      columns::div(weight_.data(), bottom_.data(), weight_.data(), rows_);
    }
    function_slope(structure_.functions[i], Convention::exact, a.value.data(), a.g.data(),
                   slope_.data(), rows_);
    columns::mul(weight_.data(), slope_.data(), weight_.data(), rows_);
    write_inner_columns(a, weight_);
  }
  write_out_denominator_columns();
}

void Projection::normal_equations(NormalEquations& sums) {
  const std::size_t q = inner_count_;
  const std::size_t p = coefficients_.size();
  make_jacobian();
  std::vector<const double*> jacobian;
  for (std::size_t k = 0; k < q; ++k) jacobian.push_back(jacobian_column(k));
  sums.sum_squares = columns::dot(residual_.data(), residual_.data(), rows_);
  sums.curvature.resize(q * q);
  columns::gram(jacobian.data(), q, rows_, sums.curvature.data());
  sums.gradient.resize(q);
  for (std::size_t k = 0; k < q; ++k) {
    sums.gradient[k] = columns::dot(jacobian[k], residual_.data(), rows_);
  }
  // Take out what the linear coefficients can follow: J^T J - (L^-1 B^T J)^T (L^-1 B^T J).
  cross_products(jacobian, std::span(basis_).first(p), rows_, cross_);
  for (std::size_t k = 0; k < q; ++k) {
    const std::span<double> row = std::span(cross_).subspan(k * p, p);
    for (std::size_t i = 0; i < p; ++i) row[i] = kept_[i] != 0 ? row[i] : 0;
    cholesky_solve_lower(factor_, p, row);
  }
  for (std::size_t k = 0; k < q; ++k) {
    for (std::size_t l = 0; l <= k; ++l) {
      double taken = 0;
      for (std::size_t i = 0; i < p; ++i) taken += cross_[k * p + i] * cross_[l * p + i];
      const double left = sums.curvature[k * q + l] - taken;
      sums.curvature[k * q + l] = k == l ? std::max(left, 0.0) : left;
      sums.curvature[l * q + k] = sums.curvature[k * q + l];
    }
  }
}

std::vector<double> Projection::joint_curvature() {
  make_jacobian();
  std::vector<const double*> all(basis_.begin(), basis_.end() - 1);
  for (std::size_t k = 0; k < inner_count_; ++k) all.push_back(jacobian_column(k));
  std::vector<double> curvature(all.size() * all.size());
  columns::gram(all.data(), all.size(), rows_, curvature.data());
  return curvature;
}

Objective projected_objective(Projection& projection, const Budget& budget, bool& stop) {
  return
      [&, sums = NormalEquations()](std::span<const double> x, std::span<double> gradient) mutable {
        const double value = projection.sum_squares(x);
        stop = budget.exhausted();
        if (gradient.empty() || !std::isfinite(value)) return value;
        projection.normal_equations(sums);
        for (std::size_t k = 0; k < gradient.size(); ++k) gradient[k] = 2 * sums.gradient[k];
        return value;
      };
}

}  // namespace tribench::parfam
