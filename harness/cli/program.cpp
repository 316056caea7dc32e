// SPDX-License-Identifier: MIT
#include "harness/cli/program.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <functional>
#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "algorithms/fitting/product_blocking.hpp"
#include "foundation/error.hpp"
#include "foundation/free_memory.hpp"
#include "foundation/freed_memory.hpp"
#include "foundation/standard_streams.hpp"
#include "foundation/suggestion.hpp"
#include "foundation/text.hpp"
#include "harness/cli/commands.hpp"
#include "harness/provenance.hpp"
#include "harness/worker.hpp"

namespace tribench {
namespace {

int exit_code(ExitStatus status) { return static_cast<int>(status); }

// "tribench list".
std::string command_path(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  return parent == nullptr ? command.get_name() : command_path(*parent) + " " + command.get_name();
}

// The innermost subcommand that was given.
const CLI::App& innermost(const CLI::App& app) {
  const std::vector<CLI::App*> given = app.get_subcommands();
  return given.empty() ? app : innermost(*given.back());
}

// Names that may stand where an unknown word stands: options for one that begins with a minus,
// else subcommands.
std::vector<std::string> names_like(const CLI::App& command, const std::string& word) {
  std::vector<std::string> names;
  if (word.starts_with("-")) {
    for (const CLI::Option* option : command.get_options()) {
      if (option->get_group().empty()) continue;  // hidden
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
  } else {
    for (const CLI::App* each : command.get_subcommands({})) {
      if (!each->get_group().empty()) names.push_back(each->get_name());
    }
  }
  return names;
}

// A word that the command line does not know, said with the nearest one that it does; empty where
// there is no such word.
std::string unknown_word(const CLI::App& app) {
  const CLI::App& command = innermost(app);
  std::vector<std::string> left = command.remaining();
  const bool is_behind_mark = std::erase(left, "--") > 0;  // what CLI11 leaves there, too
  if (left.empty()) return {};
  const std::string word = left.front().substr(0, left.front().find('='));
  const std::vector<std::string> names = names_like(command, word);
  const bool is_option = word.starts_with("-");
  std::string help = fmt::format("see: {} --help", command_path(command));
  if (is_behind_mark && is_option) {
    return fmt::format(
        "tribench: '{}' stands behind '--', where nothing is an option; put options in front of "
        "it; {}\n",
        word, help);
  }
  if (is_option && !word.starts_with("--")) {
    help = "a formula that begins with a minus stands behind '--', the last of all; " + help;
  }
  const std::string mend =
      names.empty() ? help : did_you_mean(word, names, is_option ? help : std::string());
  return fmt::format("tribench: there is no {} '{}'; {}\n",
                     is_option       ? "option"
                     : names.empty() ? "further argument"
                                     : "subcommand",
                     word, mend);
}

// What the command needs and was not given, all at once, each with what it is, and the example of
// its help; empty where nothing is missing.
std::string missing_words(const CLI::App& app) {
  const CLI::App& command = innermost(app);
  std::string text;
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_required() || option->count() > 0) continue;
    text += fmt::format("tribench: {} is required: {}\n", option->get_name(),
                        option->get_description());
  }
  if (text.empty()) return text;
  // The first line of the help's example, where it is one of this command.
  const std::string path = command_path(command);
  const std::string example = "Example: " + path + " ";
  const std::string footer = command.get_footer();
  const std::size_t at = footer.find(example);
  if (at != std::string::npos) text += footer.substr(at, footer.find('\n', at) - at) + "\n";
  return text + fmt::format("see: {} --help\n", path);
}

// Usage errors are bad input (2); --help and --version are done (0).
int report_usage(const CLI::App& app, const CLI::ParseError& error) {
  const bool is_usage = error.get_exit_code() != 0;
  std::string said = is_usage ? unknown_word(app) : std::string();
  if (is_usage && said.empty() && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    said = missing_words(app);
  }
  if (!said.empty()) {
    print_message(said);
  } else {
    app.exit(error);
  }
  return exit_code(is_usage ? ExitStatus::bad_input : ExitStatus::done);
}

// Whether something is written there.
bool is_place(const CLI::Option& option) {
  static const std::vector<std::string> kPlaces = {"out",  "save", "save-effect", "certificate",
                                                   "page", "feed", "pictures",    "store"};
  return std::ranges::any_of(option.get_lnames(), [](const std::string& name) {
    return std::ranges::find(kPlaces, name) != kPlaces.end();
  });
}

// An empty word is a shell's variable that was not set: what is written there would lie anywhere,
// and an option would be taken for one that was not given.
void refuse_empty_words(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    if (option->get_items_expected_max() == 0) continue;  // a flag
    option->check([is_place = is_place(*option)](const std::string& text) -> std::string {
      if (!text.empty()) return {};
      return is_place ? "'' cannot be used; use the name of a file or folder"
                      : "'' cannot be used; use a word, or leave it out";
    });
  }
  for (CLI::App* command : app.get_subcommands(nullptr)) refuse_empty_words(*command);
}

