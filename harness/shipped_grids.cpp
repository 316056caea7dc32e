// SPDX-License-Identifier: MIT
#include "harness/shipped_grids.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "foundation/error.hpp"
#include "foundation/plain_name.hpp"
#include "foundation/suggestion.hpp"

namespace tribench {
namespace embedded {
std::string_view quick_grid();
std::string_view paper_grid();
std::string_view measured_grid();
std::string_view nightly_grid();
std::string_view nguyen_grid();
std::string_view peer_grid();
std::string_view parfam_optimizers_grid();
std::string_view udsr_ablation_grid();
std::string_view udsr_ablation_nguyen_grid();
std::string_view relay_ablation_grid();
std::string_view paper_reference();
}  // namespace embedded

namespace {

// The comment that a grid file starts with, as one line up to the first full stop.
std::string summary_of(std::string_view toml) {
  std::string text;
  while (toml.starts_with("#")) {
    const std::size_t end = toml.find('\n');
    text += std::string(toml.substr(1, end - 1));
    toml.remove_prefix(end + 1);
  }
  text = text.substr(text.find_first_not_of(' '));
  return text.substr(0, text.find('.'));
}

ShippedGrid shipped(std::string name, std::string_view toml) {
  return {std::move(name), summary_of(toml), toml};
}

}  // namespace

const std::vector<ShippedGrid>& shipped_grids() {
  static const std::vector<ShippedGrid> kGrids = {
      shipped("quick", embedded::quick_grid()),
      shipped("paper", embedded::paper_grid()),
      shipped("measured", embedded::measured_grid()),
      shipped("nightly", embedded::nightly_grid()),
      shipped("nguyen", embedded::nguyen_grid()),
      shipped("peer", embedded::peer_grid()),
      shipped("parfam_optimizers", embedded::parfam_optimizers_grid()),
      shipped("udsr_ablation", embedded::udsr_ablation_grid()),
      shipped("udsr_ablation_nguyen", embedded::udsr_ablation_nguyen_grid()),
      shipped("relay_ablation", embedded::relay_ablation_grid())};
  return kGrids;
}

Grid load_named_grid(const std::string& name_or_file, const Registry& registry,
                     const Catalogue& catalogue) {
  for (const ShippedGrid& grid : shipped_grids()) {
    if (grid.name == name_or_file && !std::filesystem::is_regular_file(name_or_file)) {
      Grid parsed = parse_grid(grid.toml, grid.name + ".toml", registry, catalogue);
      if (parsed.reference_file == "paper_reference.csv") {
        parsed.reference = embedded::paper_reference();
      }
      return parsed;
    }
  }
  for (const suite::ShippedSuite& suite : suite::shipped_suites()) {
    if (suite.name == name_or_file && !std::filesystem::is_regular_file(name_or_file)) {
      return parse_grid(suite.toml, name_or_file + ".toml", registry, catalogue);
    }
  }
  // A word that is no path was meant for a name.
  std::error_code unknown;
  if (is_plain_name(name_or_file) && !std::filesystem::exists(name_or_file, unknown)) {
    std::vector<std::string> names;
    for (const ShippedGrid& grid : shipped_grids()) names.emplace_back(grid.name);
    for (const suite::ShippedSuite& suite : suite::shipped_suites()) names.emplace_back(suite.name);
    throw_bad_input(fmt::format("there is no grid '{}'", name_or_file), {},
                    did_you_mean(name_or_file, names,
                                 "give the path of a TOML file, or a name from: tribench list "
                                 "grids"));
  }
  return load_grid(name_or_file, registry, catalogue);
}

}  // namespace tribench
