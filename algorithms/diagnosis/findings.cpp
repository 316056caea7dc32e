// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "algorithms/fitting/symmetric_system.hpp"

namespace tribench::loop {
namespace {

constexpr double kNormalQuantile = 1.959964;
constexpr std::size_t kEnoughMovements = 20;
constexpr double kLargeVif = 10;

// Sandwich covariance of the tangent's parameters, clusters being the movements where there are
// enough of them, else the stretches.
struct Covariance {
  Eigen::MatrixXd robust;
  Eigen::VectorXd vif;
};

Covariance covariance_of(const FittedModel& fit, const Clusters& clusters) {
  const Eigen::VectorXd norms = fit.x.colwise().norm().cwiseMax(1e-300);
  const Eigen::MatrixXd x = fit.x * norms.cwiseInverse().asDiagonal();
  Eigen::MatrixXd normal = x.transpose() * x;
  normal.diagonal().array() += 1e-10;
  const Eigen::MatrixXd inverse = inverse_symmetric(normal);
  const bool by_movement = clusters.movements.size() >= kEnoughMovements;
  const std::vector<RowRange>& groups = by_movement ? clusters.movements : clusters.stretches;
  Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(x.cols(), x.cols());
  for (const RowRange& range : groups) {
    const auto begin = static_cast<Eigen::Index>(range.begin);
    const auto size = static_cast<Eigen::Index>(range.size());
    const Eigen::VectorXd sum =
        x.middleRows(begin, size).transpose() * fit.residual.segment(begin, size);
    meat += sum * sum.transpose();
  }
  const auto count = static_cast<double>(groups.size());
  const auto parameters = static_cast<double>(x.cols());
  const double correction = count / std::max(1.0, count - parameters);
  const Eigen::MatrixXd back = norms.cwiseInverse().asDiagonal();
  // Columns have unit length: the inverse's diagonal is 1 / (1 - R^2).
  return {correction * back * inverse * meat * inverse * back, inverse.diagonal()};
}

ParameterFinding parameter(std::string name, double value, double variance) {
  const double half = kNormalQuantile * std::sqrt(std::max(0.0, variance));
  return {std::move(name), value, value - half, value + half};
}

// Where the shapes of an atom stand in the tangent: after the linear columns, in atoms' order.
std::size_t first_shape_column(const LoopModel& model, std::size_t atom, std::size_t columns) {
  std::size_t after = 0;
  for (std::size_t k = atom; k < model.atoms.size(); ++k) {
    for (const Shape& shape : model.atoms[k].shapes) after += shape.refined() ? 1 : 0;
  }
  return columns - after;
}

void add_parameters(EffectFinding& finding, const FittedModel& fit, const Covariance& covariance,
                    std::size_t atom) {
  const LoopModel& model = fit.model;
  const Atom& a = model.atoms[atom];
  const std::size_t first = model.first_column(atom);
  for (std::size_t c = 0; c < a.columns.size(); ++c) {
    const auto j = static_cast<Eigen::Index>(first + c);
    finding.parameters.push_back(
        parameter(a.coefficients[c], model.coefficients[j], covariance.robust(j, j)));
    finding.vif = std::max(finding.vif, covariance.vif[j]);
  }
  auto j = static_cast<Eigen::Index>(
      first_shape_column(model, atom, static_cast<std::size_t>(fit.x.cols())));
  for (const Shape& shape : a.shapes) {
    if (shape.refined()) {
      ParameterFinding found = parameter(shape.name, shape.value, covariance.robust(j, j));
      found.low = std::max(found.low, shape.low);
      found.high = std::min(found.high, shape.high);
      finding.parameters.push_back(found);
      const double margin = 1e-3 * (shape.high - shape.low);
      if (shape.value < shape.low + margin || shape.value > shape.high - margin) {
        finding.notes.push_back(
            fmt::format("{} has come to the end of the range that is looked at: it may lie beyond",
                        shape.name));
      }
      ++j;
    } else {
      finding.parameters.push_back({shape.name, shape.value, shape.value, shape.value});
    }
  }
}

}  // namespace

std::vector<EffectFinding> effect_findings(const Search& search, const Observations& train,
                                           const std::vector<EffectFamily>& families) {
  const FittedModel& fit = search.current();
  const Covariance covariance = covariance_of(fit, search.clusters());
  std::vector<EffectFinding> all;
  int order = 0;
  for (const Search::Found& one : search.found) {
    const EffectFamily& family = families[one.family];
    EffectFinding finding;
    finding.family = family.name;
    finding.phrase = family.phrase;
    finding.order = ++order;
    finding.adjusted_p = one.p;
    finding.gain = one.gain.nats;
    finding.gain_error = one.gain.error;
    finding.aliases = one.aliases;
    finding.few_movements = one.few;
    finding.separate_by = family.separate_by;
    Eigen::VectorXd contribution = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(train.rows()));
    for (std::size_t k = 0; k < fit.model.atoms.size(); ++k) {
      const Atom& atom = fit.model.atoms[k];
      if (atom.family != one.family) continue;
      finding.atom += (finding.atom.empty() ? "" : ", ") + atom.label;
      contribution +=
          evaluate_columns(atom.columns, train) *
          fit.model.coefficients.segment(static_cast<Eigen::Index>(fit.model.first_column(k)),
                                         static_cast<Eigen::Index>(atom.columns.size()));
      add_parameters(finding, fit, covariance, k);
    }
    finding.rms_contribution = contribution.norm() / std::sqrt(static_cast<double>(train.rows()));
    if (finding.vif > kLargeVif) {
      finding.notes.push_back("its parameters trade off against others': quote them together only");
    }
    finding.another_shape = one.another_shape;
    if (one.another_shape) {
      finding.notes.push_back(
          "of another shape than the library has: what is left over follows its own inputs");
    }
    if (finding.few_movements) {
      finding.notes.push_back("carried by few movements: record more of them (R5, R7)");
    }
    all.push_back(std::move(finding));
  }
  return all;
}

