// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/rich_model.hpp"

#include <algorithm>
#include <cmath>

#include "algorithms/fitting/symmetric_system.hpp"
#include "algorithms/inference/column_products.hpp"

namespace tribench::loop {
namespace {

constexpr double kRidge = 1e-4;  // of the mean diagonal
constexpr std::size_t kAtomsOfFamily = 4;
constexpr double kHuber = 2;  // standard deviations

// The base's linear terms and the library, without what differs by direction or stands beside
// another. Neighbours on a grid of shapes say nearly the same: some of them will do.
std::vector<Expression> rich_columns(const Observations& data, const BaseModel& base,
                                     const std::vector<EffectFamily>& families,
                                     const std::vector<double>& gear_ratios) {
  std::vector<Expression> formulas = base.linear_terms;
  for (std::size_t f = 0; f < families.size(); ++f) {
    std::vector<std::string> missing;
    std::vector<Atom> atoms = instantiate(families[f], f, data, gear_ratios, missing);
    std::erase_if(atoms, [](const Atom& atom) { return atom.beside_another || atom.one_way; });
    const std::size_t step = (atoms.size() + kAtomsOfFamily - 1) / kAtomsOfFamily;
    for (std::size_t k = 0; k < atoms.size(); k += std::max<std::size_t>(1, step)) {
      formulas.insert(formulas.end(), atoms[k].columns.begin(), atoms[k].columns.end());
    }
  }
  return formulas;
}

Eigen::MatrixXd of_unit_length(Eigen::MatrixXd x) {
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    const double norm = x.col(j).norm();
    x.col(j) = norm > 0 && std::isfinite(norm) ? Eigen::VectorXd(x.col(j) / norm)
                                               : Eigen::VectorXd::Zero(x.rows());
  }
  return x;
}

}  // namespace

Eigen::VectorXd rich_residual(const Observations& data, const std::vector<char>& train_rows,
                              const BaseModel& base, const std::vector<EffectFamily>& families,
                              const DiagnosisOptions& options) {
  Eigen::VectorXd y = target_vector(data);
  if (!base.formula.empty()) {
    LoopModel model;
    model.base.formula = base.formula;
    y -= predict(model, data);
  }
  const Eigen::MatrixXd x = of_unit_length(
      evaluate_columns(rich_columns(data, base, families, options.gear_ratios), data));
  std::vector<Eigen::Index> train;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    if (train_rows[i] != 0) train.push_back(static_cast<Eigen::Index>(i));
  }
  const Eigen::MatrixXd rows = x(train, Eigen::all);
  Eigen::MatrixXd normal = gram_of(rows);
  Eigen::VectorXd right = cross_products(rows, y(train));
  const auto residual_of = [&] {
    Eigen::MatrixXd loaded = normal;
    loaded.diagonal().array() += kRidge * normal.trace() / static_cast<double>(normal.rows());
    return Eigen::VectorXd(y - x * solve_symmetric(loaded, right));
  };
  const Eigen::VectorXd residual = residual_of();
  // Huber's weights keep bursts from bending the model; few rows have one below 1.
  const double sd =
      std::sqrt(residual(train).squaredNorm() / std::max(1.0, static_cast<double>(train.size())));
  std::vector<Eigen::Index> wild;
  for (const Eigen::Index i : train) {
    if (std::abs(residual[i]) > kHuber * sd) wild.push_back(i);
  }
  if (wild.empty()) return residual;
  const Eigen::VectorXd lost = 1 - kHuber * sd / residual(wild).array().abs();
  const Eigen::MatrixXd wild_rows = lost.cwiseSqrt().asDiagonal() * x(wild, Eigen::all);
  normal -= gram_of(wild_rows);
  right -= cross_products(wild_rows, lost.cwiseSqrt().cwiseProduct(y(wild)));
  return residual_of();
}

}  // namespace tribench::loop
