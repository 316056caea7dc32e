// SPDX-License-Identifier: MIT
//
// What the model-based methods look for among a problem's inputs.
#pragma once

#include <optional>
#include <span>

#include "algorithms/expression/expression.hpp"
#include "problems/problem.hpp"

namespace tribench {

struct FrictionInputs {
  std::size_t velocity = 0;
  std::optional<std::size_t> velocity_sign;  // an input that is the velocity's sign
  std::optional<std::size_t> acceleration;

  // The sign of velocity as a formula: the input where there is one, else sgn(velocity).
  Expression sign() const;
};

// Nothing without an input whose role is velocity.
std::optional<FrictionInputs> find_friction_inputs(std::span<const Input> inputs);

}  // namespace tribench
