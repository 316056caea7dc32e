// SPDX-License-Identifier: MIT
#include "tests/reports/browser.hpp"

#include <cstdlib>
#include <utility>
#include <vector>

#include "foundation/output_file.hpp"
#include "tests/reports/sample_run.hpp"
#include "tests/support/run_program.hpp"

namespace tribench {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::output_of;

bool has_browser() { return std::system("command -v chromium >/dev/null 2>&1") == 0; }

namespace {

struct Asked {
  std::function<fs::path()> make_page;
  std::string script;
  Window window;
};

std::vector<Asked>& all_asked() {
  static std::vector<Asked> all;
  return all;
}

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
json answer_of(const fs::path& page) {
  const std::string dom = output_of(
      "timeout 90 chromium --headless --no-sandbox --disable-gpu --disable-background-networking "
      "--disable-dev-shm-usage --user-data-dir=" +
      (page.parent_path() / "profile").string() +
      " --window-size=1500,1100 --virtual-time-budget=10000 --dump-dom file://" + page.string() +
      " 2>/dev/null");
  const std::size_t first = dom.rfind("BEGIN");
  const std::size_t last = dom.rfind("END");
  if (first == std::string::npos || last < first) return nullptr;
  return json::parse(dom.substr(first + 5, last - first - 5), nullptr, false);
}

// An array in the questions' order. What is missing when the time is up stays null, and takes no
// other answer with it.
json ask_all(const std::vector<Asked>& all) {
  // What hears the answers comes first: a short page gives its own before the last frame is read.
  std::string text =
      "<!DOCTYPE html><style>iframe { position: absolute; left: 0; top: 0; border: 0 "
      "}</style><body><script>const all = Array(" +
      std::to_string(all.size()) +
      ").fill(null); let missing = all.length;\n"
      "const tell = (place) => { place.textContent = 'BEGIN' + JSON.stringify(all) + 'END'; };\n"
      "onmessage = ({data}) => { all[data.number] = data.answer ?? null; missing -= 1;\n"
      "  tell(missing ? document.querySelector('pre') : document.body); };</script><pre></pre>";
  // One above the other: what lies outside the window is not drawn.
  for (std::size_t k = 0; k < all.size(); ++k) {
    text += "<iframe src='file://" + page_with(all[k].script, all[k].make_page(), k).string() +
            "' style='width:" + std::to_string(all[k].window.width) +
            "px;height:" + std::to_string(all[k].window.height) + "px'></iframe>";
  }
  text += "</body>";
  const fs::path frames = fresh_folder("browser") / "frames.html";
  write_file(frames, text);
  const json answers = answer_of(frames);
  return answers.is_array() ? answers : json(all.size(), nullptr);
}

}  // namespace

Question::Question(std::function<fs::path()> make_page, std::string script, Window window)
    : number_(all_asked().size()) {
  all_asked().push_back({std::move(make_page), std::move(script), window});
}

json Question::answer() const {
  static const json answers = ask_all(all_asked());
  return answers[number_];
}

std::string looking(const std::string& question) {
  return R"(
    window.drawEverything();
    await new Promise((done) => setTimeout(done, 250));
    const shown = (e) => e.checkVisibility() && e.getBoundingClientRect().width > 0;
  )" + question;
}

}  // namespace tribench
