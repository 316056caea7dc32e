// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "reports/html/html_report.hpp"
#include "reports/loop_report.hpp"
#include "reports/pictures.hpp"
#include "reports/record_csv.hpp"
#include "reports/run_reports.hpp"
#include "reports/study_page.hpp"
#include "tests/reports/sample_run.hpp"
#include "tests/support/run_program.hpp"

namespace tribench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::output_of;

bool has_browser() { return std::system("command -v chromium >/dev/null 2>&1") == 0; }

// Appends a script to the page, opens it in a browser without a network and returns what the
// script left in `window.answer`.
json asked_in_browser(const fs::path& page, const std::string& script) {
  std::string text = text_of(page);
  const std::string end = "</body>";
  text.insert(text.rfind(end),
              "<script>\n(async () => {\ntry {\n" + script +
                  "\n} catch (error) { window.answer = String(error); }\n"
                  "document.body.innerHTML = '<pre id=answer></pre>';"
                  "document.getElementById('answer').textContent ="
                  "'BEGIN' + JSON.stringify(window.answer) + 'END';\n})();\n</script>\n");
  fs::path asked = page;
  asked.replace_extension(".asked.html");
  write_file(asked, text);
  const fs::path profile = page.parent_path() / "profile";
  const std::string dom = output_of(
      "timeout 90 chromium --headless --no-sandbox --disable-gpu --disable-background-networking "
      "--disable-dev-shm-usage --user-data-dir=" +
      profile.string() + " --window-size=1300,1000 --virtual-time-budget=10000 --dump-dom file://" +
      asked.string() + " 2>/dev/null");
  const std::size_t first = dom.rfind("BEGIN");
  const std::size_t last = dom.rfind("END");
  if (first == std::string::npos || last < first) return nullptr;
  return json::parse(dom.substr(first + 5, last - first - 5), nullptr, false);
}

