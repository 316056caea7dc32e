// SPDX-License-Identifier: MIT
#include "reports/motion_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "foundation/json_text.hpp"
#include "reports/csv.hpp"
#include "reports/figures.hpp"
#include "reports/markup.hpp"

namespace tribench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kWidth = 900;  // of a picture, in pixels
constexpr double kHeight = 220;
constexpr double kLeft = 70;
constexpr double kFoot = 34;

Json figures_json(const MotionFigures& figures) {
  return {{"movements", figures.movements},
          {"rows", figures.rows},
          {"mean_position", json_number(figures.mean_position)},
          {"rms_position", json_number(figures.rms_position)},
          {"largest_position", json_number(figures.largest_position)},
          {"mean_velocity", json_number(figures.mean_velocity)},
          {"rms_velocity", json_number(figures.rms_velocity)},
          {"percent_position", json_number(figures.percent_position)}};
}

std::string summary_line(const char* which, const MotionFigures& figures, const std::string& unit) {
  if (figures.movements == 0) return {};
  // Of a joint that did not move there is nothing to be a share of.
  const std::string share = std::isfinite(figures.percent_position)
                                ? fmt::format(" ({} %)", figure(figures.percent_position, 3))
                                : "";
  return fmt::format(
      "{} ({} movement{}): position {} {} on average, {} rms, {} at most{}; velocity {} {}/s\n",
      which, figures.movements, figures.movements == 1 ? "" : "s", figure(figures.mean_position, 4),
      unit, figure(figures.rms_position, 4), figure(figures.largest_position, 4), share,
      figure(figures.mean_velocity, 4), unit);
}

std::string model_lines(const MotionRecord& record) {
  std::string text = fmt::format("friction: {}\n", record.formula);
  text += fmt::format("inertia {}{}{}\n", figure(record.inertia, 6),
                      record.gravity.empty() ? "" : "; gravity ", record.gravity);
  if (std::isfinite(record.motor_constant)) {
    text += fmt::format("motor: constant {}, resistance {}\n", figure(record.motor_constant, 6),
                        figure(record.resistance, 6));
  }
  text += fmt::format("driven by {}", record.drive);
  if (record.horizon_s > 0) {
    text += fmt::format("; set to the measured state every {} s", figure(record.horizon_s, 4));
  }
  return text + "\n";
}

struct Frame {
  double x0, x1, y0, y1;
  double x(double t) const { return kLeft + (kWidth - kLeft - 10) * (t - x0) / (x1 - x0); }
  double y(double q) const { return 10 + (kHeight - kFoot - 10) * (y1 - q) / (y1 - y0); }
};

// Pieces between values that are not finite.
std::string line_of(const Frame& frame, const std::vector<double>& t, const std::vector<double>& q,
                    const char* look) {
  std::string path;
  bool draws = false;
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (!std::isfinite(q[i])) {
      draws = false;
      continue;
    }
    path += fmt::format("{}{:.1f} {:.1f}", draws ? "L" : "M", frame.x(t[i]), frame.y(q[i]));
    draws = true;
  }
  return fmt::format("<path d=\"{}\" fill=\"none\" {}/>", path, look);
}

std::string picture(const MotionMovement& movement, const std::string& unit) {
  const MotionTrace& trace = movement.trace;
  if (trace.time.size() < 2) return {};
  Frame frame{trace.time.front(), trace.time.back(), trace.measured[0], trace.measured[0]};
  for (std::size_t i = 0; i < trace.time.size(); ++i) {
    frame.y0 = std::min(frame.y0, trace.measured[i]);
    frame.y1 = std::max(frame.y1, trace.measured[i]);
  }
  const double room = std::max(0.15 * (frame.y1 - frame.y0), 1e-12);
  frame.y0 -= room;
  frame.y1 += room;
  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 {0} {1}\" role=\"img\"><title>{2}: measured and simulated "
      "position</title><defs><clipPath id=\"c\"><rect x=\"{3}\" y=\"0\" width=\"{0}\" "
      "height=\"{4}\"/></clipPath></defs>",
      kWidth, kHeight, markup_text(movement.name), kLeft, kHeight - kFoot + 8);
  for (int k = 0; k <= 4; ++k) {
    const double q = frame.y0 + (frame.y1 - frame.y0) * k / 4;
    const double t = frame.x0 + (frame.x1 - frame.x0) * k / 4;
    svg += fmt::format(
        "<line x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\" class=\"grid\"/><text "
        "x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5}</text><text x=\"{6:.1f}\" y=\"{7}\" "
        "text-anchor=\"middle\">{8}</text>",
        kLeft, kWidth - 10, frame.y(q), kLeft - 6, frame.y(q) + 4, figure(q, 3), frame.x(t),
        kHeight - 14, figure(t, 3));
  }
  svg += "<g clip-path=\"url(#c)\">";
  svg += line_of(frame, trace.time, trace.measured, "class=\"measured\"");
  svg += line_of(frame, trace.time, trace.simulated, "class=\"simulated\"");
  return svg +
         fmt::format("</g><text x=\"{}\" y=\"{}\">s</text><text x=\"4\" y=\"14\">{}</text></svg>",
                     kWidth - 14, kHeight - 2, markup_text(unit));
}

