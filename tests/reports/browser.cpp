// SPDX-License-Identifier: MIT
#include "tests/reports/browser.hpp"

#include <cstdlib>

#include "foundation/output_file.hpp"
#include "tests/reports/sample_run.hpp"
#include "tests/support/run_program.hpp"

namespace tribench {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::output_of;

bool has_browser() { return std::system("command -v chromium >/dev/null 2>&1") == 0; }

namespace {

constexpr int kNarrowest = 500;  // pixels: the browser makes no window narrower

// The page with a script that leaves its answer in the document, and tells it to the page around
// it.
fs::path page_with(const std::string& script, const fs::path& page, std::size_t number) {
  std::string text = text_of(page);
  const std::string end = "</body>";
  text.insert(text.rfind(end), "<script>\n(async () => {\ntry {\n" + script +
                                   "\n} catch (error) { window.answer = String(error); }\n"
                                   "document.body.innerHTML = '<pre id=answer></pre>';"
                                   "document.getElementById('answer').textContent ="
                                   "'BEGIN' + JSON.stringify(window.answer) + 'END';\n"
                                   "parent.postMessage({number: " +
                                   std::to_string(number) +
                                   ", answer: window.answer}, '*');\n"
                                   "})();\n</script>\n");
  fs::path asked = page;
  asked.replace_extension("." + std::to_string(number) + ".asked.html");
  write_file(asked, text);
  return asked;
}

// What a script of the page leaves between BEGIN and END, read by a browser.
json answer_of(const fs::path& page, Window window) {
  const std::string dom = output_of(
      "timeout 90 chromium --headless --no-sandbox --disable-gpu --disable-background-networking "
      "--disable-dev-shm-usage --user-data-dir=" +
      (page.parent_path() / "profile").string() + " --window-size=" + std::to_string(window.width) +
      "," + std::to_string(window.height) + " --virtual-time-budget=10000 --dump-dom file://" +
      page.string() + " 2>/dev/null");
  const std::size_t first = dom.rfind("BEGIN");
  const std::size_t last = dom.rfind("END");
  if (first == std::string::npos || last < first) return nullptr;
  return json::parse(dom.substr(first + 5, last - first - 5), nullptr, false);
}

}  // namespace

json asked_in_browser(const fs::path& page, const std::string& script, Window window) {
  if (window.width >= kNarrowest) return answer_of(page_with(script, page, 0), window);
  return all_asked_in_browser({{page, window}}, script)[0];
}

json all_asked_in_browser(const std::vector<ShownPage>& pages, const std::string& script) {
  // One above the other: what lies outside the window is not drawn.
  std::string text =
      "<!DOCTYPE html><style>iframe { position: absolute; left: 0; top: 0; border: 0 "
      "}</style><body>";
  for (std::size_t k = 0; k < pages.size(); ++k) {
    text += "<iframe src='file://" + page_with(script, pages[k].page, k).string() +
            "' style='width:" + std::to_string(pages[k].window.width) +
            "px;height:" + std::to_string(pages[k].window.height) + "px'></iframe>";
  }
  text += "<script>const all = Array(" + std::to_string(pages.size()) +
          ").fill(null); let missing = all.length;\n"
          "onmessage = ({data}) => { all[data.number] = data.answer ?? null; missing -= 1;\n"
          "  if (!missing) document.body.textContent = 'BEGIN' + JSON.stringify(all) + 'END'; };"
          "</script></body>";
  const fs::path frames = pages.front().page.parent_path() / "frames.html";
  write_file(frames, text);
  const json answers = answer_of(frames, {1500, 1100});
  return answers.is_array() ? answers : json(pages.size(), nullptr);
}

std::string looking(const std::string& question) {
  return R"(
    window.drawEverything();
    await new Promise((done) => setTimeout(done, 250));
    const shown = (e) => e.checkVisibility() && e.getBoundingClientRect().width > 0;
  )" + question;
}

}  // namespace tribench
