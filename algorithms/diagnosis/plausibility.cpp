// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/plausibility.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "algorithms/inference/whitening.hpp"

namespace tribench::loop {
namespace {

bool reads_velocity_alone(const Expression& formula, const Observations& data) {
  return std::ranges::all_of(formula.nodes(), [&](const Node& node) {
    if (!node.is_variable()) return true;
    const std::string& name = data.signals[node.variable].name;
    return name == "v" || name == "sgn_v";
  });
}

// Friction by the base and one family, as far as they read the velocity alone.
Eigen::VectorXd friction_of_speed(const LoopModel& model, std::size_t family,
                                  const Observations& data) {
  std::vector<Expression> terms;
  std::vector<double> coefficients;
  const auto take = [&](const Expression& term, std::size_t column) {
    if (!reads_velocity_alone(term, data)) return;
    terms.push_back(term);
    coefficients.push_back(model.coefficients[static_cast<Eigen::Index>(column)]);
  };
  for (std::size_t k = 0; k < model.base.linear_terms.size(); ++k) {
    take(model.base.linear_terms[k], k);
  }
  for (std::size_t k = 0; k < model.atoms.size(); ++k) {
    if (model.atoms[k].family != family) continue;
    for (std::size_t j = 0; j < model.atoms[k].columns.size(); ++j) {
      take(model.atoms[k].columns[j], model.first_column(k) + j);
    }
  }
  return evaluate_columns(terms, data) *
         Eigen::Map<const Eigen::VectorXd>(coefficients.data(),
                                           static_cast<Eigen::Index>(coefficients.size()));
}

// Whether a column of the atom that its family's rule speaks of has the other sign. Two columns
// whose signs differ do not tell the cause by their sum: they cancel each other.
bool has_impossible_sign(const LoopModel& model, std::size_t atom, const Sanity& sanity) {
  const std::vector<std::string>& names = model.atoms[atom].coefficients;
  for (std::size_t j = 0; j < names.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(model.first_column(atom) + j);
    if (names[j] == sanity.coefficient && sanity.sign * model.coefficients[column] < 0) return true;
  }
  return false;
}

// Whether a family has the sign that its cause cannot have.
bool has_impossible_sign(const LoopModel& model, const std::vector<EffectFamily>& families) {
  for (std::size_t k = 0; k < model.atoms.size(); ++k) {
    const std::size_t family = model.atoms[k].family;
    const bool is_impossible = std::ranges::any_of(
        families[family].sanity,
        [&](const Sanity& sanity) { return has_impossible_sign(model, k, sanity); });
    if (is_impossible) return true;
  }
  return false;
}

// How many times more of a torque there is beside the base than beside the rest of the model.
double inflation(const Eigen::MatrixXd& torque, const Eigen::MatrixXd& rest_basis,
                 const Eigen::MatrixXd& base_basis) {
  return project_off(torque, base_basis).squaredNorm() /
         project_off(torque, rest_basis).squaredNorm();
}

}  // namespace

bool stands_for_another_cause(const LoopModel& model, const Campaign& campaign) {
  if (!campaign.options.physical_vetoes) return false;
  if (has_impossible_sign(model, campaign.families)) return true;
  // A base that is a formula has its own curve, which nobody knows.
  if (!model.base.formula.empty()) return false;
  return std::ranges::any_of(model.atoms, [&](const Atom& atom) {
    if (atom.curve == SpeedCurve::any) return false;
    const Eigen::VectorXd friction = friction_of_speed(model, atom.family, campaign.data);
    const std::span<const double> rows(friction.data(), static_cast<std::size_t>(friction.size()));
    const bool falls = falls_with_speed(rows, campaign.data.find("v")->values);
    return falls != (atom.curve == SpeedCurve::falls);
  });
}

std::string physical_objection(const EffectFinding& finding, const EffectFamily& known) {
  for (const Sanity& sanity : known.sanity) {
    // Against the whole interval: a value that is only perhaps unphysical stands.
    double low = 0;
    double high = 0;
    for (const ParameterFinding& p : finding.parameters) {
      if (p.name != sanity.coefficient) continue;
      low += p.low;
      high += p.high;
    }
    const bool wrong_sign = sanity.sign * low < 0 && sanity.sign * high < 0;
    const bool too_large = sanity.largest > 0 &&
                           std::min(std::abs(low), std::abs(high)) > sanity.largest &&
                           low * high > 0;
    if (wrong_sign || too_large) return sanity.why;
  }
  return {};
}

bool is_told_by_others(std::size_t family, const FittedModel& fit, const Campaign& campaign) {
  if (!campaign.options.has("cancelling")) return false;
  const LoopModel& model = fit.model;
  const auto base = static_cast<Eigen::Index>(model.first_column(0));
  Eigen::MatrixXd rest = fit.x.leftCols(base);
  const Eigen::MatrixXd base_basis = orthonormal_basis(rest);
  for (std::size_t k = 0; k < model.atoms.size(); ++k) {
    if (model.atoms[k].family == family) continue;
    rest = beside(rest, fit.x.middleCols(static_cast<Eigen::Index>(model.first_column(k)),
                                         static_cast<Eigen::Index>(model.atoms[k].columns.size())));
  }
  if (rest.cols() == base) return false;
  const Eigen::MatrixXd torque =
      whitened(contribution(model, family, campaign.data), campaign.clusters, fit.noise);
  return inflation(torque, orthonormal_basis(rest), base_basis) > kLargeVif;
}

bool is_told_by_another_name(std::size_t family, const LoopModel& other, const FittedModel& fit,
                             const Campaign& campaign) {
  if (fit.model.atoms_of(family) > 0) return false;
  const Eigen::MatrixXd torque =
      whitened(contribution(other, family, campaign.data), campaign.clusters, fit.noise);
  const Eigen::MatrixXd base = fit.x.leftCols(static_cast<Eigen::Index>(fit.model.first_column(0)));
  return inflation(torque, fit.basis, orthonormal_basis(base)) > kLargeVif;
}

}  // namespace tribench::loop
