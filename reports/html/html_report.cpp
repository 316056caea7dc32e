// SPDX-License-Identifier: MIT
#include "reports/html/html_report.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <utility>

#include "foundation/json_text.hpp"
#include "reports/html/embedded.hpp"
#include "reports/markup.hpp"

namespace tribench {
namespace {

std::string base64(std::string_view bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      const auto byte = i + j < bytes.size() ? static_cast<unsigned char>(bytes[i + j]) : 0U;
      word = (word << 8U) | byte;
    }
    for (std::size_t j = 0; j < 4; ++j) {
      text += i + j > bytes.size() ? '=' : kDigits[(word >> (18U - 6U * j)) & 63U];
    }
  }
  return text;
}

struct Font {
  const char* family;
  const char* style;
  std::string_view (*bytes)();
};

std::string font_faces() {
  const std::array<Font, 6> fonts = {{{"KaTeX_Main", "normal", embedded::font_main},
                                      {"KaTeX_Math", "italic", embedded::font_math},
                                      {"KaTeX_Size1", "normal", embedded::font_size1},
                                      {"KaTeX_Size2", "normal", embedded::font_size2},
                                      {"KaTeX_Size3", "normal", embedded::font_size3},
                                      {"KaTeX_Size4", "normal", embedded::font_size4}}};
  std::string css;
  for (const Font& font : fonts) {
    css += fmt::format(
        "@font-face{{font-family:{};font-style:{};"
        "src:url(data:font/woff2;base64,{}) format(\"woff2\")}}\n",
        font.family, font.style, base64(font.bytes()));
  }
  return css;
}

// KaTeX's rules without its own @font-face, which name files.
std::string katex_rules() {
  std::string css(embedded::katex_css());
  for (std::size_t at = 0; (at = css.find("@font-face")) != std::string::npos;) {
    const std::size_t end = css.find('}', at);
    css.erase(at, end == std::string::npos ? std::string::npos : end - at + 1);
  }
  return css;
}

// JSON inside a script element: "</script" and "<!--" must not end it.
std::string script_safe(std::string text) {
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

void append_script(std::string& page, std::string_view script) {
  page += "<script>\n";
  page += script;
  page += "\n</script>\n";
}

// Before anything is drawn, so that a dark page never flashes white.
constexpr std::string_view kThemeScript =
    "document.documentElement.dataset.theme=matchMedia('(prefers-color-scheme: dark)').matches?"
    "'dark':'light';";

}  // namespace

std::string html_page(std::string_view title, PageKind kind, const nlohmann::ordered_json& data) {
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
      "script-src 'unsafe-inline' 'unsafe-eval'; style-src 'unsafe-inline'; font-src data:; "
      "img-src data:\">\n<title>{}</title>\n<style>\n",
      markup_text(title));
  page += font_faces();
  page += katex_rules();
  page += '\n';
  page += embedded::page_css();
  page += "</style>\n";
  append_script(page, kThemeScript);
  page +=
      "</head>\n<body>\n<a class=\"skip\" href=\"#main\">to the content</a>\n"
      "<header id=\"top\"></header>\n<nav aria-label=\"parts of the report\">"
      "<div class=\"inner\" id=\"nav\"></div></nav>\n<main id=\"main\"></main>\n"
      "<footer>Written by tribench. Opens without a network.</footer>\n"
      "<div id=\"tip\" role=\"status\"></div>\n"
      "<noscript>The pictures and tables of this page need JavaScript; leaderboard.md or loop.md "
      "beside it holds the same figures as text.</noscript>\n"
      "<script type=\"application/json\" id=\"data\">";
  page += script_safe(write_json(data));
  page += "</script>\n";
  append_script(page, embedded::vega_js());
  append_script(page, embedded::katex_js());
  append_script(page, embedded::formula_js());
  append_script(page, embedded::plots_js());
  const bool run = kind == PageKind::run;
  append_script(page, run ? embedded::run_plots_js() : embedded::loop_plots_js());
  append_script(page, embedded::common_js());
  append_script(page, run ? embedded::run_js() : embedded::loop_js());
  page += "</body>\n</html>\n";
  return page;
}

}  // namespace tribench
