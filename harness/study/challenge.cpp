// SPDX-License-Identifier: MIT
#include "harness/study/challenge.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>

#include "algorithms/effects/effect_library.hpp"
#include "foundation/child_process.hpp"
#include "foundation/error.hpp"
#include "foundation/formula_name.hpp"
#include "foundation/json_text.hpp"
#include "foundation/output_file.hpp"
#include "foundation/output_folder.hpp"
#include "foundation/plain_name.hpp"
#include "foundation/scratch_folder.hpp"
#include "foundation/suggestion.hpp"
#include "foundation/text.hpp"
#include "harness/exploration/world_folder.hpp"
#include "harness/progress_line.hpp"
#include "problems/file_hash.hpp"

namespace tribench {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr int kChallengeProtocol = 1;
constexpr std::size_t kLongestLine = 1U << 20;
constexpr std::size_t kShownOfLine = 100;  // bytes
constexpr std::size_t kMostRequests = 5000;
constexpr const char* kVerdictLine =
    "print {\"verdict\": ...} on a line at the end, null where there is none (docs/challenge.md)";

// Thrown where an end was asked for while the program was waited for.
struct BrokenOff {};

// A program that answers lines with lines.
class Talk {
 public:
  Talk(const std::vector<std::string>& command, double wall_s, const std::atomic<bool>* end)
      : child_(ChildOptions{command, {"TMPDIR=" + scratch_.path().string()}, {}, scratch_.path()}),
        end_(Clock::now() +
             std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(wall_s))),
        asked_to_end_(end) {}

  // What ended is heard out: it may have said its verdict, and how it ended is worth more than that
  // it no longer reads.
  void say(const Json& message) {
    const std::string line = write_json(message) + "\n";
    for (std::string_view left = line; !left.empty();) {
      if (child_.write_some(left, seconds_to_wait())) continue;
      if (child_.ends_within(1)) return;
      throw Error(ErrorKind::failed, "the program no longer reads", {}, kVerdictLine);
    }
  }

  // The next line that is a JSON object; others are chatter.
  Json hear() {
    while (true) {
      while (text_.find('\n') != std::string::npos) {
        const std::size_t end = text_.find('\n');
        const std::string line = text_.substr(0, end);
        text_.erase(0, end + 1);
        Json said = said_in(line);
        if (said.is_object()) return said;
        if (!trimmed(line).empty()) last_line_ = line;
      }
      if (text_.size() > kLongestLine) {
        throw Error(ErrorKind::failed, "the program prints a line without end");
      }
      const ChildOutput heard = child_.read(seconds_to_wait());
      text_ += heard.output;
      errors_ = (errors_ + heard.errors);
      if (errors_.size() > 400) errors_.erase(0, errors_.size() - 400);
      if (heard.ended && text_.find('\n') == std::string::npos) {
        if (text_.empty()) refuse_silence();
        text_ += '\n';  // the last line needs no end of its own
      }
    }
  }

 private:
  // Before the end is looked for again.
  double seconds_to_wait() const {
    if (asked_to_end_ != nullptr && *asked_to_end_) throw BrokenOff();
    const double left_s = std::chrono::duration<double>(end_ - Clock::now()).count();
    if (left_s > 0) return std::min(left_s, 1.0);
    throw Error(ErrorKind::failed, "the program took too long", {}, "--wall-seconds gives it more");
  }

  [[noreturn]] void refuse_silence() {
    const std::string printed = last_line_.empty() ? "it printed no line"
                                                   : fmt::format("the last line it printed is '{}'",
                                                                 clipped(last_line_, kShownOfLine));
    const std::string how = child_.ends_within(1)
                                ? fmt::format("ended with {}", told_of_end(child_.wait(), errors_))
                                : "closed its output and still runs";
    throw Error(ErrorKind::failed,
                fmt::format("the program gave no verdict: {}, and {}", printed, how), {},
                kVerdictLine);
  }

  // What was meant as an object would be waited for in vain by both sides.
  static Json said_in(const std::string& line) {
    std::string reason;
    Json said = read_json<Json>(line, &reason);
    if (said.is_discarded() && find_json_object(line, 0) == 0) {
      throw Error(ErrorKind::failed, fmt::format("{}: '{}'", reason, clipped(line, kShownOfLine)),
                  "the program's line", "print an object on one line, every number finite");
    }
    return said;
  }

