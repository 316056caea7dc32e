// SPDX-License-Identifier: MIT
#include "harness/cli/run_pictures.hpp"

#include <fmt/format.h>

#include <vector>

#include "reports/picture_files.hpp"
#include "reports/pictures.hpp"

namespace tribench {

void add_pictures_option(CLI::App& command, std::string& folder) {
  command.add_option(
      "--pictures", folder,
      "write every picture of the page as SVG and PNG into this folder (needs nodejs "
      "and librsvg2-bin)");
}

void write_run_pictures(const std::filesystem::path& run, const std::string& folder) {
  if (folder.empty()) return;
  const std::vector<std::string> files = write_pictures(run, folder);
  write_png_beside(folder, files);
  fmt::print("{} pictures in {}\n", files.size(), folder);
}

}  // namespace tribench
