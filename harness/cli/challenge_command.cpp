// SPDX-License-Identifier: MIT
//
// tribench challenge: sealed worlds for anybody's method of naming what is missing.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "foundation/error.hpp"
#include "foundation/plain_name.hpp"
#include "foundation/standard_streams.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/cli/world_options.hpp"
#include "harness/study/challenge.hpp"
#include "problems/reading/file_text.hpp"

namespace tribench {
namespace {

struct ChallengeArguments {
  ChallengePlan plan;
  WorldChoice choice;
  std::string secret_file;
  std::string name = "entry";
  std::vector<std::string> command;
  std::string out;
  bool reveal = false;
  bool json = false;
};

void print_score(const ChallengeScore& score, const std::string& out) {
  for (std::size_t k = 0; k < score.results.size(); ++k) {
    const ChallengeResult& one = score.results[k];
    fmt::print("  world {}: {} {}, {} movements, {:.1f} s {}\n", k + 1, one.verdict,
               one.right   ? "(right)"
               : one.wrong ? "(wrong)"
                           : "",
               one.movements, one.seconds, one.reason);
  }
  fmt::print("{}: {} right, {} wrong of {} worlds, median {:.0f} s; {}/leaderboard.md\n",
             score.name, score.right(), score.wrong(), score.results.size(), score.median_seconds(),
             out);
}

void print_score_json(const ChallengeScore& score) {
  fmt::print(
      "{{\"name\": \"{}\", \"right\": {}, \"wrong\": {}, \"worlds\": {}, "
      "\"median_seconds\": {}}}\n",
      score.name, score.right(), score.wrong(), score.results.size(), score.median_seconds());
}

// A file of blanks hides nothing: everybody could make its worlds.
std::string read_secret(const std::string& file) {
  std::string secret = read_file_text(file);
  if (secret.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw_bad_input("the file holds no secret", file, "write a line into it that nobody knows");
  }
  return secret;
}

ExitStatus run_challenge_command(ChallengeArguments arguments) {
  arguments.plan.level = arguments.choice.level;
  if (!arguments.secret_file.empty()) arguments.plan.secret = read_secret(arguments.secret_file);
  if (arguments.reveal) {
    fmt::print("{}", revealed_challenge(arguments.plan));
    return ExitStatus::done;
  }
  if (arguments.command.empty() || arguments.out.empty()) {
    throw_bad_input("there is no program to be challenged, or no folder for its score", "challenge",
                    "--command python3 entry.py --out board");
  }
  if (!is_plain_name(arguments.name) || arguments.name == "seals") {
    throw_bad_input(fmt::format("'{}' is no name for a score's file", arguments.name), "--name",
                    "letters, digits, - and _");
  }
  arguments.plan.quiet = false;
  arguments.plan.end = &end_requested_by_signal();
  const ChallengeScore score = run_challenge(arguments.plan, arguments.name, arguments.command,
                                             arguments.out, stop_requested_by_signal());
  if (arguments.json) {
    print_score_json(score);
  } else {
    print_score(score, arguments.out);
  }
  const auto worlds = static_cast<std::size_t>(arguments.plan.worlds);
  const bool stopped = score.results.size() < worlds;
  if (stopped) {
    print_message(fmt::format(
        "stopped: {} of {} worlds are done, which is not ranked; the same command begins anew\n",
        score.results.size(), worlds));
  }
  const bool failed = std::ranges::count(score.results, "failed", &ChallengeResult::verdict) > 0;
  return failed || stopped ? ExitStatus::failed : ExitStatus::done;
}

}  // namespace

void add_challenge_command(CLI::App& app, ExitStatus& status) {
  CLI::App* command = app.add_subcommand(
      "challenge", "Sealed worlds for your own method of naming what is missing, and its score");
  command->footer(
      "Example: tribench challenge --out board --name mine --command python3 mine.py\n"
      "The protocol: docs/challenge.md; an entry to begin with: adapters/challenge_entry.py.\n"
      "Exit status 3 where the program failed in a world, or where Ctrl-C (after the world under "
      "way)\n"
      "or SIGTERM (at once) stopped it before the last.");
  auto arguments = std::make_shared<ChallengeArguments>();
  command->add_option("--command", arguments->command,
                      "the program and its words, run without a shell once a world");
  command->add_option("--name", arguments->name, "of the entry")->capture_default_str();
  command->add_option("--worlds", arguments->plan.worlds, "how many")
      ->transform(whole_number(1, 100'000))
      ->capture_default_str();
  command->add_option("--secret-file", arguments->secret_file,
                      "the worlds follow from its text; without it those for practice");
  add_world_level(*command, arguments->choice);
  command
      ->add_option("--wall-seconds", arguments->plan.wall_s,
                   "that the program may take for a world")
      ->transform(real_number(0.01, 1e6))
      ->capture_default_str();
  command->add_option("--out", arguments->out, "folder for seals.json, NAME.json, leaderboard.md");
  command->add_flag("--reveal", arguments->reveal,
                    "print secret, keys and truths, when the challenge is over");
  command->add_flag("--json", arguments->json, "the score as JSON");
  command->callback([arguments, &status] { status = run_challenge_command(*arguments); });
}

}  // namespace tribench
