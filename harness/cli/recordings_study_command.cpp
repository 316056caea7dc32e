// SPDX-License-Identifier: MIT
//
// tribench study recordings: measured data held back and offered as movements.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "algorithms/exploration/explanation_search.hpp"
#include "algorithms/exploration/recorded_movements.hpp"
#include "algorithms/exploration/second_opinion.hpp"
#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/data_options.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/study/each_case.hpp"
#include "problems/preparation/recording.hpp"

namespace tribench {
namespace {

struct RecordingsArguments {
  std::vector<std::string> files;
  std::shared_ptr<DataOptions> reading = std::make_shared<DataOptions>();
  std::optional<double> min_speed;
  bool unordered = false;
  bool steady = false;
  double longest_s = 10;
  int rows = 3000;
  double alpha = 0.01;
  int orders = 10;
  int threads = 0;
  bool json = false;
};

loop::Observations offered_movements(const RecordingsArguments& arguments) {
  const std::vector<std::filesystem::path> files(arguments.files.begin(), arguments.files.end());
  const PreparedRecording recording =
      prepare(read_data(files, *arguments.reading, std::vector<std::string>()), *arguments.reading,
              Gravity::automatic, arguments.min_speed ? SlowRows::kept : SlowRows::left_out);
  const loop::Observations all =
      loop::observe(recording.data,
                    {recording.rigid, arguments.min_speed, arguments.unordered, arguments.steady});
  return loop::cut_movements(all.averaged(static_cast<std::size_t>(arguments.rows)).data,
                             arguments.longest_s);
}

struct Needed {
  double least = 0;
  double median = 0;
  double most = 0;
};

Needed needed_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::ranges::sort(values);
  const std::size_t middle = values.size() / 2;
  const double median =
      values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
  return {values.front(), median, values.back()};
}

struct RecordingsFindings {
  std::string verdict;  // of all movements
  std::size_t all = 0;
  double all_s = 0;
  loop::AskedRecordings asked;
  Needed movements;  // in orders that were drawn
  Needed seconds;
};

void print_recordings_json(const loop::Observations& data, const RecordingsFindings& found,
                           int orders) {
  nlohmann::ordered_json path = nlohmann::ordered_json::array();
  const std::vector<int> numbers = data.movements();
  for (const loop::AskedMovement& step : found.asked.path) {
    const auto number = static_cast<std::size_t>(numbers[step.movement]);
    path.push_back(
        {{"movement", data.movement_names[number]}, {"seconds", step.seconds}, {"why", step.why}});
  }
  const auto three = [](const Needed& one) {
    return nlohmann::ordered_json::array({one.least, one.median, one.most});
  };
  const nlohmann::ordered_json json = {
      {"verdict", found.verdict},
      {"movements", found.all},
      {"seconds", found.all_s},
      {"asked", {{"movements", found.asked.path.size()}, {"seconds", found.asked.seconds()}}},
      {"drawn",
       {{"orders", orders},
        {"movements", three(found.movements)},
        {"seconds", three(found.seconds)}}},
      {"path", path}};
  fmt::print("{}\n", write_json(json, 1));
}

void print_recordings(const RecordingsFindings& found, int orders) {
  fmt::print("all {} movements ({:.0f} s) say {}; so many were needed to say it:\n", found.all,
             found.all_s, found.verdict);
  fmt::print("| order | movements | seconds |\n|---|--:|--:|\n");
  fmt::print("| asked for | {} | {:.0f} |\n", found.asked.path.size(), found.asked.seconds());
  fmt::print(
      "| drawn, {} times: median (least .. most) | {:g} ({:g} .. {:g}) | {:.0f} ({:.0f} .. {:.0f}) "
      "|\n",
      orders, found.movements.median, found.movements.least, found.movements.most,
      found.seconds.median, found.seconds.least, found.seconds.most);
}

void run_recordings(const RecordingsArguments& arguments) {
  const loop::Observations data = offered_movements(arguments);
  loop::DiagnosisOptions options;
  if (arguments.reading->drive.gear_ratio) {
    options.gear_ratios = {*arguments.reading->drive.gear_ratio};
  }
  // Of rows that are too few for a diagnosis nothing is said.
  const loop::VerdictOf verdict = [&](const loop::Observations& rows) -> std::string {
    try {
      const loop::NamedFamilies found = loop::diagnosed_families(rows, options);
      return loop::verdict_text(found.names, found.unknown);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::bad_input || rows.rows() == data.rows()) throw;
      return {};
    }
  };
  RecordingsFindings found;
  found.verdict = verdict(data);
  found.all = data.movements().size();
  found.asked =
      loop::ask_for_recordings(data, options.gear_ratios, arguments.alpha, verdict, found.verdict);
  std::vector<double> movements(static_cast<std::size_t>(arguments.orders));
  std::vector<double> seconds(movements.size());
  for_each_case(movements.size(), arguments.threads, arguments.json, [&](std::size_t k) {
    const loop::AskedRecordings drawn = loop::draw_recordings(data, verdict, found.verdict, k + 1);
    movements[k] = static_cast<double>(drawn.path.size());
    seconds[k] = drawn.seconds();
  });
  found.movements = needed_of(std::move(movements));
  found.seconds = needed_of(std::move(seconds));
  for (const loop::RowRange& range : loop::make_clusters(data.movement, 1).movements) {
    found.all_s += data.time[range.end - 1] - data.time[range.begin];
  }
  if (arguments.json) {
    print_recordings_json(data, found, arguments.orders);
  } else {
    print_recordings(found, arguments.orders);
  }
}

}  // namespace

void add_recordings_study(CLI::App& study) {
  CLI::App* command = study.add_subcommand(
      "recordings",
      "Measured data held back and offered as movements: how few say what all of them say");
  command->footer(
      "Example: tribench study recordings pendulum.csv --roles run=movement --orders 20");
  auto arguments = std::make_shared<RecordingsArguments>();
  command->add_option("FILE", arguments->files, "recordings, as tribench loop reads them")
      ->required();
  add_data_options(*command, arguments->reading);
  command->add_option("--min-speed", arguments->min_speed, "slower rows are left out")
      ->transform(real_number(0, 1e6));
  command->add_flag("--unordered", arguments->unordered,
                    "the order of the movements says nothing: no drift");
  command->add_flag("--steady", arguments->steady, "each movement holds one speed");
  command->add_option("--longest", arguments->longest_s, "seconds; longer movements are cut up")
      ->transform(real_number(0.1, 1e6))
      ->capture_default_str();
  command->add_option("--rows", arguments->rows, "average neighbours to about so many rows")
      ->transform(whole_number(100, 1'000'000))
      ->capture_default_str();
  command->add_option("--alpha", arguments->alpha, "as of tribench explore")
      ->transform(real_number(1e-6, 0.5))
      ->capture_default_str();
  command->add_option("--orders", arguments->orders, "random orders to compare with")
      ->transform(whole_number(0, 10'000))
      ->capture_default_str();
  command->add_option("--jobs", arguments->threads, "threads; the figures are the same for any")
      ->transform(whole_number(0, 1024));
  command->add_flag("--json", arguments->json, "one object, the path included");
  command->callback([arguments] { run_recordings(*arguments); });
}

}  // namespace tribench
