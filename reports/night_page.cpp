// SPDX-License-Identifier: MIT
#include "reports/night_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "foundation/elementary.hpp"
#include "foundation/order_statistics.hpp"
#include "reports/figures.hpp"
#include "reports/markup.hpp"

namespace tribench {
namespace {

constexpr std::size_t kPoints = 300;  // of a line
constexpr double kWidth = 320;
constexpr double kHeight = 90;
constexpr double kMargin = 6;

// Lines of one picture over the store's nights, between two values.
class Picture {
 public:
  Picture(std::size_t nights, double low, double high)
      : last_(std::max(1.0, static_cast<double>(nights - 1))), low_(low), high_(high) {
    text_ = fmt::format("<svg viewBox=\"0 0 {} {}\" width=\"{}\" height=\"{}\">", kWidth, kHeight,
                        kWidth, kHeight);
  }

  // Where a level changed.
  void mark(std::size_t night, bool worse) {
    const double x = x_of(static_cast<double>(night));
    text_ += fmt::format("<line class=\"{}\" x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"0\" y2=\"{}\"/>",
                         worse ? "worse" : "better", x, x, kHeight);
  }

  // Medians of equal parts where there are more values than are drawn; NaN values are left out.
  void line(const char* kind, std::span<const std::size_t> nights, std::span<const double> values) {
    const std::size_t n = values.size();
    const std::size_t parts = std::min(n, kPoints);
    std::vector<std::pair<std::string, std::string>> points;
    for (std::size_t k = 0; k < parts; ++k) {
      const std::size_t begin = k * n / parts;
      const std::size_t end = (k + 1) * n / parts;
      const double value = median(values.subspan(begin, end - begin));
      if (std::isnan(value)) continue;
      std::string x = fmt::format("{:.1f}", x_of(static_cast<double>(nights[begin])));
      std::string y = fmt::format("{:.1f}", y_of(value));
      // Within a level stretch only its ends are needed.
      const std::size_t m = points.size();
      if (m >= 2 && points[m - 1].second == y && points[m - 2].second == y) points.pop_back();
      points.emplace_back(std::move(x), std::move(y));
    }
    text_ += fmt::format("<polyline class=\"{}\" points=\"", kind);
    for (const auto& [x, y] : points) text_ += fmt::format("{},{} ", x, y);
    text_ += "\"/>";
  }

  std::string text() const { return text_ + "</svg>"; }

 private:
  double x_of(double night) const { return kMargin + (kWidth - 2 * kMargin) * night / last_; }
  double y_of(double value) const {
    return kHeight - kMargin -
           (kHeight - 2 * kMargin) * (value - low_) / std::max(1e-9, high_ - low_);
  }

