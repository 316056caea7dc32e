// SPDX-License-Identifier: MIT
#include "reports/picture_files.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "foundation/child_process.hpp"
#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/output_file.hpp"
#include "foundation/scratch_folder.hpp"
#include "reports/html/embedded.hpp"

namespace tribench {
namespace {

// Runs a program that draws; returns what it printed.
std::string run_drawing(const ChildOptions& options, const std::string& input,
                        std::string_view package) {
  const std::string& program = options.command[0];
  try {
    const ChildRun run = run_child(options, input);
    if (run.exit.ok()) return run.output;
    throw Error(ErrorKind::failed, fmt::format("the pictures could not be drawn: {}", run.errors),
                program);
  } catch (const Error& error) {
    if (error.place() == program) throw;
    throw Error(ErrorKind::failed, fmt::format("{} cannot be started ({})", program, error.what()),
                "pictures", fmt::format("apt-get install {}", package));
  }
}

}  // namespace

std::vector<std::string> draw_picture_files(const std::vector<std::string_view>& scripts,
                                            const nlohmann::ordered_json& data,
                                            const std::filesystem::path& folder,
                                            const std::vector<std::string>& only) {
  std::filesystem::create_directories(folder);
  const ScratchFolder scratch;
  const std::filesystem::path data_file = scratch.path() / "data.json";
  write_file(data_file, write_json(data));
  std::string script;
  for (const std::string_view part : {embedded::vega_js(), embedded::plots_js()}) {
    script += part;
    script += '\n';
  }
  for (const std::string_view part : scripts) {
    script += part;
    script += '\n';
  }
  ChildOptions options;
  options.command = {"node", "-", data_file.string(), folder.string()};
  options.command.insert(options.command.end(), only.begin(), only.end());
  options.scratch = scratch.path();
  std::istringstream printed(run_drawing(options, script, "nodejs"));
  std::vector<std::string> names;
  for (std::string name; std::getline(printed, name);) names.push_back(name);
  return names;
}

std::vector<std::string> write_png_beside(const std::filesystem::path& folder,
                                          const std::vector<std::string>& svg) {
  std::vector<std::string> names;
  for (const std::string& name : svg) {
    names.push_back(std::filesystem::path(name).replace_extension(".png").string());
    // Printed and not written by rsvg-convert: half a picture would stay where it is killed.
    write_file(folder / names.back(),
               run_drawing({.command = {"rsvg-convert", "--zoom", "2", (folder / name).string()}},
                           {}, "librsvg2-bin"));
  }
  return names;
}

}  // namespace tribench