// A file that the command reads is not where it writes: a measurement would be lost.
void refuse_writing_over_what_is_read(const CLI::App& command) {
  const auto is_one_file = [](const std::string& one, const std::string& other) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(one, ignored) &&
           std::filesystem::equivalent(one, other, ignored);
  };
  for (const CLI::Option* place : command.get_options()) {
    if (!is_place(*place)) continue;
    for (const CLI::Option* other : command.get_options()) {
      if (is_place(*other)) continue;
      for (const std::string& written : place->results()) {
        for (const std::string& read : other->results()) {
          if (!is_one_file(written, read)) continue;
          throw CLI::ValidationError(
              place->get_name(),
              fmt::format("'{}' is read by this command; write to another file", written));
        }
      }
    }
  }
}

// The subcommand that is asked for, without the others: all their options are most of what a start
// takes. All of them where the word is none, as for --help and for a misspelt one, and for
// `describe`, which tells of all.
void add_commands(CLI::App& app, ExitStatus& status, const Registry& registry,
                  std::string_view asked) {
  const std::pair<std::string_view, std::function<void()>> commands[] = {
      {"run", [&] { add_run_command(app, status, registry); }},
      {"fit", [&] { add_fit_command(app, status, registry); }},
      {"merge", [&] { add_merge_command(app, status); }},
      {"pretrain", [&] { add_pretrain_command(app, status); }},
      {"report", [&] { add_report_command(app, status); }},
      {"check", [&] { add_check_command(app, status); }},
      {"data", [&] { add_data_command(app, status); }},
      {"compare", [&] { add_compare_command(app, status); }},
      {"export", [&] { add_export_command(app, status); }},
      {"predict", [&] { add_predict_command(app, status); }},
      {"simulate", [&] { add_simulate_command(app, status); }},
      {"generate", [&] { add_generate_command(app, status); }},
      {"loop", [&] { add_loop_command(app, status, registry); }},
      {"history", [&] { add_history_command(app, status); }},
      {"nightly", [&] { add_nightly_command(app, status, registry); }},
      {"world", [&] { add_world_command(app, status); }},
      {"explore", [&] { add_explore_command(app, status); }},
      {"challenge", [&] { add_challenge_command(app, status); }},
      {"list", [&] { add_list_command(app, status, registry); }},
      {"study", [&] { add_study_command(app, status, registry); }},
      {"submit", [&] { add_submit_command(app, status, registry); }},
      {"describe", [&] { add_describe_command(app); }}};
  const bool is_one = asked != "describe" && std::ranges::any_of(commands, [&](const auto& each) {
                        return each.first == asked;
                      });
  for (const auto& [name, add] : commands) {
    if (!is_one || name == asked) add();
  }
}

int run_command_line(int argc, char** argv, const Registry& registry) {
  keep_freed_memory();
  hold_to_free_memory();
  CLI::App app("Benchmarks symbolic regression of joint friction, and closes the loop with data.",
               "tribench");
  app.set_version_flag("--version", version_with_commit());
  app.require_subcommand(1);
  app.footer(
      "Every subcommand has --help with an example.\n"
      "Exit status: 0 done, 1 found what it was asked to look for (a regression, a singularity), 2 "
      "bad "
      "input, 3 failed, 4 undecided.");
  ExitStatus status = ExitStatus::done;
  add_commands(app, status, registry, argc > 1 ? argv[1] : "");
  refuse_empty_words(app);
  // When all words are read, before a subcommand begins.
  app.parse_complete_callback([&app] { refuse_writing_over_what_is_read(innermost(app)); });
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return report_usage(app, error);
  }
  return exit_code(status);
}

// An error quotes what came from outside: nothing of it reaches the terminal as a command.
void print_error(std::string_view message) {
  print_message(fmt::format("tribench: {}\n", lines_without_control_characters(message)));
}

int run_guarded(int argc, char** argv, const Registry& registry) {
  try {
    if (argc == 2 && std::strcmp(argv[1], kWorkerCommand) == 0) return run_worker(registry);
    return run_command_line(argc, argv, registry);
  } catch (const Error& error) {
    print_error(error.what());
    return exit_code(error.kind() == ErrorKind::bad_input ? ExitStatus::bad_input
                                                          : ExitStatus::failed);
  } catch (const std::filesystem::filesystem_error& error) {  // a name that no file can have
    print_error(fmt::format("{}: {}", error.path1().string(), error.code().message()));
    const bool is_name = error.code() == std::errc::too_many_symbolic_link_levels ||
                         error.code() == std::errc::filename_too_long;
    return exit_code(is_name ? ExitStatus::bad_input : ExitStatus::failed);
  } catch (const std::bad_alloc&) {
    print_message("tribench: there is not enough memory; give it less data or more memory\n");
    return exit_code(ExitStatus::failed);
  } catch (const std::exception& error) {
    print_error(error.what());
    return exit_code(ExitStatus::failed);
  }
}

}  // namespace

int run_program(int argc, char** argv, const Registry& registry) {
  take_standard_streams();
  pin_product_blocking();
  const int status = run_guarded(argc, argv, registry);
  if (has_output_arrived()) return status;
  print_message("tribench: the standard output cannot be written; check where it goes\n");
  return exit_code(ExitStatus::failed);
}

}  // namespace tribench
