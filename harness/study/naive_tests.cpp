// SPDX-License-Identifier: MIT
#include "harness/study/naive_tests.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "algorithms/effects/effect_library.hpp"
#include "algorithms/inference/score_test.hpp"
#include "algorithms/loop_model/loop_model.hpp"
#include "foundation/elementary.hpp"
#include "foundation/incomplete_gamma.hpp"

namespace tribench {
namespace {

constexpr double kFalseDiscoveryRate = 0.05;

// Benjamini and Hochberg 1995: whether anything is rejected.
bool any_rejected(std::vector<double> p) {
  std::ranges::sort(p);
  for (std::size_t k = 0; k < p.size(); ++k) {
    if (p[k] <= kFalseDiscoveryRate * static_cast<double>(k + 1) / static_cast<double>(p.size())) {
      return true;
    }
  }
  return false;
}

}  // namespace

NaiveFindings test_naively(const loop::Observations& data, double gear_ratio) {
  const std::vector<double> ratios = {gear_ratio};
  const loop::BaseModel base = loop::coulomb_viscous_base(data);
  const Eigen::MatrixXd basis =
      loop::orthonormal_basis(loop::evaluate_columns(base.linear_terms, data));
  const Eigen::VectorXd residual = loop::project_off(loop::target_vector(data), basis);
  const auto n = static_cast<double>(data.rows());
  const double before = residual.squaredNorm();
  NaiveFindings findings;
  std::vector<double> family_p;
  const std::vector<loop::EffectFamily>& families = loop::builtin_effects();
  for (std::size_t f = 0; f < families.size(); ++f) {
    std::vector<std::string> missing;
    double smallest = 1;
    for (const loop::Atom& atom : loop::instantiate(families[f], f, data, ratios, missing)) {
      const Eigen::MatrixXd columns = loop::evaluate_columns(atom.columns, data);
      const Eigen::MatrixXd z = loop::project_off(columns, basis);
      if (z.squaredNorm() < 1e-3 * columns.squaredNorm()) continue;
      const Eigen::MatrixXd own = loop::orthonormal_basis(z);
      const double explained = (own.transpose() * residual).squaredNorm();
      const auto p = static_cast<double>(own.cols());
      // With thousands of rows p F is chi-squared with p degrees of freedom.
      const double chi = explained / ((before - explained) / (n - p));
      smallest = std::min(smallest, elementary::exp(log_gamma_upper_tail(p / 2, chi / 2)));
      if (n * elementary::log((before - explained) / before) + p * elementary::log(n) < 0)
        findings.bic = true;
    }
    family_p.push_back(smallest);
  }
  findings.f_test = any_rejected(family_p);
  return findings;
}

}  // namespace tribench
