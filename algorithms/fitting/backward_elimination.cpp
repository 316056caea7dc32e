// SPDX-License-Identifier: MIT
#include "algorithms/fitting/backward_elimination.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <numeric>

#include "foundation/elementary.hpp"

namespace tribench {
namespace {

constexpr double kRounding = 1e-12;  // of the target

}  // namespace

std::vector<Eigen::Index> backward_elimination(Eigen::MatrixXd columns,
                                               const Eigen::VectorXd& target) {
  for (auto column : columns.colwise()) column.stableNormalize();
  const auto n = static_cast<double>(target.size());
  const double price =
      elementary::log(n) + 2 * elementary::log(static_cast<double>(columns.cols()));
  // All that follows is told by the triangle and the target's part along the columns.
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> all(columns);
  const Eigen::Index rank = all.rank();
  const Eigen::VectorXd turned = all.householderQ().adjoint() * target;
  const Eigen::VectorXd along = turned.head(rank);
  const double beside = turned.tail(turned.size() - rank).squaredNorm() +
                        kRounding * kRounding * target.squaredNorm();
  const Eigen::MatrixXd triangle =
      all.matrixQR().topLeftCorner(rank, rank).triangularView<Eigen::Upper>();
  std::vector<Eigen::Index> places(static_cast<std::size_t>(rank));  // in the triangle
  std::iota(places.begin(), places.end(), 0);
  while (places.size() > 1 && rank < target.size()) {
    const auto count = static_cast<Eigen::Index>(places.size());
    const Eigen::MatrixXd some = triangle(Eigen::all, places);
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(some);
    const Eigen::VectorXd coefficients = qr.solve(along);
    const Eigen::MatrixXd inverse =
        qr.matrixQR().topRows(count).triangularView<Eigen::Upper>().solve(
            Eigen::MatrixXd::Identity(count, count));
    // Of the target's square that would be left more without each column.
    const Eigen::VectorXd more =
        coefficients.array().square() / inverse.rowwise().squaredNorm().array();
    Eigen::Index least = 0;
    const double left = (along - some * coefficients).squaredNorm() + beside;
    if (n * elementary::log1p(more.minCoeff(&least) / left) > price) break;
    places.erase(places.begin() + least);
  }
  std::vector<Eigen::Index> kept;
  for (const Eigen::Index k : places) kept.push_back(all.colsPermutation().indices()[k]);
  std::ranges::sort(kept);
  return kept;
}

}  // namespace tribench
