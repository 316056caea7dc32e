// SPDX-License-Identifier: MIT
//
// How likely each explanation is given the rows so far, and which cannot be excluded yet.
//
// The e-value against an explanation is the prior mean of all explanations'
// evidence over its own: were it true, the e-value would exceed 1/alpha with a probability of alpha
// at most, at whatever time one stops and however the movements were chosen (Ville 1939). So the
// explanations whose e-value is below 1/alpha are a confidence set that may be looked at after
// every movement; when all in it say the same, that is the verdict.
//
// What the guarantee rests on: that the truth is nearly in one of the families, misfits included,
// and noise that is independent once rows are whitened. `tribench study explore` measures what is
// left of it.
//
// Cost: further rows x columns^2 (some 700 columns) and 20 ms a look; all rows again where what is
// known of the noise has changed.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/exploration/explanation_search.hpp"
#include "algorithms/exploration/explanations.hpp"
#include "algorithms/exploration/forecasts.hpp"
#include "algorithms/inference/evidence.hpp"
#include "algorithms/inference/noise.hpp"

namespace tribench::loop {

struct Assessment {
  std::vector<Explanation> explanations;         // the most likely first
  std::vector<std::vector<EffectBlock>> blocks;  // per family, of columns that rows were near
  std::vector<std::size_t> alive;  // those in the confidence set, the most likely first
  Noise noise;
  double variance = 0;  // of a whitened row
  EvidenceSums sums;    // of whitened rows
  EvidenceTable table;
  std::vector<ForecastVerdict> forecast;  // by what they said before it came, the likeliest first

  const Explanation& best() const { return explanations.front(); }
  // Posterior of all explanations that say so.
  double weight_of(const std::string& verdict) const;
};

// What is known after each further movement.
class Assessor {
 public:
  // The space outlives it. 0 < alpha < 1.
  Assessor(const ExplanationSpace& space, double alpha) : space_(space), alpha_(alpha) {}

  // rows: whole movements in the campaign's order, with the signals of the space's reference.
  void add(const Observations& rows);
  // There is a row. What the likeliest explanation of the look before leaves is noise.
  const Assessment& look();
  const Assessment& last() const { return last_; }
  std::size_t movements() const { return seen_.size(); }

 private:
  struct SeenMovement {
    Eigen::MatrixXd base;
    Eigen::MatrixXd columns;
    Eigen::VectorXd target;
    Eigen::VectorXd cut = {};  // from the target, of rows that nothing explains
    double weight = 0;         // with which it is in the sums; 0: it is not
  };
  // What an explanation leaves: of all rows, and by movement.
  struct Leftover {
    Noise noise;
    std::vector<double> weights;
    std::vector<Eigen::VectorXd> cuts;
  };

  Leftover left_by(const Explanation& one) const;
  bool is_as_it_was(const Leftover& left) const;
  void add_to(EvidenceSums& sums, const SeenMovement& movement, double weight,
              const Eigen::VectorXd& cut) const;
  void hold_forecasts_against_rows(const Leftover& left);

  const ExplanationSpace& space_;
  double alpha_;
  std::vector<SeenMovement> seen_;
  Assessment last_;
  Forecasts forecasts_;
};

}  // namespace tribench::loop
