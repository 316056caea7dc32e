// SPDX-License-Identifier: MIT
#include "algorithms/inference/evidence.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "algorithms/fitting/symmetric_system.hpp"
#include "algorithms/inference/column_products.hpp"
#include "foundation/elementary.hpp"

namespace tribench::loop {
namespace {

constexpr double kSameDirection = 1e-10;  // of base columns of unit length

// Columns z with z z' the inverse of the base's products, in the directions that the rows have.
Eigen::MatrixXd inverse_root(const Eigen::MatrixXd& products) {
  const Eigen::VectorXd length =
      products.diagonal().cwiseSqrt().unaryExpr([](double x) { return x > 0 ? x : 1.0; });
  const Eigen::MatrixXd unit =
      length.cwiseInverse().asDiagonal() * products * length.cwiseInverse().asDiagonal();
  const EigenParts parts = eigen_parts_symmetric(unit);
  const double least = kSameDirection * parts.values.maxCoeff();
  const auto dropped = static_cast<Eigen::Index>(
      std::ranges::count_if(parts.values, [&](double value) { return !(value > least); }));
  const Eigen::Index rank = unit.rows() - dropped;
  return length.cwiseInverse().asDiagonal() * parts.vectors.rightCols(rank) *
         parts.values.tail(rank).cwiseSqrt().cwiseInverse().asDiagonal();
}

// Of coefficients in units of the noise: normal about `mean` / sigma with a covariance, where
// 1/sigma^2 has a gamma distribution of this mean.
struct NormalGamma {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
  double degrees_of_freedom;
  double precision;
};

using Traces = std::array<double, kMomentOrder + 1>;  // of a matrix' powers, from the first on

// The trace of a product is the sum of the products of the elements: half of the powers will do.
Traces traces_of_powers(const Eigen::MatrixXd& matrix) {
  Traces traces{};
  traces[1] = matrix.trace();
  Eigen::MatrixXd power = matrix;
  for (std::size_t half = 1; 2 * half <= kMomentOrder; ++half) {
    traces[2 * half] = power.cwiseProduct(power.transpose()).sum();
    if (2 * half == kMomentOrder) break;
    const Eigen::MatrixXd next = matrix * power;
    traces[2 * half + 1] = next.cwiseProduct(power.transpose()).sum();
    power = next;
  }
  return traces;
}

// Of the unit matrix shared out to its rows, which is the metric of coefficients that are all
// alike.
Traces traces_of_powers_alike(Eigen::Index size) {
  Traces traces{};
  double trace = 1;
  for (std::size_t s = 1; s <= kMomentOrder; ++s, trace /= static_cast<double>(size)) {
    traces[s] = trace;
  }
  return traces;
}

// Cumulants of an effect's square, a quadratic form of normal variables, from the first on: each is
// one number and another times the precision. Source: Mathai and Provost 1992, theorem 3.2b.2.
using Cumulants = std::array<std::array<double, 2>, kMomentOrder + 1>;
Cumulants cumulants_of(const Traces& traces, const Traces& of_mean) {
  Cumulants cumulants{};
  double factor = 1;  // 2^(s - 1) (s - 1)!
  for (std::size_t s = 1; s <= kMomentOrder; ++s) {
    cumulants[s] = {factor * traces[s], factor * static_cast<double>(s) * of_mean[s]};
    factor *= 2 * static_cast<double>(s);
  }
  return cumulants;
}

// The moment of the prior's order, as a polynomial of the precision.
using Polynomial = std::array<double, kMomentOrder + 1>;
Polynomial moment_of(const Cumulants& cumulants) {
  std::array<Polynomial, kMomentOrder + 1> moments{};
  moments[0][0] = 1;
  for (std::size_t n = 1; n <= kMomentOrder; ++n) {
    double choose = 1;  // of n - 1, k
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t d = 0; d <= k; ++d) {
        moments[n][d] += choose * cumulants[n - k][0] * moments[k][d];
        moments[n][d + 1] += choose * cumulants[n - k][1] * moments[k][d];
      }
      choose *= static_cast<double>(n - 1 - k) / static_cast<double>(k + 1);
    }
  }
  return moments[kMomentOrder];
}

