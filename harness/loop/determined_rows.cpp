// SPDX-License-Identifier: MIT
#include "harness/loop/determined_rows.hpp"

#include <Eigen/Core>

#include "algorithms/fitting/symmetric_system.hpp"
#include "algorithms/loop_model/model_fit.hpp"

namespace tribench::loop {

std::vector<char> determined_rows(const LoopModel& model, const Observations& data,
                                  const std::vector<char>& train, double correlation_rows) {
  constexpr double kRidge = 1e-12;  // columns that follow from the others there
  Eigen::MatrixXd x = tangent(model, data);
  Eigen::MatrixXd fitted = x;
  for (std::size_t i = 0; i < train.size(); ++i) {
    if (train[i] == 0) fitted.row(static_cast<Eigen::Index>(i)).setZero();
  }
  // Of like lengths, those that are nil throughout the fit as they stand.
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    const double norm = fitted.col(j).norm();
    if (!(norm > 0)) continue;
    x.col(j) /= norm;
    fitted.col(j) /= norm;
  }
  Eigen::MatrixXd gram = fitted.transpose() * fitted;
  gram.diagonal().array() += kRidge;
  const Eigen::VectorXd leverage = (x * inverse_symmetric(gram)).cwiseProduct(x).rowwise().sum();
  std::vector<char> determined(data.rows());
  for (std::size_t i = 0; i < data.rows(); ++i) {
    determined[i] = leverage[static_cast<Eigen::Index>(i)] * correlation_rows <= 1 ? 1 : 0;
  }
  return determined;
}

}  // namespace tribench::loop
