// SPDX-License-Identifier: MIT
#include "harness/shipped_grids.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "foundation/error.hpp"
#include "tests/support/paths.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(ShippedGrids, AllParseAndSayWhatTheyAreFor) {
  const Registry registry;
  const Catalogue catalogue;
  std::vector<std::string> names;
  for (const ShippedGrid& shipped : shipped_grids()) {
    const Grid grid = load_named_grid(shipped.name, registry, catalogue);
    EXPECT_EQ(grid.name, shipped.name);
    EXPECT_FALSE(grid.cells().empty()) << shipped.name;
    EXPECT_GT(shipped.summary.size(), 20U) << shipped.name;
    names.push_back(shipped.name);
  }
  std::vector<std::string> files;
  for (const auto& file : std::filesystem::directory_iterator(testing::source_dir() / "grids")) {
    if (file.path().extension() == ".toml") files.push_back(file.path().stem().string());
  }
  EXPECT_THAT(names, ::testing::UnorderedElementsAreArray(files));
}

// What a grid declares it runs: a method under a name of the grid's own is one of its methods.
TEST(ShippedGrids, RunEveryMethodThatTheyDeclare) {
  const Registry registry;
  const Catalogue catalogue;
  for (const ShippedGrid& shipped : shipped_grids()) {
    const std::string text(shipped.toml);
    const Grid grid = load_named_grid(shipped.name, registry, catalogue);
    std::vector<std::string> names;
    for (const Method& method : grid.methods) names.push_back(method.name);
    const std::regex declared("\\[\\[method\\]\\]\\s*name = \"([^\"]+)\"");
    for (std::sregex_iterator at(text.begin(), text.end(), declared), end; at != end; ++at) {
      EXPECT_THAT(names, ::testing::Contains((*at)[1].str())) << shipped.name;
    }
  }
}

// The schema for editors must not know a key that the reader refuses.
TEST(GridSchema, NamesOnlyKeysThatTheReaderKnows) {
  std::ifstream stream(testing::source_dir() / "grids" / "grid.schema.json");
  const nlohmann::json schema = nlohmann::json::parse(stream);
  const Registry registry;
  const Catalogue catalogue;
  for (const auto& [table, description] : schema.at("properties").items()) {
    const bool is_array = description.at("type") == "array";
    const nlohmann::json& owner = is_array ? description.at("items") : description;
    for (const auto& [key, ignored] : owner.at("properties").items()) {
      const std::string open = is_array ? "[[" + table + "]]" : "[" + table + "]";
      const std::string toml =
          "[grid]\nproblems = [\"A/j2/no_load\"]\nmethods = [\"linear\"]\n" +
          (table == "grid" ? std::string() : open + "\n") +
          (table == "grid" && (key == "problems" || key == "methods") ? "" : key + " = []\n");
      try {
        parse_grid(toml, "g.toml", registry, catalogue);
      } catch (const Error& error) {
        EXPECT_THAT(error.what(), Not(HasSubstr("unknown key"))) << table << "." << key;
      }
    }
  }
}

}  // namespace
}  // namespace tribench