// Expectation of the effect's square to the power of the moment prior's order, over that under the
// prior's unit covariance.
double prior_moment(const Eigen::MatrixXd& metric, const NormalGamma& over) {
  const Eigen::Index size = over.mean.size();
  const bool all_alike = metric.size() == 0;
  const auto measured = [&](const Eigen::MatrixXd& of) -> Eigen::MatrixXd {
    if (all_alike) return of / static_cast<double>(size);
    return metric * of;
  };
  const Eigen::MatrixXd spread = measured(over.covariance);
  Traces of_mean{};
  Eigen::VectorXd weighed = measured(over.mean);
  for (std::size_t s = 1; s <= kMomentOrder; ++s, weighed = spread * weighed) {
    of_mean[s] = over.mean.dot(weighed);
  }
  const Polynomial moment = moment_of(cumulants_of(traces_of_powers(spread), of_mean));
  const Traces before = all_alike ? traces_of_powers_alike(size) : traces_of_powers(metric);
  double expected = 0;
  double power = 1;  // expectation of the precision's
  for (std::size_t d = 0; d <= kMomentOrder; ++d) {
    expected += power * moment[d];
    power *= over.precision * (1 + 2 * static_cast<double>(d) / over.degrees_of_freedom);
  }
  return expected / moment_of(cumulants_of(before, Traces{}))[0];
}

}  // namespace

double prior_variance(const EffectBlock& block) {
  return block.size * block.size / static_cast<double>(kMomentOrder * block.columns.size());
}

// Of the columns, those of a block times its prior's spread, then what the misfits' have for
// themselves: (I + gram)^-1 and what follows.
struct EvidenceTable::Solved {
  ColumnBlock columns;
  Eigen::LLT<Eigen::MatrixXd> factor;
  Eigen::VectorXd scale;  // of each column
  Eigen::VectorXd mean;
  double squares = 0;  // left of the target, the prior's share included
};

void EvidenceSums::add(const Eigen::MatrixXd& base, const Eigen::MatrixXd& columns,
                       const Eigen::VectorXd& target) {
  Eigen::MatrixXd all(base.rows(), base.cols() + columns.cols() + 1);
  all << base, columns, target;
  if (products_.size() == 0) products_.setZero(all.cols(), all.cols());
  products_ += gram_of(all);
  rows_ += base.rows();
  base_ = base.cols();
}

EvidenceTable::EvidenceTable(const EvidenceSums& sums) {
  const Eigen::Index base = sums.base_count();
  const Eigen::Index rest = sums.products().cols() - base;
  const Eigen::MatrixXd& lower = sums.products();
  const Eigen::MatrixXd own = lower.topLeftCorner(base, base).selfadjointView<Eigen::Lower>();
  const Eigen::MatrixXd root = inverse_root(own);
  const Eigen::MatrixXd across = lower.bottomLeftCorner(rest, base) * root;
  base_ = root * across.transpose();
  Eigen::MatrixXd left = lower.bottomRightCorner(rest, rest);
  left.selfadjointView<Eigen::Lower>().rankUpdate(across, -1.0);
  gram_ = left.topLeftCorner(rest - 1, rest - 1).selfadjointView<Eigen::Lower>();
  cross_ = left.row(rest - 1).head(rest - 1);
  squares_ = std::max(left(rest - 1, rest - 1), 0.0);
  dof_ = std::max(1.0, static_cast<double>(sums.rows() - root.cols()));
}

// Where a block's columns and its misfit's stand among all that are solved for.
struct EvidenceTable::Places {
  Eigen::Index own = 0;
  Eigen::Index misfit = 0;
};

std::vector<EvidenceTable::Places> EvidenceTable::places_of(
    std::span<const EffectBlock* const> blocks) {
  std::vector<Places> places;
  Eigen::Index next = 0;
  for (const EffectBlock* block : blocks) {
    places.push_back({next, 0});
    next += static_cast<Eigen::Index>(block->columns.size());
  }
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    places[b].misfit = next;
    next += static_cast<Eigen::Index>(blocks[b]->misfit.size());
  }
  return places;
}

// The blocks' columns, then their misfits', each with the spread that its factor has beforehand.
EvidenceTable::Solved EvidenceTable::columns_of(std::span<const EffectBlock* const> blocks) {
  Solved solved;
  ColumnBlock& columns = solved.columns;
  std::vector<double> scale;
  for (const EffectBlock* block : blocks) {
    columns.insert(columns.end(), block->columns.begin(), block->columns.end());
    scale.resize(columns.size(), std::sqrt(prior_variance(*block)));
  }
  for (const EffectBlock* block : blocks) {
    columns.insert(columns.end(), block->misfit.begin(), block->misfit.end());
    scale.resize(columns.size(), block->size);
  }
  solved.scale =
      Eigen::Map<const Eigen::VectorXd>(scale.data(), static_cast<Eigen::Index>(scale.size()));
  return solved;
}

