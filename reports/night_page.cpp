// SPDX-License-Identifier: MIT
#include "reports/night_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "foundation/order_statistics.hpp"
#include "reports/figures.hpp"
#include "reports/markdown.hpp"

namespace tribench {
namespace {

constexpr std::size_t kPoints = 300;  // of a line
constexpr double kWidth = 320;
constexpr double kHeight = 90;
constexpr double kMargin = 6;

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '<':
        result += "&lt;";
        break;
      case '&':
        result += "&amp;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c >= 0 && c < ' ' ? ' ' : c;
    }
  }
  return result;
}

// Medians of equal parts of the line where it has more points than are drawn.
std::vector<std::pair<double, double>> drawn_points(const SeriesHistory& series) {
  const std::size_t n = series.log_errors.size();
  const std::size_t parts = std::min(n, kPoints);
  std::vector<std::pair<double, double>> points;
  for (std::size_t k = 0; k < parts; ++k) {
    const std::size_t begin = k * n / parts;
    const std::size_t end = (k + 1) * n / parts;
    const std::span<const double> part(series.log_errors.data() + begin, end - begin);
    points.emplace_back(static_cast<double>(series.nights[begin]), median(part));
  }
  return points;
}

std::string line_svg(const SeriesHistory& series, std::size_t nights) {
  const auto points = drawn_points(series);
  const auto [least, most] =
      std::ranges::minmax(series.log_errors);  // never empty: a series has a night
  const double low = std::min(least, most - 0.02);
  const double span = std::max(1.0, static_cast<double>(nights - 1));
  const auto x_of = [&](double night) { return kMargin + (kWidth - 2 * kMargin) * night / span; };
  const auto y_of = [&](double value) {
    return kHeight - kMargin - (kHeight - 2 * kMargin) * (value - low) / std::max(1e-9, most - low);
  };
  std::string text = fmt::format("<svg viewBox=\"0 0 {} {}\" width=\"{}\" height=\"{}\">", kWidth,
                                 kHeight, kWidth, kHeight);
  for (const LevelChange& change : series.changes) {
    const double x = x_of(static_cast<double>(series.nights[change.at]));
    text += fmt::format("<line class=\"{}\" x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"0\" y2=\"{}\"/>",
                        change.after > change.before ? "worse" : "better", x, x, kHeight);
  }
  text += "<polyline points=\"";
  for (const auto& [night, value] : points) {
    text += fmt::format("{:.1f},{:.1f} ", x_of(night), y_of(value));
  }
  return text + "\"/></svg>";
}

std::vector<std::vector<std::string>> change_rows(const StoreHistory& history) {
  std::vector<std::vector<std::string>> rows;
  for (const SeriesHistory& series : history.series) {
    for (const LevelChange& change : series.changes) {
      const Night& night = history.nights[series.nights[change.at]];
      rows.push_back({night.name, series.problem, series.method, series.operators,
                      figure(elementary::exp(change.after - change.before), 4), night.commit,
                      night.machine});
    }
  }
  std::ranges::sort(rows, std::greater<>());  // the newest first
  return rows;
}

constexpr const char* kStyle =
    "body{font:15px/1.5 sans-serif;margin:2em auto;max-width:1060px;color:#222}"
    "figure{display:inline-block;margin:4px 8px;vertical-align:top}"
    "figcaption{font-size:13px}svg{background:#f7f7f7}"
    "polyline{fill:none;stroke:#0072b2;stroke-width:1.3}"
    "line.worse{stroke:#d55e00;stroke-width:1.5}line.better{stroke:#009e73;stroke-width:1.5}"
    "td,th{padding:2px 10px;text-align:left;border-bottom:1px solid #ddd}table{border-collapse:"
    "collapse}";

}  // namespace

StoreHistory read_history(const NightStore& store) {
  StoreHistory history;
  history.blessings = store.blessings();
  std::map<std::string, SeriesHistory> all;
  std::map<std::string, std::vector<double>> weights;
  for (const std::string& name : store.names()) {
    try {
      history.nights.push_back(store.read(name, false));
    } catch (const Error& error) {
      history.damaged.emplace_back(error.what());
      continue;
    }
    Night& night = history.nights.back();
    for (const NightSeries& series : night.series) {
      if (!(series.median_error > 0) || std::isinf(series.median_error)) continue;
      SeriesHistory& one = all[series.key()];
      if (one.nights.empty()) {
        one.problem = series.problem;
        one.method = series.method;
        one.operators = series.operators;
      }
      one.nights.push_back(history.nights.size() - 1);
      one.log_errors.push_back(elementary::log(series.median_error));
      // The median of fewer seeds is less sure.
      weights[series.key()].push_back(static_cast<double>(series.cells - series.failed));
    }
    night.series = {};
  }
  for (auto& [key, series] : all) {
    series.changes = find_level_changes(series.log_errors, weights.at(key));
    history.series.push_back(std::move(series));
  }
  return history;
}

std::string history_text(const StoreHistory& history) {
  std::string text =
      fmt::format("{} nights, {} series", history.nights.size(), history.series.size());
  if (!history.blessings.empty()) {
    const Blessing& last = history.blessings.back();
    text += fmt::format("; base {} ({})", last.night, last.reason);
  }
  text += "\n";
  for (const std::string& damage : history.damaged) text += "damaged: " + damage + "\n";
  const auto rows = change_rows(history);
  if (rows.empty()) return text + "No change of level.\n";
  MarkdownTable table({{"first night"},
                       {"problem"},
                       {"method"},
                       {"operators"},
                       {"error now / before", Align::right},
                       {"commit"},
                       {"machine"}});
  for (const auto& row : rows) table.add(row);
  return text + "\n" + table.text();
}

std::string history_page(const StoreHistory& history) {
  std::string page = fmt::format(
      "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>tribench: nights</title>"
      "<style>{}</style><h1>Nights</h1><p>{} nights, {} lines; the median error on test movements, "
      "logarithmic, oldest left. A vertical line is a change of level: worse in orange, better in "
      "green.</p>",
      kStyle, history.nights.size(), history.series.size());
  for (const Blessing& each : history.blessings) {
    page += fmt::format("<p>{}: base {}: {}</p>", escaped(each.when), escaped(each.night),
                        escaped(each.reason));
  }
  for (const std::string& damage : history.damaged) {
    page += fmt::format("<p>damaged: {}</p>", escaped(damage));
  }
  page +=
      "<h2>Changes</h2><table><tr><th>first night</th><th>problem</th><th>method</th>"
      "<th>operators</th><th>error now / before</th><th>commit</th><th>machine</th></tr>";
  for (const auto& row : change_rows(history)) {
    page += "<tr>";
    for (const std::string& cell : row) page += fmt::format("<td>{}</td>", escaped(cell));
    page += "</tr>";
  }
  page += "</table><h2>Lines</h2>";
  for (const SeriesHistory& series : history.series) {
    page += fmt::format("<figure>{}<figcaption>{} <b>{}</b> {}: {} &rarr; {}</figcaption></figure>",
                        line_svg(series, history.nights.size()), escaped(series.problem),
                        escaped(series.method), escaped(series.operators),
                        figure(elementary::exp(series.log_errors.front()), 3),
                        figure(elementary::exp(series.log_errors.back()), 3));
  }
  return page + "</html>\n";
}

}  // namespace tribench
