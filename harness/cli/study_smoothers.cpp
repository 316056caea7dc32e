// SPDX-License-Identifier: MIT
#include "harness/cli/study_smoothers.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "foundation/json_text.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/study/smoother_study.hpp"

namespace tribench {
namespace {

std::string text_of(const DerivativeErrors& errors) {
  return fmt::format("{:.2g} / {:.2g}", errors.velocity, errors.acceleration);
}

void print_table(const std::vector<SmootherFigure>& figures) {
  fmt::print(
      "Errors of velocity (rad/s) and acceleration (rad/s^2) while the joint moves; widths that "
      "are best know the truth.\n\n"
      "| encoder, sampling | Kalman smoother | Savitzky-Golay, best width | spline, best width | "
      "spline, cross-validated |\n|---|---|---|---|---|\n");
  for (const SmootherFigure& f : figures) {
    fmt::print("| 2^{}, {:g} Hz | {} | {} | {} | {} |\n", f.bits, f.rate_hz, text_of(f.kalman),
               text_of(f.savitzky_golay), text_of(f.spline), text_of(f.validated_spline));
  }
}

nlohmann::ordered_json json_of(const DerivativeErrors& errors) {
  return {{"velocity", errors.velocity}, {"acceleration", errors.acceleration}};
}

void print_json(const std::vector<SmootherFigure>& figures) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (const SmootherFigure& f : figures) {
    array.push_back(
        {{"name", fmt::format("2^{}", f.bits)},
         {"summary", fmt::format("encoder of 2^{} counts at {:g} Hz", f.bits, f.rate_hz)},
         {"bits", f.bits},
         {"rate_hz", f.rate_hz},
         {"kalman", json_of(f.kalman)},
         {"savitzky_golay", json_of(f.savitzky_golay)},
         {"spline", json_of(f.spline)},
         {"validated_spline", json_of(f.validated_spline)}});
  }
  fmt::print("{}\n", write_json(array, 2));
}

}  // namespace

void add_smoother_study(CLI::App& study) {
  CLI::App* command = study.add_subcommand(
      "smoothers", "How well are velocity and acceleration derived from an encoder's position?");
  command->footer("Example: tribench study smoothers --runs 2");
  auto options = std::make_shared<SmootherStudyOptions>();
  auto json = std::make_shared<bool>(false);
  command->add_option("--runs", options->runs, "joints a figure")
      ->transform(whole_number(1, 1000))
      ->capture_default_str();
  command->add_option("--seconds", options->seconds, "of a run")
      ->transform(real_number(5, 1000))
      ->capture_default_str();
  command->add_option("--seed", options->first_seed, "of the first run")
      ->transform(whole_number(0))
      ->capture_default_str();
  command->add_flag("--json", *json, "an array of figures");
  command->callback([options, json] {
    const std::vector<SmootherFigure> figures = run_smoother_study(*options);
    if (*json) {
      print_json(figures);
    } else {
      print_table(figures);
    }
  });
}

}  // namespace tribench
