// SPDX-License-Identifier: MIT
#include "algorithms/parfam/denominators.hpp"

#include <algorithm>

#include "algorithms/parfam/base_functions.hpp"

namespace tribench::parfam {
namespace {

// The part of a monomial in the inputs.
double input_part(const Monomial& monomial, std::span<const double> point) {
  double product = 1;
  for (std::size_t j = 0; j < point.size(); ++j) {
    for (int e = 0; e < monomial[j]; ++e) product *= point[j];
  }
  return product;
}

// A function's argument at the point, and what its parameters do to it.
struct Argument {
  std::size_t begin = 0;  // among the inner parameters
  std::vector<double> numerator;
  std::vector<double> denominator;
  double bottom = 1;
  double value = 0;
  double g = 0;
  double slope = 0;
};

std::vector<Argument> arguments_at(const Structure& structure, std::span<const double> inner,
                                   std::span<const double> point) {
  std::vector<Argument> arguments(structure.functions.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    Argument& a = arguments[i];
    a.begin = next;
    double top = 0;
    for (const Monomial& m : structure.numerators[i]) {
      a.numerator.push_back(input_part(m, point));
      top += inner[next++] * a.numerator.back();
    }
    for (const Monomial& m : structure.denominators[i]) {
      a.denominator.push_back(input_part(m, point));
      a.bottom += inner[next++] * a.denominator.back();
    }
    a.value = top / a.bottom;
    apply_function(structure.functions[i], Convention::exact, &a.value, &a.g, 1);
    function_slope(structure.functions[i], Convention::exact, &a.value, &a.g, &a.slope, 1);
  }
  return arguments;
}

// Adds weight * dg_i / dinner to a row of the Jacobian.
void add_slope(const Argument& a, double weight, std::span<double> row) {
  const double scaled = weight * a.slope / a.bottom;
  std::size_t k = a.begin;
  for (double m : a.numerator) row[k++] += scaled * m;
  for (double m : a.denominator) row[k++] -= scaled * a.value * m;
}

// The output's denominator; its derivatives into row where that is not empty.
double out_denominator_at(const Structure& structure, std::span<const double> inner,
                          std::span<const double> point, const std::vector<Argument>& arguments,
                          std::span<double> row) {
  const std::size_t begin = inner.size() - structure.out_denominator.size();
  double value = 1;
  for (std::size_t k = 0; k < structure.out_denominator.size(); ++k) {
    const Monomial& monomial = structure.out_denominator[k];
    const double part = input_part(monomial, point);
    const auto product_without = [&](std::size_t skipped) {
      double product = part;
      for (std::size_t i = 0; i < arguments.size(); ++i) {
        if (i != skipped && monomial[structure.inputs + i] != 0) product *= arguments[i].g;
      }
      return product;
    };
    const double whole = product_without(arguments.size());
    value += inner[begin + k] * whole;
    if (row.empty()) continue;
    row[begin + k] += whole;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      if (monomial[structure.inputs + i] == 0) continue;
      add_slope(arguments[i], inner[begin + k] * product_without(i), row);
    }
  }
  return value;
}

}  // namespace

std::size_t count_denominators(const Structure& structure) {
  const auto inside =
      std::ranges::count_if(structure.denominators, [](const auto& list) { return !list.empty(); });
  return static_cast<std::size_t>(inside) + (structure.out_denominator.empty() ? 0 : 1);
}

void denominators_at(const Structure& structure, std::span<const double> inner,
                     std::span<const double> point, std::span<double> values,
                     std::span<double> jacobian) {
  const std::vector<Argument> arguments = arguments_at(structure, inner, point);
  const std::size_t n = inner.size();
  std::ranges::fill(jacobian, 0.0);
  std::size_t next = 0;
  for (const Argument& a : arguments) {
    if (a.denominator.empty()) continue;
    values[next] = a.bottom;
    for (std::size_t k = 0; k < a.denominator.size() && !jacobian.empty(); ++k) {
      jacobian[next * n + a.begin + a.numerator.size() + k] = a.denominator[k];
    }
    ++next;
  }
  if (structure.out_denominator.empty()) return;
  values[next] = out_denominator_at(structure, inner, point, arguments,
                                    jacobian.empty() ? jacobian : jacobian.subspan(next * n, n));
}

}  // namespace tribench::parfam
