// SPDX-License-Identifier: MIT
#include "algorithms/model_based/placebos.hpp"

#include "algorithms/expression/build.hpp"
#include "algorithms/finite_rows.hpp"
#include "algorithms/fitting/linear_least_squares.hpp"

namespace tribench {
namespace {

class LinearModel : public Regressor {
 public:
  explicit LinearModel(bool with_inputs) : with_inputs_(with_inputs) {}

  FitResult fit(FitContext& context) const override {
    const FiniteRows data(context.data);
    if (data.rows() == 0) return FitResult::unsupported("there is no row without missing values");
    const std::vector<double> ones(data.rows(), 1.0);
    std::vector<const double*> columns = {ones.data()};
    if (with_inputs_) {
      columns.insert(columns.end(), data.pointers().begin(), data.pointers().end());
    }
    const std::size_t needed = columns.size() * columns.size() * data.rows();
    if (!context.budget.spend(needed)) {
      return {{}, 0, StopReason::budget, shortage(context.budget, needed)};
    }
    const LinearFit fit = solve_least_squares(columns, data.target);
    Expression formula = build::constant(fit.coefficients[0]);
    for (std::size_t k = 1; k < columns.size(); ++k) {
      if (fit.coefficients[k] == 0) continue;
      formula = build::operator+(
          formula, build::operator*(build::constant(fit.coefficients[k]), build::input(k - 1)));
    }
    if (context.progress != nullptr) {
      context.progress->improved(fit.sum_squares / static_cast<double>(data.rows()),
                                 context.budget.spent());
    }
    return {{formula}, 0, StopReason::converged, {}};
  }

 private:
  bool with_inputs_;
};

}  // namespace

AlgorithmEntry constant_entry() {
  return {"constant",
          "placebo: the mean of the target",
          {},
          true,
          [](const Parameters&, const MakeMethod&) -> std::unique_ptr<Regressor> {
            return std::make_unique<LinearModel>(false);
          }};
}

AlgorithmEntry linear_entry() {
  return {"linear",
          "placebo: least squares in all inputs",
          {},
          true,
          [](const Parameters&, const MakeMethod&) -> std::unique_ptr<Regressor> {
            return std::make_unique<LinearModel>(true);
          }};
}

}  // namespace tribench
