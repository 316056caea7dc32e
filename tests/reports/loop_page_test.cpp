// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "reports/loop_report.hpp"
#include "reports/pictures.hpp"
#include "tests/reports/browser.hpp"
#include "tests/reports/sample_run.hpp"

namespace tribench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

// The loop's page, one verdict, in one window.
fs::path loop_page(const std::string& name, const LoopRecord& record) {
  const fs::path folder = fresh_folder(name);
  write_loop_report(record, folder);
  return folder / "loop.html";
}

LoopRecord loop_with(LoopVerdict verdict) {
  LoopRecord record = sample_loop();
  record.verdict = verdict;
  if (verdict == LoopVerdict::unknown) return record;
  record.leftover.inputs.clear();
  record.pictures.maps.clear();
  record.pictures.inputs[0].leftover = false;
  if (verdict == LoopVerdict::effects) return record;
  record.effects.clear();
  record.pictures.effects.clear();
  record.needed = {"20 stretches of movement", "the rigid body"};
  return record;
}

// Pairs of texts of one picture that lie over each other by more than a pixel.
constexpr const char* kOverlaps = R"(
    const overlaps = [];
    for (const plot of document.querySelectorAll('.plot')) {
      const boxes = [...plot.querySelectorAll('svg text')].filter((t) => t.textContent.trim() && shown(t) && getComputedStyle(t).opacity !== '0')
        .map((t) => ({text: t.textContent, box: t.getBoundingClientRect()}));
      boxes.forEach((a, i) => boxes.slice(i + 1).forEach((b) => {
        const wide = Math.min(a.box.right, b.box.right) - Math.max(a.box.left, b.box.left);
        const high = Math.min(a.box.bottom, b.box.bottom) - Math.max(a.box.top, b.box.top);
        if (wide > 1 && high > 2) overlaps.push(`${plot.id}: ${a.text} / ${b.text}`);
      }));
    }
)";

// Texts with less than 4.5 : 1 against what is behind them (WCAG 2.1).
constexpr const char* kFaint = R"(
    const canvas = document.createElement('canvas').getContext('2d', {willReadFrequently: true});
    const rgb = (colour) => { canvas.clearRect(0, 0, 1, 1); canvas.fillStyle = colour; canvas.fillRect(0, 0, 1, 1);
                              return [...canvas.getImageData(0, 0, 1, 1).data]; };
    const light = ([r, g, b]) => { const f = (c) => { c /= 255; return c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4; };
                                   return 0.2126 * f(r) + 0.7152 * f(g) + 0.0722 * f(b); };
    const behind = (e) => { for (; e; e = e.parentElement) { const c = rgb(getComputedStyle(e).backgroundColor); if (c[3] === 255) return c; } return [255, 255, 255, 255]; };
    const faint = new Set();
    for (const e of document.querySelectorAll('body *')) {
      const own = [...e.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim());
      if (!own || !shown(e) || e.closest('.katex-mathml') || e.closest('script, noscript')) continue;
      const style = getComputedStyle(e);
      const colour = rgb(e instanceof SVGElement ? style.fill : style.color);
      if (colour[3] < 255) continue;
      const [a, b] = [light(colour), light(behind(e))];
      const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
      if (ratio < 4.5) faint.add(`${e.tagName} ${e.className.baseVal ?? e.className}: ${e.textContent.trim().slice(0, 40)} ${ratio.toFixed(2)}`);
    }
)";

