// SPDX-License-Identifier: MIT
#include "algorithms/campaign/rich_model.hpp"

#include <algorithm>

#include "algorithms/inference/robust_ridge.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kAtomsOfFamily = 4;

}  // namespace

Eigen::MatrixXd rich_columns(const Observations& data, const BaseModel& base,
                             const std::vector<EffectFamily>& families,
                             const std::vector<double>& gear_ratios) {
  std::vector<Expression> formulas = base.linear_terms;
  for (std::size_t f = 0; f < families.size(); ++f) {
    std::vector<std::string> missing;
    std::vector<Atom> atoms = instantiate(families[f], f, data, gear_ratios, missing);
    std::erase_if(atoms, [](const Atom& atom) {
      return atom.beside_another || atom.one_way || atom.last_resort;
    });
    const std::size_t step = (atoms.size() + kAtomsOfFamily - 1) / kAtomsOfFamily;
    for (std::size_t k = 0; k < atoms.size(); k += std::max<std::size_t>(1, step)) {
      formulas.insert(formulas.end(), atoms[k].columns.begin(), atoms[k].columns.end());
    }
  }
  return evaluate_columns(formulas, data);
}

Eigen::VectorXd rich_residual(const Observations& data, const std::vector<char>& train_rows,
                              const BaseModel& base, const std::vector<EffectFamily>& families,
                              const DiagnosisOptions& options) {
  Eigen::VectorXd y = target_vector(data);
  if (!base.formula.empty()) {
    LoopModel model;
    model.base.formula = base.formula;
    y -= predict(model, data);
  }
  std::vector<Eigen::Index> train;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    if (train_rows[i] != 0) train.push_back(static_cast<Eigen::Index>(i));
  }
  return robust_ridge_residual(rich_columns(data, base, families, options.gear_ratios), y, train);
}

}  // namespace tribench::loop
