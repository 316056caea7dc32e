// SPDX-License-Identifier: MIT
#include "algorithms/parfam/published_model.hpp"

#include <algorithm>
#include <cmath>

#include "algorithms/expression/column_kernels.hpp"

namespace tribench::parfam {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

}  // namespace

void normalise(std::span<double> coefficients) {
  double squares = 0;
  for (double c : coefficients) squares += c * c;
  if (squares == 0) return;
  const double norm = std::sqrt(squares);
  for (double& c : coefficients) c /= norm;
}

PublishedModel::PublishedModel(const Structure& structure, std::span<const double* const> inputs,
                               std::size_t rows, const PublishedModelOptions& options)
    : structure_(structure),
      rows_(rows),
      options_(options),
      columns_(inputs, rows),
      inner_(structure.functions.size()),
      function_values_(structure.functions.size(), std::vector<double>(rows)),
      function_seeds_(structure.functions.size(), std::vector<double>(rows)),
      sum_(rows),
      product_(rows),
      weighted_(rows),
      slope_(rows),
      numerator_seed_(rows),
      denominator_seed_(rows),
      residual_(rows) {
  std::size_t next = 0;
  const auto set_up = [&](Rational& ratio, const std::vector<Monomial>& numerator,
                          const std::vector<Monomial>& denominator) {
    ratio.numerator = group_by_functions(numerator, structure.inputs, columns_);
    ratio.denominator = group_by_functions(denominator, structure.inputs, columns_);
    ratio.numerator_begin = next;
    ratio.denominator_begin = next + numerator.size();
    ratio.denominator_size = denominator.size();
    next = ratio.denominator_begin + denominator.size();
    ratio.top.resize(rows);
    ratio.bottom.assign(rows, 1.0);
    ratio.value.resize(rows);
    ratio.guarded.assign(rows, 0);
  };
  for (std::size_t i = 0; i < inner_.size(); ++i) {
    set_up(inner_[i], structure.numerators[i], structure.denominators[i]);
  }
  set_up(output_, structure.out_numerator, structure.out_denominator);
}

const double* PublishedModel::product_of(unsigned functions, std::size_t without,
                                         std::vector<double>& space) {
  const double* product = nullptr;
  for (std::size_t i = 0; i < function_values_.size(); ++i) {
    if (((functions >> i) & 1U) == 0 || i == without) continue;
    if (product == nullptr) {
      product = function_values_[i].data();
    } else {
      columns::mul(product, function_values_[i].data(), space.data(), rows_);
      product = space.data();
    }
  }
  return product;
}

// values = sum over the groups of (polynomial in the inputs) x (product of functions).
void PublishedModel::add_groups(const std::vector<MonomialGroup>& groups,
                                const double* coefficients, std::vector<double>& values) {
  bool first = true;
  for (const MonomialGroup& group : groups) {
    coefficients_.clear();
    for (std::size_t place : group.places) coefficients_.push_back(coefficients[place]);
    double* out = first ? values.data() : sum_.data();
    columns::combine(group.columns.data(), coefficients_.data(), coefficients_.size(), out, rows_);
    const double* product = product_of(group.functions, kNone, product_);
    if (product != nullptr) columns::mul(out, product, out, rows_);
    if (!first) columns::add(values.data(), out, values.data(), rows_);
    first = false;
  }
}

void PublishedModel::evaluate_ratio(Rational& ratio, std::span<const double> theta) {
  add_groups(ratio.numerator, theta.data() + ratio.numerator_begin, ratio.top);
  if (ratio.denominator.empty()) {
    ratio.value = ratio.top;
    return;
  }
  const auto raw = theta.subspan(ratio.denominator_begin, ratio.denominator_size);
  ratio.unit.assign(raw.begin(), raw.end());
  double squares = 0;
  for (double c : raw) squares += c * c;
  ratio.norm = squares == 0 ? 1 : std::sqrt(squares);
  normalise(ratio.unit);
  add_groups(ratio.denominator, ratio.unit.data(), ratio.bottom);
  for (std::size_t r = 0; r < rows_; ++r) {
    ratio.guarded[r] = std::abs(ratio.bottom[r]) < options_.denominator_floor ? 1 : 0;
    if (ratio.guarded[r] != 0) ratio.bottom[r] = options_.denominator_floor;
  }
  columns::div(ratio.top.data(), ratio.bottom.data(), ratio.value.data(), rows_);
}

std::span<const double> PublishedModel::evaluate(std::span<const double> theta) {
  for (std::size_t i = 0; i < inner_.size(); ++i) {
    evaluate_ratio(inner_[i], theta);
    std::vector<double>& values = function_values_[i];
    apply_function(structure_.functions[i], Convention::published, inner_[i].value.data(),
                   values.data(), rows_);
    if (!options_.single_precision_hidden) continue;
    for (double& value : values) value = static_cast<double>(static_cast<float>(value));
  }
  evaluate_ratio(output_, theta);
  theta_.assign(theta.begin(), theta.end());
  return output_.value;
}

