// SPDX-License-Identifier: MIT
//
// How much more likely the rows are with some blocks of columns than with the base alone: Bayes
// factors of linear models that stay valid whenever one looks.
//
// Base coefficients and the noise's standard deviation have their invariant priors (flat, 1/sigma),
// so that the factor is one of the residual's direction and length alone; under the base its
// expectation is 1 at any stopping time (a test martingale), whatever base and noise are. A block's
// coefficients have a normal prior of unit covariance (times sigma^2, over the number of its
// columns) times their own squared length: nothing near zero, so that a block that is absent is
// ruled out at the rate n^(1 + p/2) instead of n^(p/2). The length's expectation is taken at the
// posterior, block by block.
//
// Columns are scaled by the caller so that 1 is a coefficient one expects, in units of the noise.
// Rows are whitened (clusters.hpp). Not for models in which columns enter non-linearly.
//
// Source: Johnson and Rossell 2012 (moment priors); Perez-Ortiz, Lardy, de Heide and Grunwald 2022
// and Lindon, Ham, Tingley and Bojinov 2022 (anytime-valid linear models).
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace tribench::loop {

// Columns of one block, by number.
using ColumnBlock = std::vector<Eigen::Index>;

class EvidenceTable {
 public:
  EvidenceTable() = default;
  // Whitened rows of the base, of all columns and of the target. Costs rows x columns^2.
  EvidenceTable(const Eigen::MatrixXd& base, const Eigen::MatrixXd& columns,
                const Eigen::VectorXd& target);

  // ln of the Bayes factor of the blocks together against the base alone. Cost: p^3.
  double log_factor(std::span<const ColumnBlock* const> blocks) const;

  struct Posterior {
    Eigen::VectorXd mean;        // of the blocks' columns in order, in the caller's scale
    Eigen::MatrixXd covariance;  // over sigma^2
    double variance = 0;         // sigma^2
  };
  Posterior posterior(std::span<const ColumnBlock* const> blocks) const;

  // Of a column's squares what the base leaves.
  double left_by_base(Eigen::Index column) const { return left_[column]; }
  double degrees_of_freedom() const { return dof_; }

 private:
  struct Solved;
  Solved solve(std::span<const ColumnBlock* const> blocks) const;

  Eigen::MatrixXd gram_;   // of what the base leaves of the columns
  Eigen::VectorXd cross_;  // with the target
  Eigen::VectorXd left_;
  double squares_ = 0;  // of what the base leaves of the target
  double dof_ = 0;
};

}  // namespace tribench::loop
