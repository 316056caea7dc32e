// SPDX-License-Identifier: MIT
#include "algorithms/fitting/symmetric_system.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace tribench {

Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  return a.ldlt().solve(b);
}

Eigen::MatrixXd inverse_symmetric(const Eigen::MatrixXd& a) {
  return a.ldlt().solve(Eigen::MatrixXd::Identity(a.rows(), a.cols()));
}

namespace {

Eigen::MatrixXd products(const Eigen::MatrixXd& x) {
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(x.cols(), x.cols());
  // Eigen takes a reference to the first number, which an empty matrix has not.
  if (x.size() > 0) gram.selfadjointView<Eigen::Lower>().rankUpdate(x.transpose());
  return gram;
}

// a(order, order) = L L' for the leading `rank` pivots, the largest first. Eigen's LDLT takes its
// pivots from a diagonal that it has not brought up to date: it does not reveal the rank.
struct PivotedCholesky {
  std::vector<Eigen::Index> order;  // the pivots'
  Eigen::MatrixXd lower;

  PivotedCholesky(Eigen::MatrixXd a, double threshold) {
    const Eigen::Index n = a.rows();
    std::vector<Eigen::Index> places(static_cast<std::size_t>(n));
    std::iota(places.begin(), places.end(), Eigen::Index{0});
    double first = 0;
    Eigen::Index k = 0;
    for (; k < n; ++k) {
      Eigen::Index best = 0;
      const double pivot = a.diagonal().tail(n - k).maxCoeff(&best);
      if (k == 0) first = pivot;
      if (!(pivot > 0) || !(pivot > threshold * first)) break;
      best += k;
      a.row(k).swap(a.row(best));
      a.col(k).swap(a.col(best));
      std::swap(places[static_cast<std::size_t>(k)], places[static_cast<std::size_t>(best)]);
      const double root = std::sqrt(pivot);
      a(k, k) = root;
      auto below = a.col(k).tail(n - k - 1);
      below /= root;
      a.bottomRightCorner(n - k - 1, n - k - 1).noalias() -= below * below.transpose();
    }
    lower = a.topLeftCorner(k, k);
    order.assign(places.begin(), places.begin() + k);
  }
};

Eigen::MatrixXd orthonormalised(const Eigen::MatrixXd& x) {
  const Eigen::LLT<Eigen::MatrixXd> factor(products(x));
  return factor.matrixU().solve<Eigen::OnTheRight>(x);
}

}  // namespace

Eigen::MatrixXd basic_solution_symmetric(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                                         double threshold) {
  const PivotedCholesky factor(a.selfadjointView<Eigen::Lower>(), threshold);
  Eigen::MatrixXd x = b(factor.order, Eigen::all);
  factor.lower.triangularView<Eigen::Lower>().solveInPlace(x);
  factor.lower.transpose().triangularView<Eigen::Upper>().solveInPlace(x);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(b.rows(), b.cols());
  out(factor.order, Eigen::all) = x;
  return out;
}

Eigen::MatrixXd orthonormal_columns(const Eigen::MatrixXd& x, double threshold) {
  const Eigen::VectorXd lengths = x.colwise().norm();
  Eigen::MatrixXd scaled = x;
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    if (lengths[j] > 0) scaled.col(j) /= lengths[j];
  }
  const PivotedCholesky factor(products(scaled).selfadjointView<Eigen::Lower>(), threshold);
  return orthonormalised(orthonormalised(scaled(Eigen::all, factor.order)));
}

EigenParts eigen_parts_symmetric(const Eigen::MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(a);
  return {parts.eigenvalues(), parts.eigenvectors()};
}

double spectral_norm_symmetric(const Eigen::MatrixXd& a) {
  return a.selfadjointView<Eigen::Lower>().operatorNorm();
}

}  // namespace tribench
