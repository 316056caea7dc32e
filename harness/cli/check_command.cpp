// SPDX-License-Identifier: MIT
//
// tribench check: proves or refutes that a formula has a finite value everywhere in a box, or a
// property of a friction law; writes and verifies certificates.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>

#include "algorithms/expression/certificate.hpp"
#include "algorithms/expression/complexity.hpp"
#include "algorithms/expression/input_box.hpp"
#include "algorithms/expression/property.hpp"
#include "algorithms/states/dissipation.hpp"
#include "algorithms/states/state_text.hpp"
#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/output_file.hpp"
#include "foundation/text.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/progress_line.hpp"

namespace tribench {
namespace {

using Json = nlohmann::ordered_json;

struct CheckOptions {
  std::string formula;
  std::string box;
  std::string property = "finite";
  std::string velocity;
  double limit = kInfinity;
  double from = 0;
  std::string certificate;
  std::string verify;
  bool json = false;
};

ExitStatus status_of(Verdict verdict) {
  if (verdict == Verdict::proved_free) return ExitStatus::done;
  return verdict == Verdict::refuted ? ExitStatus::found : ExitStatus::undecided;
}

Property property_of(const std::string& name) {
  std::vector<std::string> names;
  for (const Property property : {Property::finite, Property::bounded, Property::dissipative,
                                  Property::monotone, Property::odd}) {
    if (property_name(property) == name) return property;
    names.emplace_back(property_name(property));
  }
  throw_bad_input(fmt::format("there is no property '{}'", name), "--property",
                  fmt::format("known: {}", fmt::join(names, ", ")));
}

// The input named, else v or qd, else the first.
std::size_t velocity_of(const CheckOptions& options, const NamedBox& box) {
  const auto place = [&box](const std::string& name) {
    return static_cast<std::size_t>(std::find(box.names.begin(), box.names.end(), name) -
                                    box.names.begin());
  };
  if (!options.velocity.empty()) {
    const std::size_t named = place(options.velocity);
    if (named < box.names.size()) return named;
    throw_bad_input(fmt::format("'{}' is not an input", options.velocity), "--velocity",
                    fmt::format("known: {}", fmt::join(box.names, ", ")));
  }
  for (const char* usual : {"v", "qd", "velocity"}) {
    if (place(usual) < box.names.size()) return place(usual);
  }
  return 0;
}

// A property's proof is "proved"; that of finiteness keeps the name it has in records.
std::string_view verdict_text(Verdict verdict, Property property) {
  if (verdict == Verdict::proved_free && property != Property::finite) return "proved";
  return verdict_name(verdict);
}

Json ranges_json(const std::vector<Interval>& ranges, const NamedBox& box) {
  Json json = Json::object();
  for (std::size_t j = 0; j < ranges.size(); ++j) {
    json[box.names[j]] = {ranges[j].low, ranges[j].high};
  }
  return json;
}

void print_json(const Expression& formula, const NamedBox& box, Property property,
                const PropertyResult& result, double seconds) {
  Json json = {{"verdict", verdict_text(result.verdict, property)},
               {"witness", nullptr},
               {"boxes", result.boxes},
               {"seconds", seconds},
               {"complexity", paper_complexity(formula)},
               {"nodes", node_count(formula)},
               {"property", property_name(property)}};
  if (result.witness) json["witness"] = Json::parse(witness_json(*result.witness, box.names));
  if (result.verdict == Verdict::undecided) {
    json["undecided_box"] = ranges_json(result.undecided_box, box);
  }
  fmt::print("{}\n", write_json(json, 2));
}

// What a proof says of the box, in words where the property's name leaves the region open.
std::string claim_text(const NamedBox& box, const PropertyQuestion& question) {
  const std::string name(property_name(question.property));
  if (question.property == Property::bounded) return fmt::format("{} by {}", name, question.limit);
  if (question.property != Property::monotone) return name;
  const std::string& v = box.names[question.velocity];
  const std::string region =
      question.from > 0 ? fmt::format(", |{}| >= {} at both", v, question.from) : std::string();
  return fmt::format("{} (not falling from any {} to a greater one{})", name, v, region);
}

void print_text(const NamedBox& box, const PropertyQuestion& question, const PropertyResult& result,
                double seconds) {
  const Property property = question.property;
  const std::string_view verdict = verdict_text(result.verdict, property);
  switch (result.verdict) {
    case Verdict::proved_free:
      fmt::print("{}: {} everywhere on {}", verdict, claim_text(box, question), print_box(box));
      break;
    case Verdict::refuted:
      fmt::print("{}: not {} at {}", verdict, property_name(property),
                 witness_json(*result.witness, box.names));
      break;
    default:
      fmt::print("{}: {} on {}; smallest box left: {}", verdict, claim_text(box, question),
                 print_box(box), write_json(ranges_json(result.undecided_box, box)));
  }
  fmt::print("  ({} boxes, {:.3g} s)\n", result.boxes, seconds);
}

CertificateClaim claim_of(const PropertyQuestion& question, const NamedBox& box) {
  switch (question.property) {
    case Property::finite:
      return {};
    case Property::bounded:
      return {CertificateClaim::Kind::bounded, question.limit, ""};
    case Property::dissipative:
      return {CertificateClaim::Kind::dissipative, 0, box.names[question.velocity]};
    default:
      throw_bad_input(
          fmt::format("there are no certificates for '{}'", property_name(question.property)),
          "--certificate", "finite, bounded and dissipative have them");
  }
}

void save_certificate(const Expression& formula, const NamedBox& box, const CertificateClaim& claim,
                      const std::string& path) {
  const auto certificate = write_certificate(formula, box, kMaxPieces, claim);
  if (!certificate) {
    throw Error(
        ErrorKind::failed,
        fmt::format("proved, but the certificate would have more than {} pieces", kMaxPieces),
        "--certificate", "shrink the box or do without");
  }
  write_file(path, *certificate + "\n");
}

ExitStatus verify(const CheckOptions& options) {
  if (!options.formula.empty() || !options.box.empty()) {
    throw_bad_input("a certificate is of its own formula on its own box", "--verify",
                    "give no formula and no --box: the answer says which they are");
  }
  constexpr double kShownFromS = 2;
  std::optional<ProgressLine> line;
  const auto progress = [&line](std::size_t entries) {
    if (!line) {
      line.emplace(entries, static_cast<double>(entries), false,
                   ProgressUnit{"entries", false, kShownFromS});
    }
    line->cell_ended(1, false);
  };
  const CertificateCheck check = check_certificate(read_file(options.verify), progress);
  line.reset();  // before the answer
  if (options.json) {
    const Json json = {{"accepted", check.accepted}, {"reason", check.reason},
                       {"formula", check.formula},   {"box", check.box},
                       {"claim", check.claim},       {"pieces", check.pieces}};
    fmt::print("{}\n", write_json(json, 2));
  } else if (check.accepted) {
    fmt::print("accepted: {} is {} everywhere on {}  ({} pieces)\n", check.formula, check.claim,
               check.box, check.pieces);
  } else {
    fmt::print("rejected: {}\n", check.reason);
  }
  return check.accepted ? ExitStatus::done : ExitStatus::found;
}

// Of a formula with states: by stored energy, or refuted by a cycle that wins some.
ExitStatus check_dissipation(const CheckOptions& options, const StatefulFormula& formula,
                             const NamedBox& box, std::size_t velocity) {
  if (!options.certificate.empty()) {
    throw_bad_input("there are no certificates for dissipation with memory", "--certificate",
                    "finite and bounded have them");
  }
  const auto start = std::chrono::steady_clock::now();
  const DissipationResult result = prove_dissipation(formula, box.ranges, velocity);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  const std::string_view verdict = verdict_text(result.verdict, Property::dissipative);
  const bool is_refuted = result.verdict == Verdict::refuted;
  const std::string cycle =
      is_refuted ? work_cycle_json(result, box.names[velocity]) : std::string("null");
  if (options.json) {
    const Json json = {{"verdict", verdict},
                       {"witness", Json::parse(cycle)},
                       {"boxes", result.boxes},
                       {"seconds", seconds.count()},
                       {"complexity", paper_complexity(formula.formula)},
                       {"nodes", node_count(formula.formula)},
                       {"property", property_name(Property::dissipative)}};
    fmt::print("{}\n", write_json(json, 2));
  } else if (is_refuted) {
    fmt::print("{}: not dissipative: each round of {} gives energy to the joint", verdict, cycle);
  } else {
    fmt::print("{}: dissipative on {}", verdict, print_box(box));
  }
  if (!options.json) fmt::print("  ({} boxes, {:.3g} s)\n", result.boxes, seconds.count());
  return status_of(result.verdict);
}

ExitStatus run_check(const CheckOptions& options) {
  if (!options.verify.empty()) return verify(options);
  if (options.formula.empty()) {
    throw_bad_input("a formula is needed", "check", "give one, or --verify FILE");
  }
  NamedBox box = parse_box(options.box);
  const StatefulFormula read = parse_stateful_over(options.formula, box);
  const Expression& formula = read.formula;
  PropertyQuestion question;
  question.property = property_of(options.property);
  question.limit = options.limit;
  if (question.property == Property::bounded && question.limit == kInfinity) {
    throw_bad_input("a bound needs its limit", "--property bounded",
                    "add --limit N, in the formula's unit; without one ask for finite");
  }
  question.from = options.from;
  if (question.property != Property::finite) question.velocity = velocity_of(options, box);
  const bool has_memory = !read.states.empty();
  if (has_memory && question.property == Property::dissipative) {
    return check_dissipation(options, read, box, question.velocity);
  }
  CertificateClaim claim;  // asked for before the proof, so that a request in vain fails at once
  if (!options.certificate.empty()) {
    claim = claim_of(question, box);
    try_output_file(options.certificate);
  }
  const auto start = std::chrono::steady_clock::now();
  const PropertyResult result = prove_property(formula, box.ranges, question);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  if (options.json) {
    print_json(formula, box, question.property, result, seconds.count());
  } else {
    print_text(box, question, result, seconds.count());
  }
  if (!options.certificate.empty() && result.verdict == Verdict::proved_free) {
    save_certificate(formula, box, claim, options.certificate);
  }
  return status_of(result.verdict);
}

}  // namespace

void add_check_command(CLI::App& app, ExitStatus& status) {
  CLI::App* check =
      app.add_subcommand("check", "Proves or refutes that a formula is finite everywhere in a box");
  check->footer(
      "Examples: tribench check 'v/(v^2 - 2*v + 2)' --box 'v=-2:2' --certificate proof.json\n"
      "          tribench check --verify proof.json\n"
      "          tribench check '3*sgn_v + 2*v' --box 'v=-2:2' --property dissipative\n"
      "          tribench check 'z = lugre(v, sliding=1e-3, breakaway=2e-3, "
      "stribeck_velocity=0.01);"
      " 9e3*z + 20*v' --box 'v=-1:1' --property dissipative\n"
      "A state ranges over what its law allows; with states, dissipative asks for stored energy.\n"
      "A formula that begins with a minus stands behind --.\n"
      "Exit status: 0 proved (or accepted), 1 refuted (or rejected), 4 undecided, 2 bad input.");
  auto options = std::make_shared<CheckOptions>();
  check->add_option("formula", options->formula, "The formula; sgn_X is the sign of X");
  check->add_option("--box", options->box, "Ranges of the inputs: 'v=-2:2,g=-60:60'");
  check->add_option(
      "--property", options->property,
      "finite, bounded (|f| <= --limit), dissipative (f*v >= 0), monotone (f does "
      "not fall from any v to a greater one, |v| >= --from at both), odd (f(-v) = -f(v))");
  check->add_option("--velocity", options->velocity, "The input that is the velocity (v)");
  check->add_option("--limit", options->limit, "For bounded, in the formula's unit")
      ->transform(real_number(0, 1e308));
  check->add_option("--from", options->from, "For monotone, in the velocity's unit (0)")
      ->transform(real_number(0, 1e308));
  check->add_option("--certificate", options->certificate,
                    "Writes a proof (finite, bounded, dissipative) that --verify checks");
  check->add_option("--verify", options->verify, "Checks a certificate by itself");
  check->add_flag("--json", options->json,
                  "{verdict, witness, boxes, seconds, complexity, nodes, property}");
  check->callback([options, &status] { status = run_check(*options); });
}

}  // namespace tribench