const Question kLoopPictures([] { return loop_page("loop_page", sample_loop()); }, looking(R"(
    const marks = {};
    for (const plot of document.querySelectorAll('.plot')) {
      marks[plot.id] = plot.querySelectorAll('svg .role-mark path, svg .role-mark line').length;
    }
    const text = (query) => (document.querySelector(query) || {textContent: ''}).textContent;
    const tex = [...document.querySelectorAll('dl.formulas .katex')].length;
    const chooser = document.querySelector('select[aria-label="movement"]');
    const code = [...document.querySelectorAll('button')].find((b) => b.textContent === 'C code');
    code.click();
    window.answer = {ready: document.documentElement.dataset.ready, errors: window.pageErrors, marks, tex,
      movements: chooser.options.length, code: document.querySelector('pre.code:not([hidden])').textContent,
      headline: text('.headline'), badge: text('.badge'), next: text('.answer'), body: document.body.innerText,
      requests: performance.getEntriesByType('resource').map((r) => r.name)};
  )"));

TEST(LoopPage, DrawsEveryPictureWithItsData) {
  if (!has_browser()) GTEST_SKIP() << "no chromium";
  const json answer = kLoopPictures.answer();
  ASSERT_TRUE(answer.is_object()) << answer;
  EXPECT_EQ(answer["ready"], "yes");
  EXPECT_EQ(answer["errors"], json::array());
  const std::map<std::string, int> least = {{"error", 4},     {"friction", 50},    {"effect-0", 40},
                                            {"effect-1", 80}, {"leftover-0", 100}, {"input-1", 60},
                                            {"trace", 5},     {"movements", 30},   {"evidence", 2},
                                            {"aliases", 9},   {"leftover-map", 25}};
  for (const auto& [id, count] : least) {
    ASSERT_TRUE(answer["marks"].contains(id)) << id;
    EXPECT_GE(answer["marks"][id].get<int>(), count) << id;
  }
  EXPECT_EQ(answer["marks"].size(), least.size());
  EXPECT_EQ(answer["tex"], 3);
  EXPECT_EQ(answer["movements"], 2);
  EXPECT_THAT(answer["code"].get<std::string>(), HasSubstr("double friction("));
  EXPECT_THAT(answer["headline"].get<std::string>(), HasSubstr("Friction falls with speed"));
  EXPECT_EQ(answer["badge"], "Something unknown");
  EXPECT_THAT(answer["next"].get<std::string>(), HasSubstr("depends on position"));
  EXPECT_THAT(answer["body"].get<std::string>(), HasSubstr("within one period of 2.50 mm"));
  EXPECT_THAT(answer["body"].get<std::string>(), HasSubstr("no acceleration in the data"));
  EXPECT_THAT(answer["body"].get<std::string>(),
              Not(HasSubstr("power_quadrant")));  // in details alone
  EXPECT_EQ(answer["requests"], json::array());
}

Question first_screen(LoopVerdict verdict) {
  const std::string folder = "loop_first_" + std::string(loop_verdict_name(verdict));
  return {[=] { return loop_page(folder, loop_with(verdict)); },
          looking(R"(
      const bottom = (query) => Math.max(0, ...[...document.querySelectorAll(query)].map((e) => e.getBoundingClientRect().bottom));
      window.answer = {ends: Math.max(bottom('.headline'), bottom('.matters'), bottom('.hero'), bottom('.effects .card')),
                       cards: document.querySelectorAll('.effects .card').length};
    )"),
          {1400, 900}};
}

const std::map<LoopVerdict, Question> kFirstScreens = {
    {LoopVerdict::none, first_screen(LoopVerdict::none)},
    {LoopVerdict::effects, first_screen(LoopVerdict::effects)},
    {LoopVerdict::unknown, first_screen(LoopVerdict::unknown)},
    {LoopVerdict::cannot_tell, first_screen(LoopVerdict::cannot_tell)}};

// What is missing, how much, how sure, what next: nothing of it needs scrolling.
TEST(LoopPage, AnswersOnTheFirstScreen) {
  if (!has_browser()) GTEST_SKIP() << "no chromium";
  for (const auto& [verdict, question] : kFirstScreens) {
    const json answer = question.answer();
    ASSERT_TRUE(answer.is_object()) << answer;
    EXPECT_GT(answer["ends"].get<double>(), 0);
    EXPECT_LE(answer["ends"].get<double>(), 900) << loop_verdict_name(verdict);
    EXPECT_EQ(answer["cards"], loop_with(verdict).effects.size());
  }
}

Question both_themes(const Window& window) {
  const std::string folder = "loop_fit_" + std::to_string(window.width);
  return {[=] { return loop_page(folder, sample_loop()); },
          R"(
      const looks = [];
      for (const theme of ['light', 'dark']) {
        setTheme(theme);)" +
              looking(std::string(kOverlaps) + kFaint) +
              R"(
        looks.push({theme, overlaps, faint: [...faint], width: innerWidth, room: document.documentElement.clientWidth, scroll: document.documentElement.scrollWidth,
          wide: [...document.querySelectorAll('.plot svg')].filter((s) => s.getBoundingClientRect().right > innerWidth).length});
      }
      window.answer = looks;
    )",
          window};
}

