// SPDX-License-Identifier: MIT
#include "harness/study/retelling_study.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "foundation/child_process.hpp"
#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "foundation/scratch_folder.hpp"
#include "harness/study/each_case.hpp"
#include "reports/statistics/intervals.hpp"

namespace tribench {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kCannotTell = 4;  // the loop's exit status for data that cannot tell; still an answer

double number_in(const nlohmann::json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : kNaN;
}

LoopStory story_in(const std::string& text) {
  const nlohmann::json json = nlohmann::json::parse(text);
  LoopStory story;
  story.verdict = json.at("verdict");
  for (const nlohmann::json& effect : json.at("effects")) {
    story.families.push_back(effect.at("family"));
  }
  std::ranges::sort(story.families);
  story.mae_before = number_in(json.at("error"), "mae_before");
  story.mae_after = number_in(json.at("error"), "mae_after");
  return story;
}

LoopStory failed(std::string_view complaint) {
  const std::size_t end = complaint.find_last_not_of('\n');
  return {"FAILED", {}, kNaN, kNaN, std::string(complaint.substr(0, end + 1))};
}

bool same_number(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

// The first tellings of a recording: as it stands, and under --unordered where that is asked for.
class FirstTellings {
 public:
  FirstTellings(const RecordingToTell& recording, const StoryTeller& teller)
      : recording_(recording), teller_(teller) {}
  const LoopStory& plain() { return told(plain_, recording_); }
  const LoopStory& unordered() { return told(unordered_, tribench::unordered(recording_)); }

 private:
  const LoopStory& told(std::optional<LoopStory>& story, const RecordingToTell& recording) {
    if (story) return *story;
    story = teller_(recording);
    if (story->verdict == "FAILED") {
      throw_bad_input(story->complaint, recording.name, "give a recording the loop accepts");
    }
    return *story;
  }

  const RecordingToTell& recording_;
  const StoryTeller& teller_;
  std::optional<LoopStory> plain_;
  std::optional<LoopStory> unordered_;
};

std::vector<RetellingOutcome> retell(const RecordingToTell& recording,
                                     const std::vector<const Retelling*>& ways,
                                     const StoryTeller& teller,
                                     const std::function<bool()>& stopped) {
  FirstTellings first(recording, teller);
  std::vector<RetellingOutcome> outcomes;
  for (const Retelling* way : ways) {
    if (stopped()) return {};
    std::optional<RecordingToTell> told =
        way->tell(recording, RandomStream(key_of(recording.name)).split(way->name));
    if (!told) continue;
    RetellingOutcome out{recording.name, way, way->unordered ? first.unordered() : first.plain(),
                         teller(*told),  {},  0};
    out.again.mae_before *= told->torque_unit;
    out.again.mae_after *= told->torque_unit;
    out.error_ratio = out.again.mae_after / out.first.mae_after;
    out.same = out.first.same_as(out.again);
    out.same_bits = out.same && same_number(out.first.mae_before, out.again.mae_before) &&
                    same_number(out.first.mae_after, out.again.mae_after);
    if (!out.same) out.told = std::move(*told);
    outcomes.push_back(std::move(out));
  }
  return outcomes;
}

RetellingFigure figure_of(const Retelling& way, const std::vector<RetellingOutcome>& outcomes) {
  RetellingFigure figure;
  figure.retelling = way.name;
  figure.summary = way.summary;
  figure.target = way.wanted;
  std::vector<double> logs;
  for (const RetellingOutcome& one : outcomes) {
    if (one.retelling != &way) continue;
    ++figure.told;
    figure.same += one.same ? 1 : 0;
    figure.bits += one.same_bits ? 1 : 0;
    if (std::isfinite(one.error_ratio) && one.error_ratio > 0) {
      logs.push_back(elementary::log(one.error_ratio));
    }
  }
  if (figure.told == 0) return figure;
  figure.share = static_cast<double>(figure.same) / static_cast<double>(figure.told);
  const ConfidenceInterval share = wilson(figure.same, figure.told, kConfidence);
  figure.low = share.low;
  figure.high = share.high;
  figure.met = figure.share >= way.wanted && (way.error_within > 0 || figure.bits == figure.told);
  if (logs.empty()) return figure;
  const auto mean = [](std::span<const double> values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
  };
  const ConfidenceInterval ratio =
      bootstrap(logs, mean, kConfidence, 999, RandomStream(key_of("retellings")).split(way.name));
  figure.ratio = elementary::exp(mean(logs));
  figure.ratio_low = elementary::exp(ratio.low);
  figure.ratio_high = elementary::exp(ratio.high);
  figure.ratio_largest = elementary::exp(
      *std::ranges::max_element(logs, {}, [](double log_ratio) { return std::abs(log_ratio); }));
  const bool is_near = std::abs(figure.ratio_largest - 1) <= way.error_within;
  figure.met = figure.met && (way.error_within == 0 || is_near);
  return figure;
}

}  // namespace

std::string LoopStory::text() const {
  if (verdict == "FAILED") return fmt::format("FAILED ({})", complaint);
  return fmt::format("{}{}{}, {:.4g} -> {:.4g}", verdict, families.empty() ? "" : " ",
                     fmt::join(families, " + "), mae_before, mae_after);
}

StoryTeller make_loop_teller(std::string program) {
  return [program = std::move(program)](const RecordingToTell& recording) {
    const ScratchFolder scratch;
    ChildOptions options;
    options.command = {program};
    for (std::string& word : write_recording(recording, scratch.path())) {
      options.command.push_back(std::move(word));
    }
    options.command.emplace_back("--json");
    options.environment = {"OMP_NUM_THREADS=1"};  // the cases share the cores
    const ChildRun run = run_child(options);
    if (run.exit.signal != 0) return failed(signal_name(run.exit.signal));
    if (run.exit.status != 0 && run.exit.status != kCannotTell) return failed(run.errors);
    return story_in(run.output);
  };
}

RetellingStudy run_retelling_study(const std::vector<RecordingToTell>& recordings,
                                   const StoryTeller& teller,
                                   const RetellingStudyOptions& options) {
  std::vector<const Retelling*> ways;
  for (const std::string& name : options.retellings) ways.push_back(&find_retelling(name));
  if (ways.empty()) {
    for (const Retelling& way : retellings()) ways.push_back(&way);
  }
  std::vector<std::vector<RetellingOutcome>> by_recording(recordings.size());
  const auto stopped = [&] { return options.stop != nullptr && *options.stop; };
  std::atomic<std::size_t> told = 0;
  for_each_case(recordings.size(), options.threads, options.quiet, [&](std::size_t i) {
    std::vector<RetellingOutcome> outcomes = retell(recordings[i], ways, teller, stopped);
    if (stopped()) return;
    by_recording[i] = std::move(outcomes);
    ++told;
  });
  RetellingStudy study;
  study.left_out = recordings.size() - told;
  for (std::vector<RetellingOutcome>& outcomes : by_recording) {
    std::ranges::move(outcomes, std::back_inserter(study.outcomes));
  }
  for (const Retelling* way : ways) {
    RetellingFigure figure = figure_of(*way, study.outcomes);
    if (figure.told > 0) study.figures.push_back(std::move(figure));
  }
  return study;
}

}  // namespace tribench
