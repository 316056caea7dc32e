// SPDX-License-Identifier: MIT
//
// The catalogue with everything in it: problems know no formulas, so whoever wants a suite's laws
// made into rows asks for the catalogue here.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

#include "problems/catalogue.hpp"

namespace tribench {

// Makes functions of laws, by the engine that judges formulas.
suite::LawReader law_reader();

// Laws by the engine that judges them. data as for Catalogue; an empty text: none.
Catalogue full_catalogue(const std::optional<std::filesystem::path>& data = std::nullopt);
// own: problems that a grid brings itself.
Catalogue full_catalogue_of(std::string_view data, std::span<const user::UserProblem> own = {});
// For a run's folder: with the problems that its grid.toml brings itself, where it has any.
Catalogue full_catalogue_of_run(const std::filesystem::path& folder, std::string_view data);

}  // namespace tribench