  ScratchFolder scratch_;  // the program's own folder for temporary files
  ChildProcess child_;
  Clock::time_point end_;
  const std::atomic<bool>* asked_to_end_;
  std::string text_;
  std::string errors_;
  std::string last_line_;  // of chatter
};

// Whatever stands in it is one cell.
std::string quoted_cell(const std::string& text) {
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
  return cell + "\"";
}

// The same reader as for files: a line under the columns' names.
PlannedMovement movement_in(const Json& wanted) {
  constexpr const char* kMend =
      R"(write {"kind": "constant", "velocity_rad_s": 0.3, "from_rad": -1, "to_rad": 1})";
  if (!wanted.is_object() || wanted.empty()) {
    throw_bad_input(fmt::format("{} is no movement", clipped(write_json(wanted), kShownOfLine)),
                    "movement", kMend);
  }
  std::string names;
  std::string values;
  for (const auto& [name, value] : wanted.items()) {
    if (!is_identifier(name)) {
      throw_bad_input(fmt::format("there is no column '{}'", clipped(name)), "movement", kMend);
    }
    if (!value.is_number() && !value.is_string()) {
      throw_bad_input(fmt::format("'{}' is {}, which is no number and no word", clipped(name),
                                  clipped(write_json(value))),
                      "movement", kMend);
    }
    names += (names.empty() ? "" : ",") + name;
    values += (values.empty() ? "" : ",") +
              (value.is_string() ? quoted_cell(value.get<std::string>()) : write_json(value));
  }
  try {
    return read_movements(names + "\n" + values + "\n", "movement").front();
  } catch (const Error& error) {  // there is no line that it could be in
    throw Error(error.kind(), error.text(), "movement", error.mend());
  }
}

Json rows_of(const Dataset& data) {
  Json out;
  for (const Channel& channel : data.channels) out[channel.name] = channel.values;
  return out;
}

void take_verdict(const Json& verdict, const simulation::World& world, ChallengeResult& result) {
  // A slip of the pen is no wrong verdict.
  constexpr const char* kMend = R"(write {"families": [], "unknown": false}, or null to abstain)";
  if (!verdict.is_object()) throw_bad_input("it is no object", "verdict", kMend);
  for (const auto& [key, value] : verdict.items()) {
    if (key == "families" || key == "unknown") continue;
    throw_bad_input(fmt::format("a verdict has no '{}'", clipped(key)), "verdict",
                    did_you_mean(key, {"families", "unknown"}));
  }
  const Json named = verdict.value("families", Json());
  const bool is_list = named.is_array() && std::ranges::all_of(named, [](const Json& family) {
                         return family.is_string();
                       });
  if (!is_list) throw_bad_input("a verdict lists its families by name", "verdict", kMend);
  if (!verdict.value("unknown", Json(false)).is_boolean()) {
    throw_bad_input("'unknown' is true or false", "verdict", kMend);
  }
  const auto families = verdict.value("families", std::vector<std::string>());
  const std::vector<std::string> known = loop::builtin_effect_names();
  for (const std::string& family : families) {
    if (std::ranges::count(known, family) > 0) continue;
    throw_bad_input(fmt::format("there is no family '{}'", clipped(family)), "verdict",
                    did_you_mean(family, known));
  }
  const bool unknown = verdict.value("unknown", false);
  std::vector<std::string> words = families;
  if (unknown) words.emplace_back("UNKNOWN");
  result.verdict = words.empty() ? "NONE" : fmt::format("{}", fmt::join(words, "+"));
  result.right = is_right(judge_verdict(families, unknown, world.truth()));
  result.wrong = !result.right;
}

void converse(Talk& talk, simulation::World& world, ChallengeResult& result) {
  talk.say({{"protocol", kChallengeProtocol},
            {"seal", result.seal},
            {"families", loop::builtin_effect_names()},
            {"smallest_effect", world.smallest_effect()},
            {"limits", Json::parse(limits_json(world.limits()))}});
  for (std::size_t k = 0; k < kMostRequests; ++k) {
    const Json heard = talk.hear();
    if (!heard.is_object() || heard.contains("verdict") == heard.contains("movement")) {
      throw_bad_input("it has to be a 'movement' or a 'verdict'",
                      clipped(write_json(heard), kShownOfLine), "one of the two on a line");
    }
    if (heard.contains("verdict")) {
      if (heard.at("verdict").is_null()) {
        result.verdict = "abstained";
      } else {
        take_verdict(heard.at("verdict"), world, result);
      }
      return;
    }
    try {
      const Dataset data = world.execute(movement_in(heard.at("movement")), "movement");
      result.movements += 1;
      talk.say({{"rows", rows_of(data)},
                {"seconds_left", world.limits().seconds - world.seconds_used()}});
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::bad_input) throw;
      result.refused += 1;
      talk.say({{"refused", error.what()},
                {"seconds_left", world.limits().seconds - world.seconds_used()}});
    }
  }
  throw Error(ErrorKind::failed, "the program asks without end");
}

