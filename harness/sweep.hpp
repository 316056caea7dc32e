// SPDX-License-Identifier: MIT
//
// A grid's sweep: sweep = { noise = [0, 0.01], rows = [50, 200], "pysr.populations" = [8, 32] }
// multiplies problems by noise and rows (problems/variant.hpp) and a method by the values of its
// parameters. What takes effect are ordinary problems and methods with names of their own.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "algorithms/registry.hpp"
#include "foundation/toml_table.hpp"
#include "harness/grid.hpp"

namespace tribench {

class Sweep {
 public:
  // Of the table [grid]; without the key nothing is swept. Throws Error (bad_input) with the place.
  Sweep(const TomlTable& grid, const Registry& registry);

  std::vector<std::string> over_problems(const std::vector<std::string>& problems) const;
  // "pysr" with populations 8 is "pysr-populations-8".
  std::vector<Method> over_method(const Method& method) const;
  // Throws Error (bad_input) where a method is swept that is not among these.
  void require_methods(const std::vector<std::string>& names) const;

 private:
  struct Parameter {
    std::string method;
    std::string name;
    std::vector<ParameterValue> values;
    std::string place;
  };

  const Registry& registry_;
  std::vector<std::string> suffixes_ = {""};  // of problems
  std::vector<Parameter> parameters_;
};

}  // namespace tribench
