// SPDX-License-Identifier: MIT
#include "algorithms/admission.hpp"

#include "algorithms/expression/singularity.hpp"

namespace tribench {

InputBox input_box(std::span<const Input> inputs) {
  InputBox box;
  for (const Input& input : inputs) {
    const bool has_owner = input.sign_of && *input.sign_of < inputs.size();
    box.push_back({input.low, input.high, has_owner ? input.sign_of : std::nullopt});
  }
  return box;
}

bool Admission::is_safe(const Expression& formula) const {
  return !operators_.proved_free_only() ||
         prove_free(formula, box_).verdict == Verdict::proved_free;
}

}  // namespace tribench
