// SPDX-License-Identifier: MIT
//
// tribench data: the measured sets, where they are and whether they are what they should be.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "harness/cli/commands.hpp"
#include "problems/measured/data_folder.hpp"
#include "problems/measured/manifest.hpp"

namespace tribench {
namespace {

namespace fs = std::filesystem;

struct DataArguments {
  std::string folder;
  std::string set;
  std::string from;
  bool json = false;

  std::optional<fs::path> data() const {
    return measured::find_data_folder(folder.empty() ? std::nullopt
                                                     : std::optional<fs::path>(folder));
  }
};

constexpr const char* kNoFolder = "there is no folder with measured sets";
constexpr const char* kFolderMend = "give --data DIR, set $TRIBENCH_DATA or make ./data";

const char* state_name(measured::FileState state) {
  switch (state) {
    case measured::FileState::good:
      return "good";
    case measured::FileState::missing:
      return "missing";
    case measured::FileState::changed:
      return "changed";
  }
  return "";
}

bool is_here(const measured::Manifest& manifest, const std::optional<fs::path>& folder) {
  std::error_code code;
  return folder && fs::is_directory(*folder / manifest.name, code);
}

void list_sets(const DataArguments& options) {
  const std::optional<fs::path> folder = options.data();
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (const measured::Manifest& manifest : measured::known_manifests(folder)) {
    const bool here = is_here(manifest, folder);
    array.push_back({{"name", manifest.name},
                     {"summary", manifest.title},
                     {"here", here},
                     {"licence", manifest.licence},
                     {"source", manifest.source},
                     {"files", manifest.files.size()},
                     {"problems", manifest.problems.size()}});
    if (!options.json) {
      fmt::print("{:<16} {:<8} {}\n{:25} {} files, {} problems; licence: {}\n", manifest.name,
                 here ? "here" : "absent", manifest.title, "", manifest.files.size(),
                 manifest.problems.size(), manifest.licence);
    }
  }
  if (options.json) fmt::print("{}\n", write_json(array, 2));
}

ExitStatus check_sets(const DataArguments& options) {
  const std::optional<fs::path> folder = options.data();
  if (!folder) throw_bad_input(kNoFolder, {}, kFolderMend);
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  bool any = false;
  bool all_good = true;
  for (const measured::Manifest& manifest : measured::known_manifests(folder)) {
    const bool wanted =
        options.set.empty() ? is_here(manifest, folder) : manifest.name == options.set;
    if (!wanted) continue;
    any = true;
    for (const measured::FileCheck& check :
         measured::check_set(manifest, *folder / manifest.name)) {
      all_good = all_good && check.state == measured::FileState::good;
      const std::string name = check.set + "/" + check.file;
      array.push_back({{"name", name}, {"summary", state_name(check.state)}});
      if (!options.json) {
        fmt::print("{:<8} {}{}\n", state_name(check.state), name,
                   check.found.empty() ? "" : fmt::format(" (SHA-256 {})", check.found));
      }
    }
  }
  if (!any) throw_bad_input("none of the measured sets is here", folder->string(), kFolderMend);
  if (options.json) fmt::print("{}\n", write_json(array, 2));
  return all_good ? ExitStatus::done : ExitStatus::found;
}

void add_set(const DataArguments& options) {
  // A data folder that is named need not exist yet; the default is ./data.
  const fs::path target =
      options.folder.empty() ? options.data().value_or(fs::path("data")) : fs::path(options.folder);
  const std::vector<measured::Manifest> known = measured::known_manifests(target);
  const measured::Manifest& manifest = measured::find_manifest(known, options.set);
  if (options.from.empty()) {
    throw_bad_input(fmt::format("'{}' is not fetched by this program", manifest.name), {},
                    fmt::format("get it from {} (licence: {}) and give --from DIR", manifest.source,
                                manifest.licence));
  }
  const fs::path added = measured::add_set(manifest, options.from, target);
  fmt::print("{}: {} files, all hashes good; licence: {}\n", added.string(), manifest.files.size(),
             manifest.licence);
  if (!manifest.cite.empty()) fmt::print("cite: {}\n", manifest.cite);
}

void add_common(CLI::App& command, DataArguments& options) {
  command.add_option("--data", options.folder,
                     "the folder with the measured sets (else $TRIBENCH_DATA, else ./data)");
}

}  // namespace

void add_data_command(CLI::App& app, ExitStatus& status) {
  CLI::App* data = app.add_subcommand("data", "Measured sets: what there is, and is it intact");
  data->footer("Example: tribench data check --data ../shared/data");
  data->require_subcommand(1);
  auto options = std::make_shared<DataArguments>();

  CLI::App* list = data->add_subcommand("list", "The sets the program knows");
  add_common(*list, *options);
  list->add_flag("--json", options->json, "an array of {name, summary, ...}");
  list->callback([options] { list_sets(*options); });

  CLI::App* check = data->add_subcommand("check", "Every file that is here against its SHA-256");
  add_common(*check, *options);
  check->add_option("NAME", options->set, "only this set, and all of it");
  check->add_flag("--json", options->json, "an array of {name, summary}");
  check->callback([options, &status] {
    if (!options->set.empty()) {
      measured::find_manifest(measured::known_manifests(options->data()), options->set);
    }
    status = check_sets(*options);
  });

  CLI::App* add = data->add_subcommand("add", "Copy a set you have into the data folder, checked");
  add_common(*add, *options);
  add->add_option("NAME", options->set, "a name of `tribench data list`")->required();
  add->add_option("--from", options->from, "the folder that holds the set's files");
  add->callback([options] { add_set(*options); });
}

}  // namespace tribench
