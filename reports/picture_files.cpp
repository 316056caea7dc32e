// SPDX-License-Identifier: MIT
#include "reports/picture_files.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "foundation/child_process.hpp"
#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/output_file.hpp"
#include "reports/html/embedded.hpp"

namespace tribench {
namespace {

// A file that goes with its owner.
class ScratchFile {
 public:
  ScratchFile(std::filesystem::path path, const std::string& text) : path_(std::move(path)) {
    write_file(path_, text);
  }
  ~ScratchFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  std::string name() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

// Runs a program that draws; returns what it printed.
std::string run_drawing(std::vector<std::string> command, const std::string& input,
                        std::string_view package) {
  const std::string program = command[0];
  ChildOptions options;
  options.command = std::move(command);
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
  const ScratchFile file(folder / ".data.json", write_json(data));
  std::string script;
  for (const std::string_view part : {embedded::vega_js(), embedded::plots_js()}) {
    script += part;
    script += '\n';
  }
  for (const std::string_view part : scripts) {
    script += part;
    script += '\n';
  }
  std::vector<std::string> command = {"node", "-", file.name(), folder.string()};
  command.insert(command.end(), only.begin(), only.end());
  std::istringstream printed(run_drawing(std::move(command), script, "nodejs"));
  std::vector<std::string> names;
  for (std::string name; std::getline(printed, name);) names.push_back(name);
  return names;
}

std::vector<std::string> write_png_beside(const std::filesystem::path& folder,
                                          const std::vector<std::string>& svg) {
  std::vector<std::string> names;
  for (const std::string& name : svg) {
    names.push_back(std::filesystem::path(name).replace_extension(".png").string());
    run_drawing({"rsvg-convert", "--zoom", "2", "--output", (folder / names.back()).string(),
                 (folder / name).string()},
                {}, "librsvg2-bin");
  }
  return names;
}

}  // namespace tribench
