// SPDX-License-Identifier: MIT
//
// How much more likely the rows are with some blocks of columns than with the base alone: Bayes
// factors of linear models that stay valid whenever one looks.
//
// Base coefficients and the noise's standard deviation have their invariant priors (flat, 1/sigma),
// so that the factor is one of the residual's direction and length alone; under the base its
// expectation is 1 at any stopping time (a test martingale), whatever base and noise are. A block's
// coefficients have a normal prior (covariance sigma^2 size^2 / 4 over the number of its columns)
// times the eighth power of the effect that they make (its square by the block's metric; the sum of
// squares without one): a moment prior of order 4. It has nothing near no effect and is likeliest
// about 1.4 times the block's size, whatever the order. A block that is absent is ruled out at the
// rate n^(4 + p/2) instead of n^(p/2). Columns that are nearly
// alike make no effect where they cancel. The power's expectation is taken at the posterior, block
// by block.
//
// A block's misfit is what its effect may have besides and need not: columns with a normal prior of
// unit covariance (times sigma^2 and the block's size squared: what is large may miss by more),
// with nothing against a coefficient of 0. What a misfit shares with the block's columns is the
// effect, and no misfit: else a misfit could cancel an effect that is not there, and no number of
// rows would rule it out.
//
// Columns are scaled by the caller so that 1 is a coefficient one expects, in units of the noise.
// Rows are whitened (whitening.hpp). Not for models in which columns enter non-linearly.
//
// Source: Johnson and Rossell 2012 (moment priors); Perez-Ortiz, Lardy, de Heide and Grunwald 2022
// and Lindon, Ham, Tingley and Bojinov 2022 (anytime-valid linear models).
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace tribench::loop {

// Order of the moment prior: the power of the effect's square.
inline constexpr std::size_t kMomentOrder = 4;

// Columns by number.
using ColumnBlock = std::vector<Eigen::Index>;

// A block whose coefficients are expected to be as large as `size`, and what it may miss by.
struct EffectBlock {
  ColumnBlock columns;
  double size = 1;
  ColumnBlock misfit = {};
  // Squared size of the effect of unit coefficients is u' metric u, trace 1; empty: all alike.
  Eigen::MatrixXd metric = {};
  // Columns x misfit: what the misfit's columns have of the block's; empty: nothing.
  Eigen::MatrixXd shared = {};
};

// Of a coefficient, in the noise's.
double prior_variance(const EffectBlock& block);

// Cross products of base, columns and target over whitened rows: all that evidence needs, so that
// further rows cost what they cost alone. Rows are independent of those added before.
class EvidenceSums {
 public:
  // Costs rows x (base + columns)^2.
  void add(const Eigen::MatrixXd& base, const Eigen::MatrixXd& columns,
           const Eigen::VectorXd& target);

  Eigen::Index rows() const { return rows_; }
  Eigen::Index base_count() const { return base_; }
  // The base's columns first, the target last.
  const Eigen::MatrixXd& products() const { return products_; }

 private:
  Eigen::Index rows_ = 0;
  Eigen::Index base_ = 0;
  Eigen::MatrixXd products_;
};

class EvidenceTable {
 public:
  EvidenceTable() = default;
  explicit EvidenceTable(const EvidenceSums& sums);

  // ln of the Bayes factor of the blocks together against the base alone. Cost: p^3.
  double log_factor(std::span<const EffectBlock* const> blocks) const;

  struct Posterior {
    Eigen::VectorXd mean;     // of the blocks' columns in order, then their misfits', as scaled
    Eigen::VectorXd effects;  // of the blocks' columns, what the misfits share with them included
    Eigen::VectorXd base;     // of the base's columns
    double variance = 0;      // sigma^2
  };
  Posterior posterior(std::span<const EffectBlock* const> blocks) const;

  // Products of all columns with what base and blocks leave of the target.
  Eigen::VectorXd left_of_products(std::span<const EffectBlock* const> blocks) const;

  // Cross products of what the base leaves of the columns.
  const Eigen::MatrixXd& gram() const { return gram_; }
  double degrees_of_freedom() const { return dof_; }

 private:
  struct Solved;
  struct Places;
  static std::vector<Places> places_of(std::span<const EffectBlock* const> blocks);
  static Solved columns_of(std::span<const EffectBlock* const> blocks);
  static void take_shared_out(std::span<const EffectBlock* const> blocks, Eigen::MatrixXd& gram,
                              Eigen::VectorXd& cross);
  Solved solve(std::span<const EffectBlock* const> blocks) const;

  Eigen::MatrixXd base_;  // what the base does best of the columns and, last, of the target
  Eigen::MatrixXd gram_;
  Eigen::VectorXd cross_;  // with the target
  double squares_ = 0;     // of what the base leaves of the target
  double dof_ = 0;
};

}  // namespace tribench::loop
