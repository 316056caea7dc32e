// SPDX-License-Identifier: MIT
#include "algorithms/model_based/friction_inputs.hpp"

namespace tribench {

Expression FrictionInputs::sign() const {
  return velocity_sign ? Expression::variable(*velocity_sign)
                       : Expression::unary(Op::sgn, Expression::variable(velocity));
}

std::optional<FrictionInputs> find_friction_inputs(std::span<const Input> inputs) {
  std::optional<FrictionInputs> found;
  for (std::size_t j = 0; j < inputs.size() && !found; ++j) {
    if (inputs[j].role == Role::velocity) found = FrictionInputs{j, {}, {}};
  }
  if (!found) return found;
  for (std::size_t j = 0; j < inputs.size(); ++j) {
    const bool is_sign =
        inputs[j].role == Role::velocity_sign || inputs[j].sign_of == found->velocity;
    if (is_sign && !found->velocity_sign) found->velocity_sign = j;
    if (inputs[j].role == Role::acceleration && !found->acceleration) found->acceleration = j;
  }
  return found;
}

}  // namespace tribench
