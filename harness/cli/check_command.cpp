// SPDX-License-Identifier: MIT
//
// tribench check: proves or refutes that a formula has a finite value everywhere in a box.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "algorithms/expression/complexity.hpp"
#include "algorithms/expression/input_box.hpp"
#include "algorithms/expression/singularity.hpp"
#include "foundation/error.hpp"
#include "harness/cli/commands.hpp"

namespace tribench {
namespace {

struct CheckOptions {
  std::string formula;
  std::string box;
  bool json = false;
};

ExitStatus status_of(Verdict verdict) {
  if (verdict == Verdict::proved_free) return ExitStatus::done;
  return verdict == Verdict::refuted ? ExitStatus::found : ExitStatus::undecided;
}

nlohmann::json ranges_json(const std::vector<Interval>& ranges, const NamedBox& box) {
  nlohmann::json json = nlohmann::json::object();
  for (std::size_t j = 0; j < ranges.size(); ++j) {
    json[box.names[j]] = {ranges[j].low, ranges[j].high};
  }
  return json;
}

void print_json(const Expression& formula, const NamedBox& box, const SingularityResult& result,
                double seconds) {
  nlohmann::ordered_json json = {{"verdict", verdict_name(result.verdict)},
                                 {"witness", nullptr},
                                 {"boxes", result.boxes},
                                 {"seconds", seconds},
                                 {"complexity", paper_complexity(formula)},
                                 {"nodes", node_count(formula)}};
  if (result.witness) {
    json["witness"] = nlohmann::json::parse(witness_json(*result.witness, box.names));
  }
  if (result.verdict == Verdict::undecided) {
    json["undecided_box"] = ranges_json(result.undecided_box, box);
  }
  fmt::print("{}\n", json.dump(2));
}

void print_text(const NamedBox& box, const SingularityResult& result, double seconds) {
  const std::string where = print_box(box);
  switch (result.verdict) {
    case Verdict::proved_free:
      fmt::print("proved_free: finite everywhere on {}", where);
      break;
    case Verdict::refuted:
      fmt::print("refuted: singular at {}", witness_json(*result.witness, box.names));
      break;
    default:
      fmt::print("undecided on {}; smallest box left: {}", where,
                 ranges_json(result.undecided_box, box).dump());
  }
  fmt::print("  ({} boxes, {:.3g} s)\n", result.boxes, seconds);
}

ExitStatus run_check(const CheckOptions& options) {
  NamedBox box = parse_box(options.box);
  const Expression formula = parse_over(options.formula, box);
  const auto start = std::chrono::steady_clock::now();
  const SingularityResult result = prove_free(formula, box.ranges);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  if (options.json) {
    print_json(formula, box, result, seconds.count());
  } else {
    print_text(box, result, seconds.count());
  }
  return status_of(result.verdict);
}

}  // namespace

void add_check_command(CLI::App& app, ExitStatus& status) {
  CLI::App* check =
      app.add_subcommand("check", "Proves or refutes that a formula is finite everywhere in a box");
  check->footer(
      "Example: tribench check 'v/(v^2 - 2*v + 2)' --box 'v=-2:2'\n"
      "A formula that begins with a minus stands behind --.\n"
      "Exit status: 0 proved, 1 refuted, 4 undecided, 2 bad input.");
  auto options = std::make_shared<CheckOptions>();
  check->add_option("formula", options->formula, "The formula; sgn_X is the sign of X")->required();
  check->add_option("--box", options->box, "Ranges of the inputs: 'v=-2:2,g=-60:60'")->required();
  check->add_flag("--json", options->json, "{verdict, witness, boxes, seconds, complexity, nodes}");
  check->callback([options, &status] { status = run_check(*options); });
}

}  // namespace tribench
