// SPDX-License-Identifier: MIT
//
// Dahl, LuGre and generalised Maxwell slip as columns: which states a point theta stands for, and
// which features of them the force is linear in. For fit_separable; as a method: dynamic_friction.
//
//   dahl           F = k z
//   lugre          F = k z + s1 z'            (Canudas de Wit et al. 1995, (1) to (3))
//   maxwell_slip   F = sum_i k_i z_i, four GMS elements whose limits grow by one factor
//
// Each with viscous friction, and with inertia, load and an offset where there are such inputs or
// they are asked for; `asymmetric` adds |z| and |v|: each direction its own force.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "algorithms/expression/expression.hpp"
#include "algorithms/fitting/separable_fit.hpp"
#include "algorithms/model_based/friction_inputs.hpp"
#include "algorithms/regressor.hpp"

namespace tribench {

enum class DynamicModel { dahl, lugre, maxwell_slip };

struct DynamicTerms {
  bool asymmetric = false;
  bool offset = true;
  bool load = false;  // bristles that press harder under load: z |g|
};

// The rows that a fit uses: places in the data's rows, all values finite there.
class DynamicFeatures : public SeparableModel {
 public:
  DynamicFeatures(DynamicModel model, DynamicTerms terms, const FrictionInputs& inputs,
                  const TrainingData& data, std::vector<std::size_t> rows, Budget& budget);

  std::size_t rows() const override { return rows_.size(); }
  std::size_t features() const override;
  std::size_t parameters() const override;
  bool evaluate(std::span<const double> theta, std::span<double> features) override;
  bool differentiate(std::span<const double> theta, std::span<double> slopes) override;

  SeparableOptions options() const;  // bounds and starts from the motion, signs of coefficients
  std::vector<StateDeclaration> states(std::span<const double> theta) const;
  Expression formula(std::span<const double> theta, std::span<const double> coefficients) const;
  // Of the used rows: the largest share of a state's start that is left in it.
  std::vector<double> start_influence(std::span<const double> theta) const;

 private:
  static constexpr std::size_t kElements = 4;
  std::size_t state_count() const;
  std::size_t own_features() const;  // of the states; the linear ones follow
  std::vector<std::vector<double>> linear_columns() const;
  // d parameter / d theta: [state][parameter][theta]
  std::vector<std::vector<std::vector<double>>> parameter_slopes(
      std::span<const double> theta) const;
  std::vector<double> at_rows(const std::vector<double>& along_motion) const;

  DynamicModel model_;
  DynamicTerms terms_;
  FrictionInputs inputs_;
  std::optional<std::size_t> load_;
  const TrainingData& data_;
  std::vector<std::size_t> rows_;
  std::vector<double> velocity_;             // at the rows
  std::vector<double> load_size_;            // |load| at the rows, where it is used
  std::vector<std::vector<double>> linear_;  // columns without a parameter
  Budget& budget_;
};

}  // namespace tribench