  double last_;
  double low_;
  double high_;
  std::string text_;
};

std::string figure_of(const SeriesHistory& series, std::size_t nights) {
  const auto [least, most] =
      std::ranges::minmax(series.log_errors);  // never empty: a series has a night
  Picture picture(nights, std::min(least, most - 0.02), most);
  for (const LevelChange& change : series.changes) {
    picture.mark(series.nights[change.at], change.after > change.before);
  }
  picture.line("error", series.nights, series.log_errors);
  const auto error = [](double log_error) { return figure(elementary::exp(log_error), 3); };
  return fmt::format(
      "<figure>{}<figcaption>{} <b>{}</b> {}: {} &rarr; {} (within {} .. {})</figcaption></figure>",
      picture.text(), markup_text(series.problem), markup_text(series.method),
      markup_text(series.operators), error(series.log_errors.front()),
      error(series.log_errors.back()), error(least), error(most));
}

// Relative to its own median.
std::vector<double> about_its_median(const std::vector<double>& values) {
  const double middle = median(values);
  std::vector<double> result = values;
  for (double& value : result) value -= middle;
  return result;
}

std::string figure_of(const BenchHistory& bench, std::size_t nights) {
  const std::vector<double> instructions = about_its_median(bench.instructions);
  const std::vector<double> misses = about_its_median(bench.misses);
  const std::vector<double> time = about_its_median(bench.time);
  double reach = 0.02;
  for (const auto* values : {&instructions, &misses, &time}) {
    for (const double value : *values) {
      if (std::isfinite(value)) reach = std::max(reach, std::abs(value));
    }
  }
  Picture picture(nights, -reach, reach);
  for (const LevelChange& change : bench.changes) {
    picture.mark(bench.nights[change.at], change.after > change.before);
  }
  picture.line("time", bench.nights, time);
  picture.line("misses", bench.nights, misses);
  picture.line("error", bench.nights, instructions);
  return fmt::format("<figure>{}<figcaption>{}: {} instructions</figcaption></figure>",
                     picture.text(), markup_text(bench.name),
                     figure(elementary::exp(bench.instructions.back()), 4));
}

std::string changes_table(const StoreHistory& history) {
  const std::vector<HistoryChange> changes = changes_of(history);
  if (changes.empty()) return "<p>None.</p>";
  std::string text =
      "<table><tr><th>first night</th><th>figure</th><th>problem</th><th>method</th>"
      "<th>operators</th><th>now / before</th><th>commit</th><th>machine</th></tr>";
  for (const HistoryChange& each : changes) {
    const Night& night = history.nights[each.night];
    text += "<tr>";
    for (const std::string& cell :
         {night.name, each.figure, each.problem, each.method, each.operators}) {
      text += fmt::format("<td>{}</td>", markup_text(cell));
    }
    text += fmt::format("<td class=\"{}\">{}</td><td>{}</td><td>{}</td></tr>",
                        each.ratio > 1 ? "worse" : "better", figure(each.ratio, 4),
                        markup_text(night.commit), markup_text(night.machine));
  }
  return text + "</table>";
}

constexpr const char* kStyle =
    "body{font:15px/1.5 sans-serif;margin:2em auto;max-width:1060px;padding:0 1em;color:#222}"
    "figure{display:inline-block;margin:4px 8px;vertical-align:top;width:320px}"
    "figcaption{font-size:13px;overflow-wrap:anywhere}svg{background:#f7f7f7}"
    "polyline{fill:none;stroke:#0072b2;stroke-width:1.3}"
    "polyline.time{stroke:#bbb;stroke-width:1}polyline.misses{stroke:#cc79a7;stroke-width:1}"
    "line.worse{stroke:#d55e00;stroke-width:1.5}line.better{stroke:#009e73;stroke-width:1.5}"
    "td:first-child{white-space:nowrap}td.worse{color:#a84a00}td.better{color:#00694d}"
    "td,th{padding:2px 10px;text-align:left;border-bottom:1px solid #ddd}table{border-collapse:"
    "collapse;display:block;overflow-x:auto}";

}  // namespace

std::string history_page(const StoreHistory& history) {
  const std::size_t nights = history.nights.size();
  std::string page = fmt::format(
      "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>tribench: nights</title>"
      "<link rel=\"alternate\" type=\"application/atom+xml\" href=\"nights.atom\">"
      "<meta name=\"viewport\" "
      "content=\"width=device-width\"><style>{}</style><body><h1>Nights</h1>"
      "<p>{} nights, {} lines, {} benches; oldest left. A vertical line is a change of level: "
      "worse "
      "in orange, better in green.</p>",
      kStyle, nights, history.series.size(), history.benches.size());
  for (const Blessing& each : history.blessings) {
    page += fmt::format("<p>{}: base {}: {}</p>", markup_text(each.when), markup_text(each.night),
                        markup_text(each.reason));
  }
  for (const std::string& damage : history.damaged) {
    page += fmt::format("<p>damaged: {}</p>", markup_text(damage));
  }
  page += "<h2>Changes</h2>" + changes_table(history);
  page += "<h2>Errors</h2><p>The median error on test movements, logarithmic.</p>";
  for (const SeriesHistory& series : history.series) page += figure_of(series, nights);
  if (!history.benches.empty()) {
    page +=
        "<h2>Benches</h2><p>A turn of each loop against its median over the nights: instructions "
        "(blue), misses of the last cache (purple), time in times of the reference kernel "
        "(grey).</p>";
  }
  for (const BenchHistory& bench : history.benches) page += figure_of(bench, nights);
  return page + "</body></html>\n";
}

}  // namespace tribench
