// SPDX-License-Identifier: MIT
//
// What a grid file says and its run would pass over without a word: tables that nothing names, a
// prior of no input, laws that cannot be read.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/grid.hpp"

namespace tribench {

// The names that tables of one kind declare, each with its table's place. A place may have several
// (a table whose files are problems).
class DeclaredNames {
 public:
  // what: "problem", "method"; key: the list in [grid] that names them.
  DeclaredNames(std::string_view what, std::string_view key) : what_(what), key_(key) {}

  // Throws Error (bad_input) at `name_place` where another table has the name.
  void add(const std::string& name, const std::string& name_place, const std::string& table_place);
  // Throws Error (bad_input) at the place of a table none of whose names is spoken of by a pattern
  // of the list, not even to leave it out.
  void require_named(const std::vector<std::string>& globs) const;

 private:
  struct Declared {
    std::string name;
    std::string place;
  };
  std::string what_;
  std::string key_;
  std::vector<Declared> declared_;
};

// Throws Error (bad_input) at `place` where the prior has a name that is no input of any problem.
// Cost: problems are made until each name is found; one that cannot be made may have it.
void require_inputs_of_prior(const Grid& grid, const Catalogue& catalogue,
                             const std::string& place);

// Throws Error (bad_input), with the place in its file, for a law of the grid's suites that cannot
// be read.
void require_readable_laws(const Grid& grid);

}  // namespace tribench