Json score_json(const ChallengeScore& score) {
  Json worlds = Json::array();
  for (const ChallengeResult& one : score.results) {
    worlds.push_back({{"seal", one.seal},
                      {"verdict", one.verdict},
                      {"right", one.right},
                      {"wrong", one.wrong},
                      {"seconds", one.seconds},
                      {"movements", one.movements},
                      {"refused", one.refused},
                      {"reason", one.reason}});
  }
  return {{"name", score.name},
          {"right", score.right()},
          {"wrong", score.wrong()},
          {"worlds", score.results.size()},
          {"median_seconds", score.median_seconds()},
          {"results", worlds}};
}

// Any other JSON may lie in the folder too.
bool is_score(const Json& json) {
  if (!json.is_object() || !json.contains("name") || !json["name"].is_string()) return false;
  const auto is_count = [&](const char* key) {
    return json.contains(key) && json[key].is_number_unsigned();
  };
  return is_count("worlds") && is_count("right") && is_count("wrong") &&
         json.contains("median_seconds") && json["median_seconds"].is_number() &&
         json.contains("results") && json["results"].is_array();
}

std::size_t count_scored(const Json& seals, const Json& score) {
  return static_cast<std::size_t>(std::ranges::count_if(seals, [&](const Json& seal) {
    return std::ranges::any_of(score["results"], [&](const Json& one) {
      return one.is_object() && one.value("seal", Json()) == seal;
    });
  }));
}

// Scores in a folder, by what they were scored on.
struct Scores {
  std::vector<Json> ranked;             // all worlds with these seals and no others
  std::vector<std::string> incomplete;  // some of them; with how many
  std::vector<std::string> others;
};

Scores scores_in(const std::filesystem::path& folder, const Json& seals) {
  Scores scores;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".json" || entry.path().stem() == "seals") continue;
    const Json score = read_json<Json>(read_file_if_there(entry.path()).value_or(""));
    if (!is_score(score)) continue;
    const std::size_t scored = count_scored(seals, score);
    const auto name = score.value("name", std::string());
    if (scored < score["results"].size()) {
      scores.others.push_back(name);
    } else if (scored < seals.size()) {
      scores.incomplete.push_back(fmt::format("{} ({} of {})", name, scored, seals.size()));
    } else {
      scores.ranked.push_back(score);
    }
  }
  std::ranges::sort(scores.incomplete);
  std::ranges::sort(scores.others);
  return scores;
}

// Most right first, then fewest wrong, then fewest seconds.
std::string leaderboard_of(const std::filesystem::path& folder, const Json& seals) {
  auto [scores, incomplete, others] = scores_in(folder, seals);
  const auto key = [](const Json& one) {
    return std::tuple(-one.value("right", 0.0), one.value("wrong", 0.0),
                      one.value("median_seconds", 0.0), one.value("name", std::string()));
  };
  std::ranges::sort(scores, [&](const Json& a, const Json& b) { return key(a) < key(b); });
  std::string text =
      "# Name what is missing\n\n| | entry | worlds | right | wrong | silent | median s |\n"
      "|--:|---|--:|--:|--:|--:|--:|\n";
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const Json& one = scores[i];
    const auto worlds = one.value("worlds", std::size_t{0});
    const auto right = one.value("right", std::size_t{0});
    const auto wrong = one.value("wrong", std::size_t{0});
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {:.0f} |\n", i + 1,
                        one.value("name", std::string()), worlds, right, wrong,
                        worlds - right - wrong, one.value("median_seconds", 0.0));
  }
  text += "\nA verdict that is not right counts as all of a world's seconds.\n";
  if (!incomplete.empty()) {
    text += fmt::format("Not ranked, since incomplete, with how many worlds: {}.\n",
                        fmt::join(incomplete, ", "));
  }
  if (!others.empty()) {
    text += fmt::format("Not ranked, since scored on other worlds than those of seals.json: {}.\n",
                        fmt::join(others, ", "));
  }
  return text;
}