// A run with fronts, traces and curves, so that every picture has something to draw.
fs::path whole_run(const std::string& name) {
  const fs::path folder = fresh_folder(name);
  write_sample_run(folder, 4);
  std::vector<FrontRecord> front;
  std::vector<TraceRecord> trace;
  std::vector<CurveRecord> curves;
  for (const Record& record : sample_records(4)) {
    if (record.status != "ok") continue;
    front.push_back({record.cell, record.complexity, record.nodes, record.mae_train,
                     record.mae_test, record.singularity, true, record.formula});
    front.push_back({record.cell, 5, 7, 1, 1, "proved_free", false, "14*qd"});
    trace.push_back({record.cell, 1000, 0.01, 2 * record.mae_train});
    trace.push_back({record.cell, 900'000, 0.5, record.mae_train});
    if (record.seed != 1) continue;
    for (const char* picture : {"friction", "error", "profile"}) {
      for (int i = 0; i < 5; ++i) {
        curves.push_back({record.cell, record.problem, record.method, record.operators, picture,
                          "model", "velocity in rad/s", "torque in N m", 0.1 * i, 1.0 * i});
      }
    }
  }
  write_file(folder / "front.csv", front_csv(front));
  write_file(folder / "trace.csv", trace_csv(trace));
  write_file(folder / "curves.csv", curves_csv(curves));
  write_run_reports(folder);
  return folder;
}

TEST(Page, AsksForNothingFromOutsideAndRunsNoTextOfTheData) {
  nlohmann::ordered_json data = {{"name", "</script><script>alert(1)</script>"}};
  const std::string page = html_page("a <b> & c", PageKind::run, data);
  EXPECT_THAT(page, HasSubstr("<title>a &lt;b> &amp; c</title>"));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  EXPECT_THAT(page, Not(HasSubstr("</script><script>alert(1)")));
  for (const char* outside : {"src=\"http", "href=\"http", "url(http", "@import"}) {
    EXPECT_THAT(page, Not(HasSubstr(outside))) << outside;
  }
}

TEST(Page, DrawsEveryPictureSortsFiltersAndShowsAFormulaOnHover) {
  if (!has_browser()) GTEST_SKIP() << "no chromium";
  const fs::path folder = whole_run("page");
  const json answer = asked_in_browser(folder / "report.html", R"(
    const choose = (id, value) => { const s = document.getElementById(id); s.value = value;
                                    s.dispatchEvent(new Event('change')); };
    const drawn = async () => { window.drawEverything(); await new Promise((done) => setTimeout(done, 200)); };
    choose('choose-operators', 'paper+div');
    const waitingBefore = [...document.querySelectorAll('.plot')].filter((p) => !p.querySelector('svg')).length;
    await new Promise((done) => setTimeout(done, 300));
    await drawn();
    const marks = {};
    for (const plot of document.querySelectorAll('.plot')) {
      marks[plot.id] = plot.querySelectorAll('svg path, svg rect, svg line').length;
    }
    const rows = document.getElementById('front-rows');
    rows.open = true;
    await new Promise((done) => setTimeout(done, 50));
    const values = rows.querySelectorAll('tbody tr').length;
    const chip = [...document.querySelectorAll('.chip')].find((c) => c.textContent === 'pysr');
    const dots = () => document.querySelectorAll('#front .mark-symbol.role-mark path').length;
    const before = dots();
    chip.click();
    await drawn();
    const hidden = before - dots();
    const pressed = chip.getAttribute('aria-pressed');
    chip.click();
    await drawn();
    const table = document.querySelector('table[aria-label="records"]');
    const column = (n) => [...table.querySelectorAll('tbody tr')].map((r) => r.children[n].textContent);
    const heads = [...table.querySelectorAll('th')];
    const at = heads.findIndex((h) => h.textContent === 'mae_test');
    heads[at].querySelector('button').click();
    const up = column(at).filter((t) => t !== '–').map(Number);
    heads[at].querySelector('button').click();
    const down = column(at).filter((t) => t !== '–').map(Number);
    const filter = document.querySelector('input[aria-label="filter rows of records"]');
    filter.value = 'sigsegv';
    filter.dispatchEvent(new Event('input'));
    const dot = document.querySelector('#front .mark-symbol.role-mark path');
    dot.dispatchEvent(new MouseEvent('mousemove', {bubbles: true, clientX: 10, clientY: 10}));
    dot.dispatchEvent(new MouseEvent('mouseover', {bubbles: true, clientX: 10, clientY: 10}));
    const at_dot = dot.getBoundingClientRect();
    for (const kind of ['pointerdown', 'mousedown', 'pointerup', 'mouseup', 'click']) {
      dot.dispatchEvent(new MouseEvent(kind, {bubbles: true, clientX: at_dot.x + 2, clientY: at_dot.y + 2}));
    }
    const record = document.getElementById('record');
    window.answer = {
      ready: document.documentElement.dataset.ready, errors: window.pageErrors, marks,
      record: record.hidden ? '' : record.textContent,
      sorted: up.every((x, i) => i === 0 || up[i - 1] <= x) && down.every((x, i) => i === 0 || down[i - 1] >= x),
      numbers: up.length, aria: heads[at].getAttribute('aria-sort'), filtered: column(5),
      hover: document.querySelectorAll('#tip .katex').length,
      shown: document.querySelectorAll('dl.formulas .katex').length,
      tex: formulaToTex('a + -3*b - -2*c*(-d)'), numbers: formulaToTex('cos(1*100*q)*2'),
      values,  hidden,
      pressed, waiting: waitingBefore,
      requests: performance.getEntriesByType('resource').map((r) => r.name)};
  )");
  ASSERT_TRUE(answer.is_object()) << answer;
  EXPECT_EQ(answer["ready"], "yes");
  EXPECT_EQ(answer["errors"], json::array());
  EXPECT_GE(answer["marks"].size(), 11U);
  for (const auto& [id, count] : answer["marks"].items()) EXPECT_GT(count, 3) << id;
  EXPECT_TRUE(answer["sorted"]);
  EXPECT_GE(answer["numbers"], 30);
  EXPECT_EQ(answer["aria"], "descending");
  EXPECT_GE(answer["filtered"].size(), 1U);
  for (const json& reason : answer["filtered"]) EXPECT_EQ(reason, "crashed (SIGSEGV)");
  EXPECT_GE(answer["hover"], 1);
  EXPECT_THAT(answer["record"].get<std::string>(), HasSubstr("cell: A/j2/no_load|"));  // on click
  EXPECT_GE(answer["shown"], 3);
  EXPECT_EQ(answer["tex"], "a - 3\\,b - 2\\,c\\,d");
  EXPECT_EQ(answer["numbers"], "\\cos\\left(1\\cdot 100\\,q\\right)\\cdot 2");
  EXPECT_GE(answer["values"], 4);  // as a table, for who cannot see the picture
  EXPECT_GE(answer["hidden"], 1);  // a method's button takes its points out
  EXPECT_EQ(answer["pressed"], "false");
  EXPECT_GE(answer["waiting"], 5);  // not drawn before they come near the screen
  for (const json& request : answer["requests"]) {
    EXPECT_TRUE(request.get<std::string>().starts_with("data:")) << request;
  }
}

TEST(Pictures, AreWrittenAsSvgWithMarksAndNothingFromOutside) {
  if (std::system("command -v node >/dev/null 2>&1") != 0) GTEST_SKIP() << "no node";
  const fs::path folder = whole_run("pictures");
  const fs::path out = folder / "pictures";
  const std::vector<std::string> files = write_pictures(folder, out);
  EXPECT_THAT(files, ::testing::IsSupersetOf(
                         {"A_j2_no_load.paper+div.front.svg", "A_j2_no_load.paper.friction.svg",
                          "A_j4_no_load.paper.profile.svg", "A_j2_no_load.paper+div.singular.svg",
                          "all.paper.ranks.svg", "all.paper.heat.svg"}));
  std::size_t on_disk = 0;
  for (const auto& entry : fs::directory_iterator(out)) {
    ++on_disk;
    const std::string text = text_of(entry.path());
    EXPECT_TRUE(text.starts_with("<svg xmlns=")) << entry.path();
    EXPECT_THAT(text, HasSubstr("<title>")) << entry.path();
    EXPECT_THAT(text, HasSubstr("<path")) << entry.path();
    EXPECT_THAT(text, Not(HasSubstr("href=\"http"))) << entry.path();
    EXPECT_THAT(text, Not(HasSubstr("NaN"))) << entry.path();
  }
  EXPECT_EQ(on_disk, files.size());
  const std::string one = picture_file("A/j4/no_load", "paper", "profile");
  EXPECT_THAT(write_pictures(folder, folder / "one", {one, "nothing.svg"}),
              ::testing::ElementsAre(one));
}

// Settings, machine, figures and pictures, from the folder alone; what the caller adds in between.
TEST(StudyPage, HoldsWhatAReviewerAsksFor) {
  if (std::system("command -v node >/dev/null 2>&1") != 0) GTEST_SKIP() << "no node";
  const fs::path folder = whole_run("study_page");
  write_file(folder / "reference.csv",
             "table,problem,published_method,kind,methods,mae,complexity,note\n"
             "Table 1,A/j2/no_load,PySR,symbolic,pysr,0.041,15,why it differs\n");
  write_study_page(folder, folder / "docs/page.md", "\n## Added\n\nby the caller\n");
  const std::string text = text_of(folder / "docs/page.md");
  for (const char* part :
       {"# The run sample", "some CPU", "commit abc1234", "### Table 1: A/j2/no_load",
        "PySR: why it differs", "## Added", "](page/A_j2_no_load.paper.profile.svg)", "## Proofs",
        "## Would the ranking be another one?", "[grid]\nname = \"sample\""}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
  EXPECT_TRUE(fs::exists(folder / "docs/page/A_j2_no_load.paper.profile.svg"));
}

TEST(Page, OfALoopDrawsItsPictures) {
  if (!has_browser()) GTEST_SKIP() << "no chromium";
  const fs::path folder = fresh_folder("loop_page");
  write_loop_report(sample_loop(), "joint 2", folder);
  const json answer = asked_in_browser(folder / "loop.html", R"(
    await new Promise((done) => setTimeout(done, 300));
    const marks = {};
    for (const plot of document.querySelectorAll('.plot')) marks[plot.id] = plot.querySelectorAll('svg path').length;
    const lists = [...document.querySelectorAll('.card li')].map((line) => line.textContent).join();
    window.answer = {ready: document.documentElement.dataset.ready, errors: window.pageErrors, marks, lists};
  )");
  ASSERT_TRUE(answer.is_object());
  EXPECT_EQ(answer["ready"], "yes");
  EXPECT_EQ(answer["errors"], json::array());
  EXPECT_GT(answer["marks"]["residual-0"], 300);
  EXPECT_GT(answer["marks"]["movements"], 25);
  EXPECT_THAT(answer["lists"].get<std::string>(), HasSubstr("no acceleration in the data"));
  EXPECT_THAT(answer["lists"].get<std::string>(), HasSubstr("movement 17"));
}

TEST(Page, OfALoopSaysNothingOfFiguresThatAreNotThere) {
  if (!has_browser()) GTEST_SKIP() << "no chromium";
  const fs::path folder = fresh_folder("loop_page_bare");
  nlohmann::json loop = sample_loop();
  loop["error"]["ceiling"] = nullptr;
  loop["error"]["closed_fraction"] = nullptr;
  write_loop_report(loop, "joint 2", folder);
  const json answer = asked_in_browser(
      folder / "loop.html", "window.answer = document.querySelector('.facts').textContent;");
  ASSERT_TRUE(answer.is_string());
  EXPECT_THAT(answer.get<std::string>(), HasSubstr("MAE after"));
  EXPECT_THAT(answer.get<std::string>(), Not(HasSubstr("noise")));
  EXPECT_THAT(answer.get<std::string>(), Not(HasSubstr("closed")));
}

TEST(Page, OfAnUnfinishedRunOpensToo) {
  if (!has_browser()) GTEST_SKIP() << "no chromium";
  const fs::path folder = fresh_folder("empty_page");
  write_file(folder / "grid.toml", "[grid]\nname = \"nothing yet\"\n");
  write_run_reports(folder);
  const json answer = asked_in_browser(folder / "report.html", R"(
    window.answer = {ready: document.documentElement.dataset.ready, errors: window.pageErrors};
  )");
  ASSERT_TRUE(answer.is_object());
  EXPECT_EQ(answer["ready"], "yes");
  EXPECT_EQ(answer["errors"], json::array());
}

}  // namespace
}  // namespace tribench
