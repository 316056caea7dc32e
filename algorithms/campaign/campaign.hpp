// SPDX-License-Identifier: MIT
//
// What one search looks at: rows, the library's columns over them, clusters and flips. Nothing of
// it changes while the search runs.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "algorithms/campaign/findings.hpp"
#include "algorithms/campaign/options.hpp"
#include "algorithms/inference/clusters.hpp"
#include "algorithms/inference/flips.hpp"
#include "algorithms/inference/score_test.hpp"
#include "algorithms/loop_model/loop_model.hpp"

namespace tribench::loop {

// The library's atoms as columns over the rows, evaluated once.
struct Library {
  std::vector<Atom> atoms;
  std::vector<Block> blocks;               // per atom, in the columns
  Eigen::MatrixXd columns;                 // as they are, of unit root mean square
  std::vector<char> usable;                // per atom: finite in every row
  std::vector<UntestableFinding> missing;  // families whose signals the data lack

  // Of a matrix with the library's columns, those of one atom.
  auto block_of(const Eigen::MatrixXd& all, std::size_t atom) const {
    return all.middleCols(static_cast<Eigen::Index>(blocks[atom].first),
                          static_cast<Eigen::Index>(blocks[atom].count));
  }
};

Library make_library(const Observations& data, const std::vector<EffectFamily>& families,
                     const std::vector<double>& gear_ratios,
                     std::span<const std::size_t> last_resort = {});

// The references outlive the campaign.
struct Campaign {
  Campaign(const Observations& train, const std::vector<EffectFamily>& all_families,
           const DiagnosisOptions& how, const Clusters& all_clusters, RandomStream random);
  // The same with these families' atoms of last resort in the library.
  [[nodiscard]] Campaign with_last_resort(std::span<const std::size_t> of) const;

  const Observations& data;
  const std::vector<EffectFamily>& families;
  const DiagnosisOptions& options;
  const Clusters& clusters;
  double noise_floor;  // no residual is more certain than the target's steps allow
  Library library;
  Flips flips;
};

}  // namespace tribench::loop
