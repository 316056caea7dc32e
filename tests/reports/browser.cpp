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

json asked_in_browser(const fs::path& page, const std::string& script, const std::string& window) {
  std::string text = text_of(page);
  const std::string end = "</body>";
  text.insert(text.rfind(end),
              "<script>\n(async () => {\ntry {\n" + script +
                  "\n} catch (error) { window.answer = String(error); }\n"
                  "document.body.innerHTML = '<pre id=answer></pre>';"
                  "document.getElementById('answer').textContent ="
                  "'BEGIN' + JSON.stringify(window.answer) + 'END';\n"
                  "parent.postMessage(document.getElementById('answer').textContent, '*');\n"
                  "})();\n</script>\n");
  fs::path asked = page;
  asked.replace_extension(".asked.html");
  write_file(asked, text);
  // The browser makes no window narrower than 500: a phone's is a frame of that size.
  if (std::stoi(window) < 500) {
    const fs::path framed = asked;
    asked.replace_extension(".framed.html");
    const std::size_t comma = window.find(',');
    write_file(asked, "<!DOCTYPE html><body><iframe src='" + framed.filename().string() +
                          "' style='border:0;width:" + window.substr(0, comma) +
                          "px;height:" + window.substr(comma + 1) +
                          "px'></iframe><script>onmessage = (e) => { document.body.textContent = "
                          "e.data; };</script></body>");
  }
  const fs::path profile = page.parent_path() / "profile";
  const std::string dom = output_of(
      "timeout 90 chromium --headless --no-sandbox --disable-gpu --disable-background-networking "
      "--disable-dev-shm-usage --user-data-dir=" +
      profile.string() + " --window-size=" + window +
      " --virtual-time-budget=10000 --dump-dom file://" + asked.string() + " 2>/dev/null");
  const std::size_t first = dom.rfind("BEGIN");
  const std::size_t last = dom.rfind("END");
  if (first == std::string::npos || last < first) return nullptr;
  return json::parse(dom.substr(first + 5, last - first - 5), nullptr, false);
}

std::string looking(const std::string& question) {
  return R"(
    window.drawEverything();
    await new Promise((done) => setTimeout(done, 250));
    const shown = (e) => e.checkVisibility() && e.getBoundingClientRect().width > 0;
  )" + question;
}

}  // namespace tribench
