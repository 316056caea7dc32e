// SPDX-License-Identifier: MIT
#include "harness/cli/study_retellings.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/output_folder.hpp"
#include "foundation/shell_word.hpp"
#include "foundation/standard_streams.hpp"
#include "foundation/text.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/cli/study_loop.hpp"
#include "harness/study/retelling_study.hpp"
#include "problems/measured/data_folder.hpp"

namespace tribench {
namespace {

struct RetellingArguments {
  LoopGenerator generator = LoopGenerator::planted;
  int campaigns = 60;
  std::uint64_t seed = 1;
  std::string only;
  std::string list;
  bool measured = false;
  std::string data;
  std::vector<std::string> more;
  RetellingStudyOptions study;
  std::string out;
  bool json = false;
};

std::vector<RecordingToTell> listed_recordings(const RetellingArguments& arguments) {
  RecordingList list;
  if (arguments.measured) {
    const auto folder = measured::find_data_folder(
        arguments.data.empty() ? std::nullopt
                               : std::optional<std::filesystem::path>(arguments.data));
    if (!folder) throw_bad_input("no folder of measured data", "--measured", "give --data DIR");
    list = read_recordings(measured_recordings_toml(), "measured_recordings.toml", *folder);
  } else {
    list = read_recordings(read_file(arguments.list), arguments.list,
                           std::filesystem::path(arguments.list).parent_path());
  }
  for (const std::string& name : list.missing) {
    print_message(fmt::format("{}: its files are not there, left out\n", name));
  }
  std::erase_if(list.recordings,
                [&](const RecordingToTell& one) { return !one.name.starts_with(arguments.only); });
  if (list.recordings.empty()) throw_bad_input("no recording is left");
  return list.recordings;
}

std::vector<RecordingToTell> chosen_recordings(const RetellingArguments& arguments) {
  std::vector<RecordingToTell> recordings =
      arguments.measured || !arguments.list.empty()
          ? listed_recordings(arguments)
          : planted_recordings(arguments.generator, arguments.campaigns, arguments.seed,
                               arguments.only);
  for (RecordingToTell& one : recordings) {
    one.options.insert(one.options.end(), arguments.more.begin(), arguments.more.end());
  }
  return recordings;
}

// What asks again about a changed story; where --out is given its files are written there.
std::string repeating(const RetellingOutcome& one, std::size_t number, const std::string& folder) {
  if (folder.empty()) {
    return fmt::format("--only {} --retellings {}", shell_word(one.recording), one.retelling->name);
  }
  const std::filesystem::path place =
      std::filesystem::path(folder) / fmt::format("{}_{}", number, one.retelling->name);
  std::string command = "tribench";
  for (const std::string& word : write_recording(one.told, place)) {
    command += " " + shell_word(word);
  }
  return command;
}

void print_changes(const RetellingStudy& study, const std::string& folder) {
  std::size_t number = 0;
  for (const RetellingOutcome& one : study.outcomes) {
    if (one.same) continue;
    fmt::print("{}, {}: {} | {}\n    {}\n", one.recording, one.retelling->name, one.first.text(),
               one.again.text(), repeating(one, ++number, folder));
  }
}

void print_table(const std::vector<RetellingFigure>& figures) {
  fmt::print(
      "\n| told | same story | 95 % interval | of | wanted | met | bit for bit | error, again / "
      "first | 95 % interval | farthest - 1 |\n");
  fmt::print("|---|--:|--:|--:|--:|---|--:|--:|--:|--:|\n");
  for (const RetellingFigure& f : figures) {
    fmt::print(
        "| {}: {} | {:.1f} % | {:.1f} .. {:.1f} % | {} | {:.0f} % | {} | {} | {:.4f} | {:.4f} .. "
        "{:.4f} | {:+.1e} |\n",
        f.retelling, f.summary, 100 * f.share, 100 * f.low, 100 * f.high, f.told, 100 * f.target,
        f.met ? "yes" : "NO", f.bits, f.ratio, f.ratio_low, f.ratio_high, f.ratio_largest - 1);
  }
}

nlohmann::ordered_json story_json(const LoopStory& story) {
  const auto number = [](double x) {
    return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json();
  };
  return {{"verdict", story.verdict},
          {"families", story.families},
          {"mae_before", number(story.mae_before)},
          {"mae_after", number(story.mae_after)}};
}

void print_json(const RetellingStudy& study, const std::string& folder) {
  nlohmann::ordered_json figures = nlohmann::ordered_json::array();
  for (const RetellingFigure& f : study.figures) {
    figures.push_back({{"name", f.retelling},
                       {"summary", f.summary},
                       {"told", f.told},
                       {"same", f.same},
                       {"share", f.share},
                       {"low", f.low},
                       {"high", f.high},
                       {"target", f.target},
                       {"met", f.met},
                       {"bit_for_bit", f.bits},
                       {"error_ratio", f.ratio},
                       {"error_ratio_low", f.ratio_low},
                       {"error_ratio_high", f.ratio_high},
                       {"error_ratio_farthest", f.ratio_largest}});
  }
  nlohmann::ordered_json changed = nlohmann::ordered_json::array();
  for (const RetellingOutcome& one : study.outcomes) {
    if (one.same) continue;
    changed.push_back({{"recording", one.recording},
                       {"retelling", one.retelling->name},
                       {"first", story_json(one.first)},
                       {"again", story_json(one.again)},
                       {"repeat", repeating(one, changed.size() + 1, folder)}});
  }
  fmt::print("{}\n",
             write_json(nlohmann::ordered_json{{"figures", figures}, {"changed", changed}}, 2));
}

void run(const RetellingArguments& arguments, ExitStatus& status) {
  if (!arguments.out.empty()) make_output_folder(arguments.out);
  RetellingStudyOptions options = arguments.study;
  options.stop = &stop_requested_by_signal();
  const RetellingStudy study = run_retelling_study(chosen_recordings(arguments),
                                                   make_loop_teller("/proc/self/exe"), options);
  if (arguments.json) {
    print_json(study, arguments.out);
  } else {
    print_changes(study, arguments.out);
    print_table(study.figures);
  }
  if (!std::ranges::all_of(study.figures, &RetellingFigure::met)) status = ExitStatus::found;
  if (study.left_out > 0) {
    print_message(fmt::format("stopped: {} recordings are left out\n", study.left_out));
    status = ExitStatus::failed;
  }
}

}  // namespace

void add_retelling_study(CLI::App& study, ExitStatus& status) {
  CLI::App* command = study.add_subcommand(
      "retellings", "Does the loop say the same of a recording however it is told?");
  command->footer(
      "Example: tribench study retellings --campaigns 60\n"
      "         tribench study retellings --measured --data ../shared/data");
  auto arguments = std::make_shared<RetellingArguments>();
  add_generator_option(*command, arguments->generator);
  command->add_option("--campaigns", arguments->campaigns, "so many planted campaigns")
      ->transform(whole_number(1, 100'000))
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "of the first planted campaign")
      ->transform(whole_number(0))
      ->capture_default_str();
  command->add_option("--only", arguments->only,
                      "recordings whose names begin so: single/stribeck, 'kinova 2'");
  command
      ->add_option("--recordings", arguments->list,
                   "TOML with [[recording]] name, files, options, instead of planted campaigns")
      ->check(CLI::ExistingFile);
  command->add_flag("--measured", arguments->measured, "the measured sets instead");
  command->add_option("--data", arguments->data, "the folder with the measured sets");
  command
      ->add_option("--retellings", arguments->study.retellings,
                   "these ways only: mirrored, epoch, seed, ...")
      ->delimiter(',');
  command->add_option("--more", arguments->more, "further options of the loop, a word each")
      ->allow_extra_args(false)
      ->take_all();
  command->add_option("--jobs", arguments->study.threads, "threads; the figures are the same")
      ->transform(whole_number(0, 1024));
  command->add_option("--out", arguments->out, "folder for the files of the stories that changed");
  command->add_flag("--json", arguments->json, "figures and changed stories");
  command->callback([arguments, &status] {
    arguments->study.quiet = false;
    run(*arguments, status);
  });
}

}  // namespace tribench