std::string physical_objection(const EffectFinding& finding, const EffectFamily& family) {
  for (const Sanity& sanity : family.sanity) {
    for (const ParameterFinding& p : finding.parameters) {
      if (p.name != sanity.coefficient) continue;
      // Against the whole interval: a value that is only perhaps unphysical stands.
      const bool wrong_sign =
          sanity.sign != 0 && sanity.sign * p.low < 0 && sanity.sign * p.high < 0;
      const bool too_large = sanity.largest > 0 &&
                             std::min(std::abs(p.low), std::abs(p.high)) > sanity.largest &&
                             p.low * p.high > 0;
      if (wrong_sign || too_large) return sanity.why;
    }
  }
  return {};
}

std::vector<CurvePoint> leftover_curve(const Search& search, const Observations& train) {
  constexpr int kBins = 40;
  if (search.leftover.signals.size() != 1) return {};
  const Signal* signal = train.find(search.leftover.signals[0]);
  const Eigen::VectorXd residual = target_vector(train) - predict(search.current().model, train);
  const auto [low, high] = std::ranges::minmax(signal->values);
  std::vector<double> sum(kBins, 0.0);
  std::vector<double> squares(kBins, 0.0);
  std::vector<double> count(kBins, 0.0);
  for (std::size_t i = 0; i < train.rows(); ++i) {
    const double place = (signal->values[i] - low) / (high - low) * kBins;
    const auto bin = static_cast<std::size_t>(std::clamp(place, 0.0, kBins - 1.0));
    const double r = residual[static_cast<Eigen::Index>(i)];
    sum[bin] += r;
    squares[bin] += r * r;
    count[bin] += 1;
  }
  std::vector<CurvePoint> curve;
  const double inflation = search.current().noise.inflation;
  for (std::size_t b = 0; b < kBins; ++b) {
    if (count[b] < 2) continue;
    const double mean = sum[b] / count[b];
    const double variance = std::max(0.0, squares[b] / count[b] - mean * mean);
    curve.push_back({low + (high - low) * (static_cast<double>(b) + 0.5) / kBins, mean,
                     std::sqrt(variance * std::min(inflation, count[b]) / count[b])});
  }
  return curve;
}

}  // namespace tribench::loop