const std::map<int, Question> kThemesByWidth = {{1400, both_themes({1400, 900})},
                                                {390, both_themes({390, 844})}};

TEST(LoopPage, FitsAPhoneAndADeskInLightAndDark) {
  if (!has_browser()) GTEST_SKIP() << "no chromium";
  for (const auto& [width, question] : kThemesByWidth) {
    const json answer = question.answer();
    ASSERT_TRUE(answer.is_array()) << answer;
    ASSERT_EQ(answer.size(), 2U);
    for (const json& look : answer) {
      EXPECT_EQ(look["overlaps"], json::array()) << width << look["theme"];
      EXPECT_EQ(look["faint"], json::array()) << width << look["theme"];
      EXPECT_LE(look["scroll"].get<int>(), look["room"].get<int>()) << width;
      EXPECT_EQ(look["wide"], 0) << width;
      EXPECT_EQ(look["width"], width) << "the window is not the one asked for";
    }
  }
}

fs::path bare_loop_page() {
  LoopRecord record = sample_loop();
  record.error.ceiling = kNoFigure;
  record.error.attainable = kNoFigure;
  record.error.closed_fraction = kNoFigure;
  return loop_page("loop_bare", record);
}

const Question kBareText(bare_loop_page, looking("window.answer = document.body.innerText;"));

TEST(LoopPage, SaysNothingOfFiguresThatAreNotThere) {
  if (!has_browser()) GTEST_SKIP() << "no chromium";
  const json answer = kBareText.answer();
  ASSERT_TRUE(answer.is_string());
  EXPECT_THAT(answer.get<std::string>(), HasSubstr("0.2400 N m on movements"));
  EXPECT_THAT(answer.get<std::string>(), Not(HasSubstr("noise lies")));
  EXPECT_THAT(answer.get<std::string>(), Not(HasSubstr("NaN")));
}

TEST(LoopPage, WritesItsPicturesAsFiles) {
  if (std::system("command -v node >/dev/null 2>&1") != 0) GTEST_SKIP() << "no node";
  if (std::system("command -v rsvg-convert >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "no rsvg-convert";
  const fs::path folder = fresh_folder("loop_pictures");
  const std::vector<std::string> files = write_loop_pictures(sample_loop(), folder);
  EXPECT_THAT(files, ::testing::IsSupersetOf(
                         {"friction.svg", "friction.png", "effect-1.svg", "trace.png"}));
  EXPECT_EQ(files.size(), 22U);
  for (const std::string& name : files) {
    const std::string text = text_of(folder / name);
    EXPECT_GT(text.size(), 1500U) << name;
    if (name.ends_with(".png")) {
      EXPECT_TRUE(text.starts_with("\x89PNG")) << name;
    } else {
      EXPECT_THAT(text, Not(HasSubstr("NaN"))) << name;
    }
  }
  // Coordinates are cut to two decimals, figures are not.
  EXPECT_THAT(text_of(folder / "error.svg"), HasSubstr(">0.8100<"));
}

}  // namespace
}  // namespace tribench
