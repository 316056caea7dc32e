// SPDX-License-Identifier: MIT
#include "harness/cli/study_logs.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "foundation/json_text.hpp"
#include "foundation/output_file.hpp"
#include "foundation/output_folder.hpp"
#include "foundation/shell_word.hpp"
#include "foundation/standard_streams.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/study/log_study.hpp"

namespace tribench {
namespace {

struct LogStudyArguments {
  LogStudyOptions study;
  std::string out;
  bool json = false;
};

// Writes the log; the command that asks again.
std::string keep_log(const LogOutcome& one, const std::filesystem::path& folder) {
  std::string name = one.name;
  std::ranges::replace(name, '/', '_');
  const std::filesystem::path file =
      folder / fmt::format("{}_{}.csv", name, log_told_name(one.told));
  write_file(file, one.text);
  std::string command = "tribench loop " + shell_word(file.string());
  for (const std::string& word : one.options) command += " " + shell_word(word);
  return command;
}

void print_outcomes(const LogStudy& study, const std::string& folder) {
  for (const LogOutcome& one : study.outcomes) {
    if (one.text.empty()) continue;  // all three stories of the run are right
    fmt::print("{} {}: {} ({}){}{}\n", one.name, log_told_name(one.told), one.story.text(),
               says_name(one.says), one.misread.empty() ? "" : "; " + one.misread,
               one.summary.empty() ? "" : fmt::format("\n    {}", one.summary));
    if (!folder.empty()) fmt::print("    {}\n", keep_log(one, folder));
  }
}

void print_figures(const std::vector<LogFigure>& figures) {
  fmt::print(
      "\n| told | logs | read | right | found first | as the clean table | misread | confidently "
      "wrong | false alarms |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|\n");
  for (const LogFigure& f : figures) {
    fmt::print("| {} | {} | {} | {} | {} of {} | {} | {} | {} | {} of {} |\n",
               log_told_name(f.told), f.logs, f.read, f.right, f.first, f.logs - f.nulls, f.same,
               f.misread, f.wrong, f.false_alarms, f.nulls);
  }
}

void print_json(const LogStudy& study, const std::string& folder) {
  nlohmann::ordered_json figures = nlohmann::ordered_json::array();
  for (const LogFigure& f : study.figures) {
    figures.push_back({{"name", log_told_name(f.told)},
                       {"summary", fmt::format("raw logs, told: {}", log_told_name(f.told))},
                       {"logs", f.logs},
                       {"read", f.read},
                       {"right", f.right},
                       {"found_first", f.first},
                       {"same", f.same},
                       {"misread", f.misread},
                       {"confidently_wrong", f.wrong},
                       {"nulls", f.nulls},
                       {"false_alarms", f.false_alarms}});
  }
  nlohmann::ordered_json logs = nlohmann::ordered_json::array();
  for (const LogOutcome& one : study.outcomes) {
    logs.push_back({{"log", one.name},
                    {"told", log_told_name(one.told)},
                    {"how", one.summary},
                    {"story", one.story.text()},
                    {"says", says_name(one.says)},
                    {"misread", one.misread}});
    if (!folder.empty() && !one.text.empty()) logs.back()["repeat"] = keep_log(one, folder);
  }
  fmt::print("{}\n", write_json(nlohmann::ordered_json{{"figures", figures}, {"logs", logs}}, 2));
}

void run(const LogStudyArguments& arguments, ExitStatus& status) {
  if (!arguments.out.empty()) make_output_folder(arguments.out);
  LogStudyOptions options = arguments.study;
  options.stop = &stop_requested_by_signal();
  const LogStudy study = run_log_study("/proc/self/exe", options);
  if (arguments.json) {
    print_json(study, arguments.out);
  } else {
    print_outcomes(study, arguments.out);
    print_figures(study.figures);
  }
  const bool fine = std::ranges::all_of(
      study.figures, [](const LogFigure& f) { return f.misread == 0 && f.wrong == 0; });
  if (!fine) status = ExitStatus::found;
  if (study.left_out > 0) {
    print_message(fmt::format("stopped: {} logs are left out\n", study.left_out));
    status = ExitStatus::failed;
  }
}

}  // namespace

void add_log_study(CLI::App& study, ExitStatus& status) {
  CLI::App* command =
      study.add_subcommand("logs", "Is the same found in raw logs as in clean tables?");
  command->footer("Example: tribench study logs --logs 100 --out wrong-logs");
  auto arguments = std::make_shared<LogStudyArguments>();
  command->add_option("--logs", arguments->study.logs, "so many runs, each told three times")
      ->transform(whole_number(1, 100'000))
      ->capture_default_str();
  command->add_option("--seed", arguments->study.first_seed, "of the first run")
      ->transform(whole_number(0))
      ->capture_default_str();
  command->add_option("--only", arguments->study.only, "runs whose names begin so: load, none/10");
  command
      ->add_option("--scale", arguments->study.scale,
                   "of what is planted, in standard deviations of the noise")
      ->transform(real_number(0.01, 100))
      ->capture_default_str();
  command->add_option("--seconds", arguments->study.seconds, "of a log")
      ->transform(real_number(10, 10'000))
      ->capture_default_str();
  command
      ->add_option("--encoder", arguments->study.encoder_bits,
                   "raw logs hold the position alone, from 2^N counts a turn")
      ->transform(whole_number(8, 30));
  command->add_option("--jobs", arguments->study.threads, "threads; the figures are the same")
      ->transform(whole_number(0, 1024));
  command->add_flag("--clean-only{false}", arguments->study.raw,
                    "ask about the clean tables alone");
  command->add_option("--out", arguments->out,
                      "folder for the files of the stories that are wrong");
  command->add_flag("--json", arguments->json, "figures and stories");
  command->callback([arguments, &status] {
    arguments->study.quiet = arguments->json;
    run(*arguments, status);
  });
}

}  // namespace tribench
