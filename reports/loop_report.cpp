// SPDX-License-Identifier: MIT
#include "reports/loop_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "foundation/output_file.hpp"
#include "reports/html/embedded.hpp"
#include "reports/html/html_report.hpp"
#include "reports/html/loop_page.hpp"
#include "reports/picture_files.hpp"
#include "reports/record/loop_json.hpp"

namespace tribench {

std::string loop_html(const LoopRecord& record) {
  return html_page("Closing the loop: " + record.title, PageKind::loop, loop_page_data(record));
}

void write_loop_report(const LoopRecord& record, const std::filesystem::path& folder) {
  write_file(folder / "loop.json", write_loop_json(record));
  write_file(folder / "loop.md", loop_markdown(record));
  write_file(folder / "loop.html", loop_html(record));
}

std::vector<std::string> write_loop_pictures(const LoopRecord& record,
                                             const std::filesystem::path& folder) {
  std::vector<std::string> files =
      draw_picture_files({embedded::loop_plots_js(), embedded::loop_pictures_js()},
                         loop_page_data(record), folder, {});
  const std::vector<std::string> png = write_png_beside(folder, files);
  files.insert(files.end(), png.begin(), png.end());
  return files;
}

}  // namespace tribench