constexpr const char* kStyle =
    "body{font:15px/1.5 system-ui,sans-serif;max-width:960px;margin:2em auto;padding:0 1em;"
    "color:#1d2129;background:#fff}table{border-collapse:collapse}td,th{padding:2px 12px 2px 0;"
    "text-align:right}td:first-child,th:first-child{text-align:left}svg{width:100%}svg text{font:"
    "11px system-ui,sans-serif;fill:#5d6673}.grid{stroke:#dfe2e6}.measured{stroke:#1d2129;"
    "stroke-width:2.5}.simulated{stroke:#d1495b;stroke-width:1.5}b.simulated{color:#d1495b}"
    "pre{white-space:pre-wrap}figcaption{margin-top:1em}"
    "@media(prefers-color-scheme:dark){body{background:#15181c;color:#e6e8ea}.grid{stroke:#333}"
    ".measured{stroke:#e6e8ea}}";

}  // namespace

std::string motion_terminal(const MotionRecord& record) {
  std::string text = model_lines(record);
  for (const std::string& note : record.notes) text += note + "\n";
  if (record.is_refined) {
    text += fmt::format(
        "{} parameters fitted to the motion of the training movements: rms {} -> {} "
        "{} ({} simulations)\n",
        record.fit.parameters, figure(record.fit.rms_before, 4), figure(record.fit.rms_after, 4),
        record.unit, record.fit.simulations);
  }
  text +=
      fmt::format("\n{:24}{:>8}{:>14}{:>14}{:>14}{:>16}\n", "movement", "rows",
                  "mean |" + record.unit + "|", "rms", "largest", "mean |" + record.unit + "/s|");
  for (const MotionMovement& one : record.movements) {
    text +=
        fmt::format("{:24}{:>8}{:>14}{:>14}{:>14}{:>16}{}\n", one.name, one.figures.rows,
                    figure(one.figures.mean_position, 4), figure(one.figures.rms_position, 4),
                    figure(one.figures.largest_position, 4), figure(one.figures.mean_velocity, 4),
                    !one.broken_off.empty() ? "  " + one.broken_off
                    : one.held_out          ? "  held out"
                                            : "");
  }
  text += "\n" + summary_line("training", record.training, record.unit);
  return text + summary_line("held out", record.held_out, record.unit);
}

std::string write_motion_json(const MotionRecord& record) {
  Json movements = Json::array();
  for (const MotionMovement& one : record.movements) {
    Json json = {{"name", one.name},
                 {"held_out", one.held_out},
                 {"status", one.broken_off.empty() ? "complete" : one.broken_off}};
    json.update(figures_json(one.figures));
    json.erase("movements");
    movements.push_back(std::move(json));
  }
  Json all = {{"title", record.title},
              {"unit", record.unit},
              {"formula", record.formula},
              {"inertia", json_number(record.inertia)},
              {"gravity", record.gravity},
              {"motor_constant", json_number(record.motor_constant)},
              {"resistance", json_number(record.resistance)},
              {"drive", record.drive},
              {"horizon_s", record.horizon_s},
              {"held_out", figures_json(record.held_out)},
              {"training", figures_json(record.training)},
              {"movements", movements},
              {"notes", record.notes}};
  if (record.is_refined) {
    all["fit"] = {{"parameters", record.fit.parameters},
                  {"iterations", record.fit.iterations},
                  {"simulations", record.fit.simulations},
                  {"rms_before", json_number(record.fit.rms_before)},
                  {"rms_after", json_number(record.fit.rms_after)}};
  }
  return write_json(all, 2) + "\n";
}

std::string motion_csv(const MotionRecord& record) {
  std::string text = "movement,time_s,measured,simulated\n";
  for (const MotionMovement& one : record.movements) {
    for (std::size_t i = 0; i < one.trace.time.size(); ++i) {
      append_csv_field(text, one.name);
      text += "," + csv_number(one.trace.time[i]) + "," + csv_number(one.trace.measured[i]) + "," +
              csv_number(one.trace.simulated[i]) + "\n";
    }
  }
  return text;
}

std::string motion_html(const MotionRecord& record) {
  std::string page = fmt::format(
      "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\"><title>Simulated motion: {0}</title><style>{1}</style>"
      "<h1>Simulated motion: {0}</h1><p>{2}{3}</p><pre>{4}</pre>",
      markup_text(record.title), kStyle,
      markup_text(summary_line("Held out", record.held_out, record.unit)),
      markup_text(record.held_out.movements == 0
                      ? summary_line("All movements", record.training, record.unit)
                      : ""),
      markup_text(model_lines(record)));
  page += "<p><b>measured</b> and <b class=\"simulated\">simulated</b> position:</p>";
  for (const MotionMovement& one : record.movements) {
    page += fmt::format("<figure><figcaption>{}{}: {} {} on average{}</figcaption>{}</figure>",
                        markup_text(one.name), one.held_out ? " (held out)" : "",
                        figure(one.figures.mean_position, 4), markup_text(record.unit),
                        one.broken_off.empty() ? "" : ", " + markup_text(one.broken_off),
                        picture(one, record.unit));
  }
  return page + "</html>\n";
}

}  // namespace tribench