// Once published they stay: the scores beside them are of their worlds.
void publish_seals(const std::filesystem::path& file, const Json& seals) {
  const std::string text = write_json(Json{{"truth_sha256", seals}}, 1) + "\n";
  const std::optional<std::string> published = read_file_if_there(file);
  if (!published) {
    write_file(file, text);
  } else if (*published != text) {
    throw_bad_input("the seals published here are of other worlds", file.string(),
                    "choose another folder, or this one's --worlds, --level and --secret-file");
  }
}

}  // namespace

std::size_t ChallengeScore::right() const {
  return static_cast<std::size_t>(std::ranges::count(results, true, &ChallengeResult::right));
}

std::size_t ChallengeScore::wrong() const {
  return static_cast<std::size_t>(std::ranges::count(results, true, &ChallengeResult::wrong));
}

double ChallengeScore::median_seconds() const {
  std::vector<double> seconds;
  for (const ChallengeResult& one : results) {
    seconds.push_back(one.right ? one.seconds : MotionLimits().seconds);
  }
  if (seconds.empty()) return 0;
  std::ranges::sort(seconds);
  const std::size_t middle = seconds.size() / 2;
  return seconds.size() % 2 == 1 ? seconds[middle] : 0.5 * (seconds[middle - 1] + seconds[middle]);
}

std::vector<simulation::WorldPlan> challenge_worlds(const ChallengePlan& plan) {
  const RandomStream random(key_of(sha256_of_text(plan.secret)));
  std::vector<simulation::WorldPlan> worlds;
  for (int k = 0; k < plan.worlds; ++k) {
    RandomStream own = random.split(static_cast<std::uint64_t>(k));
    worlds.push_back({own.next(), plan.level, {}});
  }
  return worlds;
}

std::optional<ChallengeResult> run_challenge_world(const std::vector<std::string>& command,
                                                   const simulation::WorldPlan& plan, double wall_s,
                                                   const std::atomic<bool>* end) {
  simulation::World world(plan);
  ChallengeResult result;
  result.seal = seal_of(world.truth());
  result.kind = world_kind_name(world.truth().kind);
  Talk talk(command, wall_s, end);
  try {
    converse(talk, world, result);
  } catch (const BrokenOff&) {
    return std::nullopt;
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::environment) throw;
    result.verdict = "failed";
    result.reason = error.what();
  } catch (const Json::exception& error) {
    result.verdict = "failed";
    result.reason = fmt::format("the program's line is malformed: {}", json_complaint(error));
  }
  result.seconds = world.seconds_used();
  return result;
}

ChallengeScore run_challenge(const ChallengePlan& plan, const std::string& name,
                             const std::vector<std::string>& command,
                             const std::filesystem::path& folder, const std::atomic<bool>& stop) {
  make_output_folder(folder);
  const std::vector<simulation::WorldPlan> worlds = challenge_worlds(plan);
  Json seals = Json::array();
  for (const simulation::WorldPlan& one : worlds) {
    seals.push_back(seal_of(simulation::World(one).truth()));
  }
  publish_seals(folder / "seals.json", seals);
  const std::filesystem::path scored = folder / (name + ".json");
  const std::filesystem::path leaderboard = folder / "leaderboard.md";
  for (const std::filesystem::path& file : {scored, leaderboard}) try_output_file(file);
  ChallengeScore score{name, {}};
  ProgressLine progress(worlds.size(), static_cast<double>(worlds.size()), plan.quiet, {"worlds"});
  for (const simulation::WorldPlan& one : worlds) {
    if (stop) break;
    std::optional<ChallengeResult> result =
        run_challenge_world(command, one, plan.wall_s, plan.end);
    if (!result) break;
    score.results.push_back(std::move(*result));
    progress.cell_ended(1, score.results.back().verdict == "failed");
    write_file(scored, write_json(score_json(score), 1) + "\n");
  }
  write_file(leaderboard, leaderboard_of(folder, seals));
  return score;
}

std::string revealed_challenge(const ChallengePlan& plan) {
  Json worlds = Json::array();
  for (const simulation::WorldPlan& one : challenge_worlds(plan)) {
    const simulation::World world(one);
    worlds.push_back({{"key", seal_key(one)},
                      {"truth_sha256", seal_of(world.truth())},
                      {"sealed_text", sealed_text(world.truth())},
                      {"truth", Json::parse(truth_json(world.truth()))}});
  }
  return write_json(Json{{"secret", plan.secret}, {"worlds", worlds}}, 1) + "\n";
}

}  // namespace tribench
