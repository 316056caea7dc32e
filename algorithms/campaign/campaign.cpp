// SPDX-License-Identifier: MIT
#include "algorithms/campaign/campaign.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace tribench::loop {
namespace {

// Torque comes in steps: no residual is more certain than its quantisation allows.
double quantisation_floor(const std::vector<double>& target) {
  std::vector<double> sorted = target;
  std::ranges::sort(sorted);
  const double span = sorted.back() - sorted.front();
  double smallest = span;
  std::size_t distinct = 1;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const double step = sorted[i] - sorted[i - 1];
    if (step <= 1e-12 * span) continue;
    smallest = std::min(smallest, step);
    ++distinct;
  }
  const double negligible = 1e-9 * span;
  if (distinct * 2 > sorted.size()) return negligible;
  return std::max(negligible, smallest / std::sqrt(12.0));
}

void scale_to_unit_rms(Eigen::MatrixXd& columns) {
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    const double rms = columns.col(j).norm() / std::sqrt(static_cast<double>(columns.rows()));
    if (rms > 0) columns.col(j) /= rms;
  }
}

}  // namespace

Library make_library(const Observations& data, const std::vector<EffectFamily>& families,
                     const std::vector<double>& gear_ratios,
                     std::span<const std::size_t> last_resort) {
  Library out;
  std::vector<Expression> formulas;
  for (std::size_t f = 0; f < families.size(); ++f) {
    const bool is_asked = std::ranges::count(last_resort, f) > 0;
    std::vector<std::string> missing;
    for (Atom& atom : instantiate(families[f], f, data, gear_ratios, missing)) {
      if (atom.last_resort && !is_asked) continue;
      out.blocks.push_back({formulas.size(), atom.columns.size()});
      formulas.insert(formulas.end(), atom.columns.begin(), atom.columns.end());
      out.atoms.push_back(std::move(atom));
    }
    if (!missing.empty()) {
      out.missing.push_back({families[f].name, fmt::format("{}", fmt::join(missing, ", ")), 0, 0,
                             families[f].first_experiment()});
    }
  }
  out.columns = evaluate_columns(formulas, data);
  scale_to_unit_rms(out.columns);
  out.usable.assign(out.atoms.size(), 1);
  for (std::size_t k = 0; k < out.atoms.size(); ++k) {
    auto block = out.columns.middleCols(static_cast<Eigen::Index>(out.blocks[k].first),
                                        static_cast<Eigen::Index>(out.blocks[k].count));
    if (block.allFinite()) continue;
    out.usable[k] = 0;
    block.setZero();
  }
  return out;
}

Campaign::Campaign(const Observations& train, const std::vector<EffectFamily>& all_families,
                   const DiagnosisOptions& how, const Clusters& all_clusters, RandomStream random)
    : data(train),
      families(all_families),
      options(how),
      clusters(all_clusters),
      noise_floor(quantisation_floor(train.target)),
      library(make_library(train, all_families, gear_ratios_for(train, how.gear_ratios))),
      flips(how.flips, all_clusters.stretches.size(), random) {}

Campaign Campaign::with_last_resort(std::span<const std::size_t> of) const {
  Campaign out = *this;
  out.library = make_library(data, families, gear_ratios_for(data, options.gear_ratios), of);
  return out;
}

}  // namespace tribench::loop
