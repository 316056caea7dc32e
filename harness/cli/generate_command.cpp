// SPDX-License-Identifier: MIT
//
// tribench generate: a problem's data as a file.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "harness/catalogue.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/number_options.hpp"
#include "problems/measured/data_folder.hpp"
#include "problems/reading/csv.hpp"
#include "problems/table.hpp"

namespace tribench {
namespace {

struct GenerateOptions {
  std::string problem;
  std::uint64_t seed = 1;
  std::filesystem::path out;
  std::string data;
};

void generate(const GenerateOptions& options) {
  const Catalogue catalogue = full_catalogue(measured::find_data_folder(
      options.data.empty() ? std::nullopt : std::optional<std::filesystem::path>(options.data)));
  const ProblemEntry entry = catalogue.find(options.problem);
  const Dataset data =
      entry.data ? entry.data(options.seed) : dataset_of_tables(entry.make(options.seed));
  write_csv(data, options.out);
  fmt::print("{}: {} rows, {} movements, {} channels\n", options.out.string(), data.rows(),
             data.movement_names.size(), data.channels.size());
}

}  // namespace

void add_generate_command(CLI::App& app, ExitStatus& /*status*/) {
  CLI::App* command = app.add_subcommand("generate", "Write a problem's data to a CSV file");
  command->footer("Example: tribench generate A/j2/load --seed 3 --out a2.csv");
  auto options = std::make_shared<GenerateOptions>();
  command->add_option("PROBLEM", options->problem, "a name of `tribench list problems`")
      ->required();
  command->add_option("--seed", options->seed, "same seed, same data")
      ->transform(whole_number(0))
      ->capture_default_str();
  command->add_option("--out", options->out, "the file to write")->required();
  command->add_option("--data", options->data, "the folder with the measured sets");
  command->callback([options] { generate(*options); });
}

}  // namespace tribench
