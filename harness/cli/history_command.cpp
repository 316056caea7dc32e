// SPDX-License-Identifier: MIT
//
// tribench history: the store of a nightly job. What is kept, what changed, what is the base.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/output_file.hpp"
#include "foundation/standard_streams.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/nightly.hpp"
#include "harness/provenance.hpp"
#include "reports/night_feed.hpp"
#include "reports/night_page.hpp"
#include "reports/night_store.hpp"

namespace tribench {
namespace {

struct HistoryArguments {
  std::string store;
  std::vector<std::string> runs;
  std::string night;
  std::string reason;
  std::string page;
  std::string feed;
  std::size_t keep = 400;
  bool dry_run = false;
  bool json = false;
};

// A store that is named must be there: a typing error makes no new one.
NightStore existing(const std::string& folder) {
  if (!std::filesystem::is_directory(std::filesystem::path(folder) / "nights")) {
    throw_bad_input("this is no store of nights", folder,
                    "'tribench nightly' and 'tribench history record' make one");
  }
  return NightStore(folder);
}

nlohmann::ordered_json json_of(const StoreHistory& history) {
  nlohmann::ordered_json changes = nlohmann::ordered_json::array();
  for (const HistoryChange& change : changes_of(history)) {
    const Night& night = history.nights[change.night];
    changes.push_back({{"night", night.name},
                       {"commit", night.commit},
                       {"machine", night.machine},
                       {"figure", change.figure},
                       {"problem", change.problem},
                       {"method", change.method},
                       {"operators", change.operators},
                       {"ratio", change.ratio}});
  }
  return {{"nights", history.nights.size()},
          {"series", history.series.size()},
          {"benches", history.benches.size()},
          {"damaged", history.damaged},
          {"base", history.blessings.empty() ? "" : history.blessings.back().night},
          {"changes", changes}};
}

void show(const HistoryArguments& arguments) {
  const StoreHistory history = read_history(existing(arguments.store));
  if (arguments.json) {
    fmt::print("{}\n", write_json(json_of(history), 2));
  } else {
    fmt::print("{}", history_text(history));
  }
  if (!arguments.page.empty()) write_file(arguments.page, history_page(history));
  if (!arguments.feed.empty()) write_file(arguments.feed, history_feed(history));
}

void record(const HistoryArguments& arguments) {
  NightStore store(arguments.store);
  for (const std::string& folder : arguments.runs) {
    const RunFolder run = read_run_folder(folder);
    const Night night = night_of_run(run, night_name(run));
    store.record(night);
    fmt::print("{}\n", night.name);
  }
}

void bless(const HistoryArguments& arguments) {
  NightStore store = existing(arguments.store);
  const std::vector<std::string> names = store.names();
  if (names.empty()) throw_bad_input("the store has no night yet", arguments.store);
  const std::string night = arguments.night.empty() ? names.back() : arguments.night;
  store.bless({night, arguments.reason, utc_now()});
  fmt::print("base from now on: {}\n", night);
  // A store of records alone has no runs at all; 'tribench nightly' compares cell by cell.
  if (std::filesystem::exists(store.runs()) &&
      !std::filesystem::exists(store.runs() / night / "results.csv")) {
    print_message(fmt::format(
        "tribench: {}: the night's run is not kept any more: 'tribench nightly' will refuse this "
        "base until the folder is brought back\n",
        (store.runs() / night).string()));
  }
}

void prune(const HistoryArguments& arguments) {
  NightStore store = existing(arguments.store);
  const std::vector<std::string> going = store.prune(arguments.keep, !arguments.dry_run);
  for (const std::string& name : going) fmt::print("{}\n", name);
  fmt::print("{} nights {}\n", going.size(), arguments.dry_run ? "would go" : "removed");
}

}  // namespace

void add_history_command(CLI::App& app, ExitStatus& /*status*/) {
  CLI::App* history = app.add_subcommand("history", "The store of a nightly job: years of runs");
  history->footer("Example: tribench history show nights --page nights.html");
  history->require_subcommand(1);
  auto arguments = std::make_shared<HistoryArguments>();
  const auto add = [&](const char* name, const char* summary,
                       void (*action)(const HistoryArguments&)) {
    CLI::App* command = history->add_subcommand(name, summary);
    command->add_option("store", arguments->store, "the store's folder")->required();
    command->callback([arguments, action] { action(*arguments); });
    return command;
  };
  CLI::App* shown = add("show", "Nights, changes of level and the base", show);
  shown->add_option("--page", arguments->page, "write a page with trend lines");
  shown->add_option("--feed", arguments->feed, "write a feed (Atom) of the changes");
  shown->add_flag("--json", arguments->json, "{nights, series, benches, damaged, base, changes}");
  add("record", "Keeps what matters of a run; a night is never changed", record)
      ->add_option("run", arguments->runs, "folders of runs, in any order")
      ->required();
  CLI::App* blessed = add("bless", "Accepts the level of a night as the base from now on", bless);
  blessed->add_option("reason", arguments->reason, "why, in a line")->required();
  blessed->add_option("--night", arguments->night, "which (default: the last)");
  CLI::App* pruned = add("prune", "Removes old nights, never a blessed one; says which", prune);
  pruned->add_option("--keep", arguments->keep, "the last so many stay")
      ->transform(whole_number(1))
      ->capture_default_str();
  pruned->add_flag("--dry-run", arguments->dry_run, "only say which");
}

}  // namespace tribench
