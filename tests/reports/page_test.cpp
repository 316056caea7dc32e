// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "foundation/output_file.hpp"
#include "foundation/random.hpp"
#include "reports/html/html_report.hpp"
#include "reports/night_page.hpp"
#include "reports/pictures.hpp"
#include "reports/record/record_csv.hpp"
#include "reports/run_reports.hpp"
#include "reports/study_page.hpp"
#include "reports/suite_view.hpp"
#include "tests/reports/browser.hpp"
#include "tests/reports/sample_run.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"

namespace tribench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

// A run with fronts, traces and curves, so that every picture has something to draw.
fs::path whole_run(const std::string& name) {
  const fs::path folder = fresh_folder(name);
  write_sample_run(folder, 4);
  std::vector<FrontRecord> front;
  std::vector<TraceRecord> trace;
  std::vector<CurveRecord> curves;
  for (const Record& record : sample_records(4)) {
    if (!is_ok(record)) continue;
    front.push_back({record.cell, record.complexity, record.nodes, record.mae_train,
                     record.mae_test, record.singularity, true, record.formula});
    front.push_back({record.cell, 5, 7, 1, 1, Singularity::proved_free, false, "14*qd"});
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
  EXPECT_THAT(page, HasSubstr("<title>a &lt;b&gt; &amp; c</title>"));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  EXPECT_THAT(page, Not(HasSubstr("</script><script>alert(1)")));
  for (const char* outside : {"src=\"http", "href=\"http", "url(http", "@import"}) {
    EXPECT_THAT(page, Not(HasSubstr(outside))) << outside;
  }
}

// Embedded files are built anew when they change, also where sources are compiled together.
TEST(Page, HasTheScriptsAndStylesAsTheyLieInTheTree) {
  const std::string page = html_page("a", PageKind::run, nlohmann::ordered_json::object());
  for (const char* file : {"common.js", "plots.js", "run_plots.js", "run.js", "page.css"}) {
    EXPECT_NE(page.find(testing::read_text(testing::source_dir() / "reports/html/page" / file)),
              std::string::npos)
        << file;
  }
}

// Two hundred nights of two series and a bench, a change in one of each.
fs::path page_of_nights() {
  StoreHistory history;
  history.nights.resize(200);
  BenchHistory bench;
  bench.name = "expression_bench interpreter<double>/set:1/rows:1000/level:-1";
  history.series.resize(2);
  RandomStream random(key_of("page of nights"));
  for (std::size_t k = 0; k < 200; ++k) {
    history.nights[k].name = "night " + std::to_string(k);
    bench.nights.push_back(k);
    bench.instructions.push_back(k < 120 ? 14 : 14.01);
    bench.misses.push_back(8);
    bench.time.push_back(0.03 * random.normal());
    for (SeriesHistory& series : history.series) {
      series.problem = "A/j2/load";
      series.method = "pysr";
      series.operators = "paper+div";
      series.nights.push_back(k);
      series.log_errors.push_back(0.05 * random.normal());
    }
  }
  history.series[1].changes = {{80, 0.0, 0.2}};
  bench.changes = {{120, 14, 14.01}};
  history.benches = {bench};
  const fs::path folder = fresh_folder("page_of_nights");
  write_file(folder / "nights.html", history_page(history));
  return folder / "nights.html";
}

const Question kLinesOfNights(page_of_nights, R"(
    const inside = (e) => e.getBBox().y >= -1 && e.getBBox().y + e.getBBox().height <= 91;
    window.answer = {
      lines: document.querySelectorAll('polyline').length,
      inside: [...document.querySelectorAll('polyline')].every(inside),
      marks: document.querySelectorAll('line.worse').length,
      rows: document.querySelectorAll('td.worse').length,
      wide: document.documentElement.scrollWidth > window.innerWidth,
      loaded: performance.getEntriesByType('resource').length};
  )",
                              {390, 800});

TEST(Page, OfNightsDrawsALineForEverySeriesAndFigureWithinItsWindow) {
  if (!has_browser()) GTEST_SKIP() << "no chromium";
  const json answer = kLinesOfNights.answer();
  ASSERT_TRUE(answer.is_object()) << answer;
  EXPECT_EQ(answer["lines"], 5);
  EXPECT_EQ(answer["inside"], true);
  EXPECT_EQ(answer["marks"], 2);
  EXPECT_EQ(answer["rows"], 2);
  EXPECT_EQ(answer["wide"], false) << "a phone scrolls in one direction only";
  EXPECT_EQ(answer["loaded"], 0);
}

// Draws everything, hides and shows a method, sorts, filters, hovers over a dot and clicks on it.
constexpr const char* kUseEverything = R"(
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
      tex: formulaToTex('a + -3*b - -2*c*(-d)'), tex_folded: formulaToTex('cos(1*100*q)*2'),
      values,  hidden,
      pressed, waiting: waitingBefore,
      requests: performance.getEntriesByType('resource').map((r) => r.name)};
  )";

