// SPDX-License-Identifier: MIT
//
// The grids that come with the program, held inside it. Not for suites, which are data of the
// catalogue (problems/suite); a suite asked for by its name as a grid is one here.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/grid.hpp"

namespace tribench {

struct ShippedGrid {
  std::string name;
  std::string summary;  // the file's first comment
  std::string_view toml;
};

const std::vector<ShippedGrid>& shipped_grids();

// A shipped grid by its name, else a shipped suite, else a file. Throws as load_grid does.
Grid load_named_grid(const std::string& name_or_file, const Registry& registry,
                     const Catalogue& catalogue);

}  // namespace tribench
