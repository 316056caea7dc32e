// SPDX-License-Identifier: MIT
#include "algorithms/fitting/fit_intervals.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "algorithms/fitting/formula_jacobian.hpp"
#include "algorithms/fitting/free_constants.hpp"
#include "algorithms/fitting/symmetric_system.hpp"
#include "foundation/error.hpp"

namespace tribench {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
// Fewer movements say too little about how movements differ.
constexpr std::size_t kLeastMovements = 8;
// Of the largest eigenvalue of the scaled J^T J: below it a direction is not determined.
constexpr double kEigenTolerance = 1e-11;

// A symmetric matrix's inverse on the directions that are determined.
struct PseudoInverse {
  Eigen::MatrixXd inverse;
  Eigen::MatrixXd null_space;  // a column a direction that is not
  Eigen::Index rank() const { return inverse.rows() - null_space.cols(); }
};

PseudoInverse pseudo_inverse(const Eigen::MatrixXd& matrix) {
  const EigenParts parts = eigen_parts_symmetric(matrix);
  const Eigen::VectorXd& values = parts.values;
  const double least = kEigenTolerance * std::max(values.maxCoeff(), 0.0);
  Eigen::Index lost = 0;
  while (lost < values.size() && !(values[lost] > least)) ++lost;
  const Eigen::MatrixXd kept = parts.vectors.rightCols(values.size() - lost);
  const Eigen::VectorXd inverted = values.tail(values.size() - lost).cwiseInverse();
  return {kept * inverted.asDiagonal() * kept.transpose(), parts.vectors.leftCols(lost)};
}

// Nothing where a movement alone determines something.
std::optional<Eigen::MatrixXd> jackknife(const Eigen::MatrixXd& jacobian,
                                         const Eigen::VectorXd& residual,
                                         const std::map<int, std::vector<Eigen::Index>>& movements,
                                         Eigen::Index rank) {
  const Eigen::Index p = jacobian.cols();
  const Eigen::MatrixXd whole = jacobian.transpose() * jacobian;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(p, p);
  for (const auto& [movement, rows] : movements) {
    Eigen::MatrixXd part = Eigen::MatrixXd::Zero(p, p);
    Eigen::VectorXd score = Eigen::VectorXd::Zero(p);
    for (const Eigen::Index r : rows) {
      part += jacobian.row(r).transpose() * jacobian.row(r);
      score += jacobian.row(r).transpose() * residual[r];
    }
    const PseudoInverse rest = pseudo_inverse(whole - part);
    if (rest.rank() < rank) return std::nullopt;
    const Eigen::VectorXd moved = rest.inverse * score;
    covariance += moved * moved.transpose();
  }
  const auto count = static_cast<double>(movements.size());
  return covariance * ((count - 1) / count);
}

}  // namespace

double student_point(double freedom) {
  constexpr double kNormal = 1.959963984540054;
  if (freedom < 1.5) return 12.706204736432095;
  if (freedom < 2.5) return 4.302652729696142;
  // Abramowitz & Stegun 1964, 26.7.5.
  const double z = kNormal;
  const double z2 = z * z;
  const double g1 = (z2 + 1) * z / 4;
  const double g2 = ((5 * z2 + 16) * z2 + 3) * z / 96;
  const double g3 = (((3 * z2 + 19) * z2 + 17) * z2 - 15) * z / 384;
  const double g4 = ((((79 * z2 + 776) * z2 + 1482) * z2 - 1920) * z2 - 945) * z / 92160;
  return z + (g1 + (g2 + (g3 + g4 / freedom) / freedom) / freedom) / freedom;
}

namespace {

// The power of two next below the largest of these: squares of physical constants' units may come
// to nothing.
double size_of(const Eigen::Ref<const Eigen::VectorXd>& values) {
  int exponent = 0;
  std::frexp(values.cwiseAbs().maxCoeff(), &exponent);
  return std::ldexp(1.0, exponent - 1);
}

// The weighted rows of the formula linearised in its constants, a column a constant, of like
// lengths: `scale` brings back the constants' own. A column that is 0 everywhere stays, and is not
// determined.
struct LinearisedRows {
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd residual;
  Eigen::VectorXd scale;