const Question kEverything([] { return whole_run("page") / "report.html"; }, kUseEverything);

TEST(Page, DrawsEveryPictureSortsFiltersAndShowsAFormulaOnHover) {
  if (!has_browser()) GTEST_SKIP() << "no chromium";
  const json answer = kEverything.answer();
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
  EXPECT_EQ(answer["tex_folded"], "2\\,\\cos\\left(100\\,q\\right)");
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

fs::path page_with_changes() {
  const fs::path base = whole_run("page_base");
  const fs::path folder = whole_run("page_phone");
  write_run_reports(folder, base);
  return folder / "report.html";
}

const Question kOnAPhone(page_with_changes, looking(R"(
    const first = document.getElementById('main').firstElementChild;
    const line = () => [...document.querySelectorAll('#profile .mark-line.role-mark path')].map((p) => p.getAttribute('stroke-opacity') || '1');
    const label = document.querySelector('#profile .role-legend-label text');
    const at = label.getBoundingClientRect();
    const before = line();
    label.dispatchEvent(new MouseEvent('mouseover', {bubbles: true, clientX: at.x + 2, clientY: at.y + 2}));
    await new Promise((done) => setTimeout(done, 100));
    const cell = document.querySelector('table[aria-label^="methods on"] td[data-label^="MAE"]');
    window.answer = {first: first.id, text: first.textContent, before, hovered: line(), scroll: document.documentElement.scrollWidth,
      width: innerWidth, room: document.documentElement.clientWidth, label: cell.dataset.label, errors: window.pageErrors};
  )"),
                         {390, 844});

TEST(Page, OfARunFitsAPhoneSaysItsUnitAndWhatChangedFirst) {
  if (!has_browser()) GTEST_SKIP() << "no chromium";
  const json answer = kOnAPhone.answer();
  ASSERT_TRUE(answer.is_object()) << answer;
  EXPECT_EQ(answer["errors"], json::array());
  EXPECT_EQ(answer["first"], "changed");
  EXPECT_THAT(answer["text"].get<std::string>(), HasSubstr("2026-01-31"));
  EXPECT_EQ(answer["label"], "MAE test (N m)");
  EXPECT_EQ(answer["width"], 390);
  EXPECT_LE(answer["scroll"], answer["room"]);
  EXPECT_EQ(answer["before"], (json{"1", "1", "1"}));
  EXPECT_EQ(answer["hovered"], (json{"1", "0.1", "0.1"}));  // the others fade
}

// The sample's two problems as the tables of a suite, with one published method.
fs::path page_of_a_suite() {
  const fs::path folder = whole_run("page_suite");
  SuiteInfo suite;
  suite.name = "A";
  suite.summary = "two tables";
  suite.results_note = "read with care";
  for (const char* table : {"A/j2/no_load", "A/j4/no_load"}) {
    suite.problems.push_back({table, "", 0});
    suite.results.push_back({table, "theirs", true, 2, 7});  // better than anything can be
  }
  write_file(folder / kSuiteFile, suites_json({suite}));
  write_run_reports(folder);
  return folder / "report.html";
}

const Question kSuiteTables(page_of_a_suite, looking(R"(
    const rows = (name) => [...document.querySelectorAll(`table[aria-label="${name}"] tbody tr`)].map((r) => r.textContent);
    window.answer = {errors: window.pageErrors, ranks: rows('ranks on A'), tables: rows('published results of A'),
      ours: document.querySelector('table[aria-label="ranks on A"] strong')?.textContent};
  )"));

TEST(Page, OfASuiteRanksOursAmongThePublished) {
  if (!has_browser()) GTEST_SKIP() << "no chromium";
  const json answer = kSuiteTables.answer();
  ASSERT_TRUE(answer.is_object()) << answer;
  EXPECT_EQ(answer["errors"], json::array());
  ASSERT_FALSE(answer["ranks"].empty());
  EXPECT_THAT(answer["ranks"][0].get<std::string>(), HasSubstr("theirs"));
  EXPECT_TRUE(answer["ours"].is_string());
  EXPECT_THAT(answer["tables"][0].get<std::string>(), HasSubstr("2.00 (theirs)"));
}

fs::path page_of_an_unfinished_run() {
  const fs::path folder = fresh_folder("empty_page");
  write_file(folder / "grid.toml", "[grid]\nname = \"nothing yet\"\n");
  write_run_reports(folder);
  return folder / "report.html";
}

const Question kUnfinished(page_of_an_unfinished_run, R"(
    window.answer = {ready: document.documentElement.dataset.ready, errors: window.pageErrors};
  )");

TEST(Page, OfAnUnfinishedRunOpensToo) {
  if (!has_browser()) GTEST_SKIP() << "no chromium";
  const json answer = kUnfinished.answer();
  ASSERT_TRUE(answer.is_object());
  EXPECT_EQ(answer["ready"], "yes");
  EXPECT_EQ(answer["errors"], json::array());
}

}  // namespace
}  // namespace tribench
