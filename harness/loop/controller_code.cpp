// SPDX-License-Identifier: MIT
#include "harness/loop/controller_code.hpp"

#include <algorithm>
#include <vector>

namespace tribench::loop {

std::string controller_code(const Expression& formula, std::span<const std::string> names,
                            const ExportOptions& options, std::optional<PathFrom> path) {
  std::string code = export_code(formula, names, CodeForm::c, options);
  const std::vector<std::string> called = export_arguments(formula, names, options);
  if (path && std::ranges::any_of(called, is_distance)) {
    code += c_history_code(options.function, called, *path);
  }
  return code;
}

}  // namespace tribench::loop
