// SPDX-License-Identifier: MIT
#include "reports/pictures.hpp"

#include <fmt/format.h>

#include <cctype>
#include <nlohmann/json.hpp>
#include <sstream>

#include "foundation/child_process.hpp"
#include "foundation/error.hpp"
#include "reports/html/embedded.hpp"
#include "reports/html/page_data.hpp"
#include "reports/record_csv.hpp"
#include "reports/run_folder.hpp"
#include "reports/summary.hpp"

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

// Runs the script in node; returns what it printed.
std::string run_in_node(const std::string& script, const std::vector<std::string>& arguments) {
  ChildOptions options;
  options.command = {"node", "-"};
  options.command.insert(options.command.end(), arguments.begin(), arguments.end());
  try {
    const ChildRun run = run_child(options, script);
    if (run.exit.ok()) return run.output;
    throw Error(ErrorKind::failed, fmt::format("the pictures could not be drawn: {}", run.errors),
                "node");
  } catch (const Error& error) {
    if (error.place() == "node") throw;
    throw Error(ErrorKind::failed, fmt::format("node cannot be started ({})", error.what()),
                "pictures", "apt-get install nodejs");
  }
}

}  // namespace

std::string picture_file(std::string_view problem, std::string_view operators,
                         std::string_view picture) {
  std::string name;
  bool replaced = false;  // a run of other characters becomes one _
  for (const char c : fmt::format("{}.{}.{}", problem, operators, picture)) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                       std::string_view("._+-").find(c) != std::string_view::npos;
    if (plain) name += c;
    if (!plain && !replaced) name += '_';
    replaced = !plain;
  }
  return name + ".svg";
}

std::vector<std::string> write_pictures(const std::filesystem::path& folder,
                                        const std::filesystem::path& out,
                                        const std::vector<std::string>& only) {
  const RunFolder run = read_run_folder(folder);
  const RunSummary summary = summarise(run);
  std::filesystem::create_directories(out);
  const ScratchFile data(
      out / ".data.json",
      page_data(run, summary, {})
          .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  std::string script;
  for (const std::string_view part : {embedded::vega_js(), embedded::plots_js(),
                                      embedded::run_plots_js(), embedded::pictures_js()}) {
    script += part;
    script += '\n';
  }
  std::vector<std::string> arguments = {data.name(), out.string()};
  arguments.insert(arguments.end(), only.begin(), only.end());
  std::istringstream printed(run_in_node(script, arguments));
  std::vector<std::string> files;
  for (std::string name; std::getline(printed, name);) files.push_back(name);
  return files;
}

}  // namespace tribench
