// SPDX-License-Identifier: MIT
//
// What friction may have beside its base: the families of the library and, for each signal or pair
// of signals of the smoothers, "something else that lives there". A family is one of several blocks
// of columns; a block is scaled so that a coefficient of 1 is an effect as large as the noise over
// the reference campaign (foresight.hpp).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "algorithms/diagnosis/loop_model.hpp"
#include "algorithms/inference/evidence.hpp"
#include "problems/preparation/observations.hpp"

namespace tribench::loop {

struct ExplainingFamily {
  std::string name;                 // "stribeck", "unknown:position", "unknown:velocity x position"
  bool unknown = false;             // of no library: its name is where it lives
  std::vector<std::string> inputs;  // role names
  std::vector<ColumnBlock> blocks;
};

class ExplanationSpace {
 public:
  // reference: every signal that can vary does. gear_ratios as of DiagnosisOptions.
  ExplanationSpace(const Observations& reference, const std::vector<double>& gear_ratios);

  const std::vector<ExplainingFamily>& families() const { return families_; }
  const std::vector<std::string>& untestable() const { return untestable_; }
  const Observations& reference() const { return reference_; }

  // The scaled columns on rows that follow the reference's: rows x columns. Signals as the
  // reference has them.
  Eigen::MatrixXd columns(const Observations& rows) const;
  Eigen::MatrixXd base_columns(const Observations& rows) const;
  Eigen::Index column_count() const { return scale_.size(); }

 private:
  void add_library(const std::vector<double>& gear_ratios);
  void add_inputs(const Expression& formula, std::vector<std::string>& inputs) const;
  void add_smoothers();
  Eigen::MatrixXd raw_columns(const Observations& rows) const;

  Observations reference_;
  std::vector<ExplainingFamily> families_;
  std::vector<std::string> untestable_;
  std::vector<Expression> formulas_;
  std::vector<Eigen::Index> smoother_sizes_;  // columns with direction, in order
  Eigen::VectorXd scale_;
};

}  // namespace tribench::loop
