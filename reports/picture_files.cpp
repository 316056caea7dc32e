// SPDX-License-Identifier: MIT
#include "reports/picture_files.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "foundation/child_process.hpp"
#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/output_file.hpp"
#include "foundation/output_folder.hpp"
#include "foundation/scratch_folder.hpp"
#include "reports/html/embedded.hpp"

namespace tribench {
namespace {

constexpr const char* kDrawing = "node";
constexpr const char* kDrawingPackage = "nodejs";
constexpr const char* kPng = "rsvg-convert";
constexpr const char* kPngPackage = "librsvg2-bin";

[[noreturn]] void throw_not_started(std::string_view program, std::string_view why,
                                    std::string_view package) {
  throw Error(ErrorKind::failed, fmt::format("{} cannot be started ({})", program, why), "pictures",
              fmt::format("apt-get install {}", package));
}

void require_program(const char* program, std::string_view package) {
  if (found_in_path(program) == program) throw_not_started(program, "it is not there", package);
}

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
    throw_not_started(program, error.what(), package);
  }
}

}  // namespace

void make_picture_folder(const std::filesystem::path& folder) {
  make_output_folder(folder);
  require_program(kDrawing, kDrawingPackage);
  require_program(kPng, kPngPackage);
}

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
  options.command = {kDrawing, "-", data_file.string(), folder.string()};
  options.command.insert(options.command.end(), only.begin(), only.end());
  options.scratch = scratch.path();
  std::istringstream printed(run_drawing(options, script, kDrawingPackage));
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
    write_file(
        folder / names.back(),
        run_drawing({.command = {kPng, "--zoom", "2", (folder / name).string()}}, {}, kPngPackage));
  }
  return names;
}

}  // namespace tribench