  bool is_finite() const { return jacobian.allFinite() && residual.allFinite(); }
};

LinearisedRows linearise(const Expression& formula, const std::vector<std::size_t>& places,
                         const Inputs& inputs, std::span<const double> target,
                         std::span<const double> weights) {
  LinearisedRows rows;
  std::vector<double> values(inputs.rows);
  rows.jacobian = jacobian_of(formula, places, inputs, values);
  rows.residual.resize(static_cast<Eigen::Index>(inputs.rows));
  for (Eigen::Index r = 0; r < rows.residual.size(); ++r) {
    const auto row = static_cast<std::size_t>(r);
    const double root = weights.empty() ? 1 : std::sqrt(weights[row]);
    rows.residual[r] = root * (target[row] - values[row]);
    rows.jacobian.row(r) *= root;
  }
  rows.scale.resize(rows.jacobian.cols());
  for (Eigen::Index k = 0; k < rows.scale.size(); ++k) {
    const double size = size_of(rows.jacobian.col(k));
    const double length = (rows.jacobian.col(k) / size).norm();
    rows.scale[k] = length > 0 ? size * length : 1;
    rows.jacobian.col(k) /= rows.scale[k];
  }
  return rows;
}

// Of what no row determines, and is not told by it that way: of an eigenvector of length 1.
constexpr double kLost = 1e-6;

std::optional<Eigen::Index> redundant_number(const Expression& formula,
                                             const std::vector<std::size_t>& places,
                                             const Eigen::MatrixXd& null_space) {
  std::optional<Eigen::Index> smallest;
  const auto size_at = [&](Eigen::Index k) {
    return std::abs(formula.node(places[static_cast<std::size_t>(k)]).value);
  };
  for (Eigen::Index k = 0; k < null_space.rows(); ++k) {
    const bool is_candidate =
        size_at(k) == std::round(size_at(k)) && null_space.row(k).norm() > kLost;
    if (is_candidate && (!smallest || size_at(k) < size_at(*smallest))) smallest = k;
  }
  return smallest;
}

// Those of the directions in `null_space` that do not move constant k, without its row.
Eigen::MatrixXd without(Eigen::MatrixXd null_space, Eigen::Index k) {
  // A reflection that leaves the row one entry, in the last column (Householder 1958).
  const Eigen::Index last = null_space.cols() - 1;
  Eigen::VectorXd v = null_space.row(k).transpose();
  v[last] += std::copysign(v.norm(), v[last]);
  const Eigen::VectorXd along = null_space * v * (2 / v.squaredNorm());
  null_space -= along * v.transpose();
  Eigen::MatrixXd rest(null_space.rows() - 1, last);
  rest << null_space.topLeftCorner(k, last),
      null_space.bottomLeftCorner(null_space.rows() - 1 - k, last);
  return rest;
}

// Whole numbers without which the rows tell as much are the formula's form, as the 1 of
// 1 / (a + b x) is: beside them nothing would be determined. False where there is none.
bool hold_redundant_numbers(const Expression& formula, Eigen::MatrixXd null_space,
                            std::vector<std::size_t>& places, LinearisedRows& rows) {
  std::vector<Eigen::Index> kept(places.size());
  std::iota(kept.begin(), kept.end(), Eigen::Index{0});
  while (null_space.cols() > 0) {
    const auto number = redundant_number(formula, places, null_space);
    if (!number) break;
    places.erase(places.begin() + *number);
    kept.erase(kept.begin() + *number);
    null_space = without(std::move(null_space), *number);
  }
  if (kept.size() == static_cast<std::size_t>(rows.scale.size())) return false;
  rows.jacobian = rows.jacobian(Eigen::all, kept).eval();
  rows.scale = rows.scale(kept).eval();
  return true;
}

using RowsOfMovements = std::map<int, std::vector<Eigen::Index>>;

// A row without weight is none.
bool counts(std::span<const double> weights, std::size_t row) {
  return weights.empty() || weights[row] > 0;
}

RowsOfMovements rows_of_movements(std::span<const int> movement, std::span<const double> weights) {
  RowsOfMovements rows;
  for (std::size_t r = 0; r < movement.size(); ++r) {
    if (!counts(weights, r)) continue;
    rows[movement[r]].push_back(static_cast<Eigen::Index>(r));
  }
  return rows;
}

}  // namespace

