// SPDX-License-Identifier: MIT
#include "algorithms/fitting/formula_jacobian.hpp"

#include "algorithms/expression/differentiate.hpp"

namespace tribench {

Eigen::MatrixXd jacobian_of(const Expression& formula, std::span<const std::size_t> places,
                            const Inputs& inputs, std::span<double> values) {
  Differentiator differentiator;
  differentiator.prepare(formula, places);
  const auto rows = static_cast<Eigen::Index>(inputs.rows);
  Eigen::MatrixXd jacobian(rows, static_cast<Eigen::Index>(places.size()));
  differentiator.jacobian(inputs, values,
                          {jacobian.data(), static_cast<std::size_t>(jacobian.size())});
  return jacobian;
}

}  // namespace tribench