void PublishedModel::pull_groups(const std::vector<MonomialGroup>& groups,
                                 const double* coefficients, std::span<const double> seed,
                                 double* gradient) {
  std::vector<double> own;
  for (const MonomialGroup& group : groups) {
    const double* product = product_of(group.functions, kNone, product_);
    const double* weighted = seed.data();
    if (product != nullptr) {
      columns::mul(seed.data(), product, weighted_.data(), rows_);
      weighted = weighted_.data();
    }
    const std::size_t count = group.columns.size();
    for (std::size_t k = 0; k < count; k += 4) {
      const double* four[4];
      for (std::size_t j = 0; j < 4; ++j) four[j] = group.columns[std::min(k + j, count - 1)];
      double sums[4];
      columns::dot4(weighted, four, rows_, sums);
      for (std::size_t j = 0; j < 4 && k + j < count; ++j) {
        gradient[group.places[k + j]] = sums[j];
      }
    }
    if (group.functions == 0) continue;
    own.clear();
    for (std::size_t place : group.places) own.push_back(coefficients[place]);
    columns::combine(group.columns.data(), own.data(), count, sum_.data(), rows_);
    columns::mul(sum_.data(), seed.data(), sum_.data(), rows_);
    for (std::size_t i = 0; i < function_seeds_.size(); ++i) {
      if (((group.functions >> i) & 1U) == 0) continue;
      const double* others = product_of(group.functions, i, product_);
      const double* part = sum_.data();
      if (others != nullptr) {
        columns::mul(part, others, weighted_.data(), rows_);
        part = weighted_.data();
      }
      columns::add(function_seeds_[i].data(), part, function_seeds_[i].data(), rows_);
    }
  }
}

void PublishedModel::pull_ratio(Rational& ratio, std::span<const double> seed,
                                std::span<double> gradient) {
  const double* theta = theta_.data();
  if (ratio.denominator.empty()) {
    pull_groups(ratio.numerator, theta + ratio.numerator_begin, seed,
                gradient.data() + ratio.numerator_begin);
    return;
  }
  columns::div(seed.data(), ratio.bottom.data(), numerator_seed_.data(), rows_);
  for (std::size_t r = 0; r < rows_; ++r) {
    denominator_seed_[r] = ratio.guarded[r] != 0 ? 0 : -numerator_seed_[r] * ratio.value[r];
  }
  pull_groups(ratio.numerator, theta + ratio.numerator_begin, numerator_seed_,
              gradient.data() + ratio.numerator_begin);
  double* wanted = gradient.data() + ratio.denominator_begin;
  pull_groups(ratio.denominator, ratio.unit.data(), denominator_seed_, wanted);
  // Through the division by the norm: what points along the coefficients drops out.
  double along = 0;
  for (std::size_t k = 0; k < ratio.denominator_size; ++k) along += wanted[k] * ratio.unit[k];
  for (std::size_t k = 0; k < ratio.denominator_size; ++k) {
    wanted[k] = (wanted[k] - along * ratio.unit[k]) / ratio.norm;
  }
}

void PublishedModel::pull_back(std::span<const double> seed, std::span<double> gradient) {
  for (auto& seeds : function_seeds_) std::ranges::fill(seeds, 0.0);
  pull_ratio(output_, seed, gradient);
  for (std::size_t i = 0; i < inner_.size(); ++i) {
    function_slope(structure_.functions[i], Convention::published, inner_[i].value.data(),
                   function_values_[i].data(), slope_.data(), rows_);
    columns::mul(function_seeds_[i].data(), slope_.data(), slope_.data(), rows_);
    pull_ratio(inner_[i], slope_, gradient);
  }
}

double PublishedModel::loss(std::span<const double> theta, std::span<const double> y, double lambda,
                            std::span<double> gradient) {
  const std::span<const double> f = evaluate(theta);
  columns::sub(f.data(), y.data(), residual_.data(), rows_);
  const double error = std::sqrt(columns::dot(residual_.data(), residual_.data(), rows_));
  const double size = std::sqrt(columns::dot(y.data(), y.data(), rows_));
  double penalty = 0;
  for (double value : theta) penalty += std::abs(value);
  if (!gradient.empty()) {
    // The norm has no slope at 0: a perfect fit is left alone.
    const double factor = error > 0 ? 1 / (error * size) : 0;
    columns::mul(residual_.data(), factor, residual_.data(), rows_);
    pull_back(residual_, gradient);
    for (std::size_t k = 0; k < theta.size(); ++k) {
      gradient[k] +=
          lambda * (static_cast<double>(theta[k] > 0) - static_cast<double>(theta[k] < 0));
    }
  }
  return error / size + lambda * penalty;
}

}  // namespace tribench::parfam