FitIntervals fit_intervals(const Expression& formula, const Inputs& inputs,
                           std::span<const double> target, std::span<const int> movement,
                           std::span<const double> weights, bool known_variance) {
  FitIntervals result;
  result.places = free_constants(formula);
  std::size_t counted = 0;
  for (std::size_t r = 0; r < inputs.rows; ++r) counted += counts(weights, r) ? 1 : 0;
  const auto n = static_cast<Eigen::Index>(counted);
  result.unit = "row";
  result.units = counted;
  if (result.places.empty()) return result;
  constexpr std::size_t kMostConstants = 1000;  // a second; the time grows with the cube
  if (result.places.size() > kMostConstants) {
    throw_bad_input(fmt::format("the formula has {} constants", result.places.size()), {},
                    fmt::format("intervals are made of {} at most", kMostConstants));
  }
  LinearisedRows rows = linearise(formula, result.places, inputs, target, weights);
  if (!rows.is_finite()) {
    throw_bad_input("the formula has no finite derivative in some row", {},
                    "its constants have no intervals");
  }
  PseudoInverse base = pseudo_inverse(rows.jacobian.transpose() * rows.jacobian);
  if (hold_redundant_numbers(formula, base.null_space, result.places, rows)) {
    if (result.places.empty()) return result;
    base = pseudo_inverse(rows.jacobian.transpose() * rows.jacobian);
  }
  const auto p = static_cast<Eigen::Index>(result.places.size());
  const Eigen::Index rank = base.rank();
  if (n <= rank) {
    throw_bad_input(fmt::format("{} rows for {} constants", n, p), {},
                    "intervals need more rows than constants");
  }
  // Of the residual in this unit: in its own, squares may come to nothing.
  const double unit = known_variance ? 1 : size_of(rows.residual);
  rows.residual /= unit;
  const double variance =
      known_variance ? 1 : rows.residual.squaredNorm() / static_cast<double>(n - rank);
  Eigen::MatrixXd covariance = variance * base.inverse;
  result.quantile = student_point(known_variance ? 1e9 : static_cast<double>(n - rank));
  const RowsOfMovements movements = rows_of_movements(movement, weights);
  const bool grouped = movements.size() > 1 && movements.size() < counted && !known_variance;
  const std::size_t wanted = std::max(kLeastMovements, result.places.size() + 3);
  if (grouped && movements.size() < wanted) {
    result.warning = fmt::format(
        "the rows come in {} movements, and {} are needed to be the units: rows are, as if they "
        "were independent; where those of a movement are alike the intervals are too narrow",
        movements.size(), wanted);
  } else if (grouped) {
    if (const auto robust = jackknife(rows.jacobian, rows.residual, movements, rank)) {
      covariance = *robust;
      result.unit = "movement";
      result.units = movements.size();
      result.quantile = student_point(static_cast<double>(movements.size() - 1));
    }
  }
  const Eigen::VectorXd own = unit * rows.scale.cwiseInverse();
  covariance = own.asDiagonal() * covariance * own.asDiagonal();
  for (Eigen::Index k = 0; k < p; ++k) {
    const double value = formula.node(result.places[static_cast<std::size_t>(k)]).value;
    const bool lost = rank < p && base.null_space.row(k).norm() > kLost;
    const double half = lost ? kMissing : result.quantile * std::sqrt(covariance(k, k));
    result.constants.push_back({value, value - half, value + half});
    for (Eigen::Index l = 0; l < p; ++l) result.covariance.push_back(covariance(k, l));
  }
  return result;
}

std::vector<double> curve_half_widths(const Expression& formula, const FitIntervals& intervals,
                                      const Inputs& inputs) {
  std::vector<double> halves(inputs.rows, 0);
  const auto p = static_cast<Eigen::Index>(intervals.places.size());
  if (p == 0) return halves;
  std::vector<double> values(inputs.rows);
  const Eigen::MatrixXd jacobian = jacobian_of(formula, intervals.places, inputs, values);
  const Eigen::Map<const Eigen::MatrixXd> covariance(intervals.covariance.data(), p, p);
  for (std::size_t r = 0; r < halves.size(); ++r) {
    const Eigen::VectorXd slope = jacobian.row(static_cast<Eigen::Index>(r)).transpose();
    halves[r] = intervals.quantile * std::sqrt(std::max(0.0, slope.dot(covariance * slope)));
  }
  return halves;
}

double mean_curve_variance(const Expression& formula, const Inputs& fitted,
                           std::span<const double> target, const Inputs& others) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  constexpr double kMoves = 1e-6;  // of a row's whole slope
  const std::vector<std::size_t> places = free_constants(formula);
  if (places.empty() || others.rows == 0) return 0;
  std::vector<double> values(others.rows);
  const Eigen::MatrixXd jacobian = jacobian_of(formula, places, others, values);
  const LinearisedRows rows = linearise(formula, places, fitted, target, {});
  if (!jacobian.allFinite() || !rows.is_finite()) return 0;
  const PseudoInverse base = pseudo_inverse(rows.jacobian.transpose() * rows.jacobian);
  const auto freedom = static_cast<double>(rows.residual.size() - base.rank());
  if (freedom <= 0) return kInfinite;
  const Eigen::MatrixXd slopes = jacobian * rows.scale.cwiseInverse().asDiagonal();
  if ((slopes * base.null_space).norm() > kMoves * slopes.norm()) return kInfinite;
  const double sum = (slopes * base.inverse).cwiseProduct(slopes).sum();
  return rows.residual.squaredNorm() / freedom * sum / static_cast<double>(others.rows);
}

}  // namespace tribench