// What a misfit shares with its block's own columns is theirs.
void EvidenceTable::take_shared_out(std::span<const EffectBlock* const> blocks,
                                    Eigen::MatrixXd& gram, Eigen::VectorXd& cross) {
  const std::vector<Places> places = places_of(blocks);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const Eigen::MatrixXd& shared = blocks[b]->shared;
    if (shared.size() == 0) continue;
    const auto [own, misfit] = places[b];
    gram.middleCols(misfit, shared.cols()) -= gram.middleCols(own, shared.rows()) * shared;
    gram.middleRows(misfit, shared.cols()) -=
        shared.transpose() * gram.middleRows(own, shared.rows());
    cross.segment(misfit, shared.cols()) -= shared.transpose() * cross.segment(own, shared.rows());
  }
}

EvidenceTable::Solved EvidenceTable::solve(std::span<const EffectBlock* const> blocks) const {
  Solved solved = columns_of(blocks);
  Eigen::MatrixXd gram = gram_(solved.columns, solved.columns);
  Eigen::VectorXd cross = cross_(solved.columns);
  take_shared_out(blocks, gram, cross);
  gram = (solved.scale.asDiagonal() * gram * solved.scale.asDiagonal()).eval();
  gram.diagonal().array() += 1;
  cross = solved.scale.cwiseProduct(cross);
  solved.factor.compute(gram);
  solved.mean = solved.factor.solve(cross);
  // Rounding must not make a perfect fit better than perfect.
  solved.squares = std::max(squares_ - cross.dot(solved.mean), 1e-12 * squares_);
  return solved;
}

namespace {

// Log of the product of a triangle's diagonal is taken from nats.
double less_log_determinant(double nats, const Eigen::MatrixXd& lower) {
  double determinant = 1;
  for (Eigen::Index i = 0; i < lower.rows(); ++i) {
    determinant *= lower(i, i);
    if (determinant > 1e100 || i + 1 == lower.rows()) {  // before it overflows
      nats -= elementary::log(determinant);
      determinant = 1;
    }
  }
  return nats;
}

}  // namespace

double EvidenceTable::log_factor(std::span<const EffectBlock* const> blocks) const {
  if (blocks.empty() || squares_ <= 0) return 0;
  const Solved solved = solve(blocks);
  const auto& lower = solved.factor.matrixLLT();
  double nats =
      less_log_determinant(-0.5 * dof_ * elementary::log(solved.squares / squares_), lower);
  Eigen::Index own = 0;
  for (const EffectBlock* block : blocks) own += static_cast<Eigen::Index>(block->columns.size());
  // A block of the inverse is the product of the columns of L^-1.
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(lower.rows(), own);
  solved.factor.matrixL().solveInPlace(inverse);
  Eigen::Index first = 0;
  for (const EffectBlock* block : blocks) {
    const auto size = static_cast<Eigen::Index>(block->columns.size());
    const Eigen::MatrixXd roots = inverse.middleCols(first, size);
    nats += elementary::log(
        prior_moment(block->metric, {solved.mean.segment(first, size), roots.transpose() * roots,
                                     dof_, dof_ / solved.squares}));
    first += size;
  }
  return nats;
}

EvidenceTable::Posterior EvidenceTable::posterior(
    std::span<const EffectBlock* const> blocks) const {
  Posterior out;
  out.base = base_.rightCols(1);
  if (blocks.empty()) {
    out.variance = squares_ / dof_;
    return out;
  }
  const Solved solved = solve(blocks);
  out.mean = solved.scale.cwiseProduct(solved.mean);
  const std::vector<Places> places = places_of(blocks);
  out.effects = out.mean.head(places.front().misfit);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const Eigen::MatrixXd& shared = blocks[b]->shared;
    if (shared.size() == 0) continue;
    out.mean.segment(places[b].own, shared.rows()) -=
        shared * out.mean.segment(places[b].misfit, shared.cols());
  }
  out.base -= base_(Eigen::all, solved.columns) * out.mean;
  out.variance = solved.squares / dof_;
  return out;
}

Eigen::VectorXd EvidenceTable::left_of_products(std::span<const EffectBlock* const> blocks) const {
  if (blocks.empty()) return cross_;
  ColumnBlock columns;
  for (const EffectBlock* block : blocks) {
    columns.insert(columns.end(), block->columns.begin(), block->columns.end());
  }
  for (const EffectBlock* block : blocks) {
    columns.insert(columns.end(), block->misfit.begin(), block->misfit.end());
  }
  return cross_ - gram_(Eigen::all, columns) * posterior(blocks).mean;
}

}  // namespace tribench::loop
