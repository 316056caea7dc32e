// SPDX-License-Identifier: MIT
#include "harness/exploration/exploration_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <set>

#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "reports/markdown.hpp"

namespace tribench {
namespace {

using Json = nlohmann::ordered_json;
using loop::Exploration;
using loop::ExplorationEnd;
using loop::ExplorationStep;
using loop::WeighedVerdict;

constexpr std::size_t kMostLeft = 8;

std::string movement_words(const PlannedMovement& m) {
  std::string text =
      m.is_two_tone()
          ? fmt::format("two tones, {:.3g} rad/s at most, {:.2f} .. {:.2f} rad", m.velocity, m.from,
                        m.to)
          : fmt::format("{:+.3g} rad/s from {:.2f} to {:.2f} rad", m.velocity, m.from, m.to);
  if (m.load_factor != 1) text += fmt::format(", {:g} times the load", m.load_factor);
  if (m.rest > 0) text += fmt::format(", after {:g} s at rest", m.rest);
  if (m.other_velocity > 0) text += ", the other joint moving";
  return text;
}

std::string weights_words(const std::vector<WeighedVerdict>& verdicts, std::size_t most) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < std::min(most, verdicts.size()); ++i) {
    parts.push_back(fmt::format("{} {:.3g}", verdicts[i].verdict, verdicts[i].weight));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string end_words(const Exploration& done, const loop::ExplorerOptions& options) {
  switch (done.end) {
    case ExplorationEnd::sure:
      return fmt::format("sure at the level {:g}, of effects from {:g} times the noise on",
                         options.alpha, options.smallest_effect);
    case ExplorationEnd::budget:
      return "not sure: the seconds are spent";
    case ExplorationEnd::nothing_tells:
      return "not sure: no movement that the limits and the seconds left allow tells more";
    case ExplorationEnd::stopped:
      return "not sure: stopped";
    case ExplorationEnd::failed:
      return "not sure: ended by a failure";
  }
  return {};
}

Json weights_json(const std::vector<WeighedVerdict>& verdicts) {
  Json out = Json::array();
  for (const WeighedVerdict& one : verdicts) {
    out.push_back({{"verdict", one.verdict}, {"weight", one.weight}});
  }
  return out;
}

Json movement_json(const PlannedMovement& m) {
  Json out = {{"kind", m.kind},
              {"velocity_rad_s", m.velocity},
              {"from_rad", m.from},
              {"to_rad", m.to},
              {"load_factor", m.load_factor},
              {"duration_s", m.duration},
              {"rest_s", m.rest},
              {"other_velocity_rad_s", m.other_velocity}};
  Json tones = Json::array();
  if (m.is_two_tone()) {
    for (const Tone& tone : m.tones) tones.push_back({tone.amplitude, tone.frequency});
  }
  out["tones_rad_Hz"] = tones;
  return out;
}

}  // namespace

SecondOpinion second_opinion(const Exploration& done, double gear_ratio) {
  SecondOpinion out;
  if (done.data.rows() == 0) return out;
  try {
    const loop::Observations data = loop::observe(done.data);
    loop::DiagnosisOptions options;
    if (gear_ratio > 0) options.gear_ratios = {gear_ratio};
    const loop::Diagnosis found = loop::diagnose(data, loop::coulomb_viscous_base, options);
    out.verdict = loop::verdict_name(found.verdict);
    for (const loop::EffectFinding& effect : found.effects) out.effects.push_back(effect.family);
    out.model = loop::formula_text(found.after, data);
  } catch (const Error&) {
    // Too little was recorded to fit the base: there is no second opinion.
  }
  return out;
}

std::string exploration_json(const Exploration& done, const SecondOpinion& second,
                             const loop::ExplorerOptions& options) {
  Json path = Json::array();
  for (const ExplorationStep& step : done.steps) {
    Json one = {{"movement", movement_json(step.movement)},
                {"seconds", step.cost_s},
                {"rows", step.rows},
                {"why", step.why},
                {"expected", step.expected}};
    if (step.looked) {
      one["verdicts"] = weights_json(step.verdicts);
      one["left"] = step.left;
    }
    path.push_back(std::move(one));
  }
  return write_json(Json{{"verdict", done.verdict},
                         {"families", done.families},
                         {"unknown", done.unknown},
                         {"inputs", done.inputs},
                         {"weight", done.weight},
                         {"log_e_value", done.log_e_value},
                         {"end", exploration_end_name(done.end)},
                         {"failure", done.failure},
                         {"seconds", done.seconds},
                         {"alpha", options.alpha},
                         {"smallest_effect", options.smallest_effect},
                         {"left", weights_json(done.left)},
                         {"untestable", done.untestable},
                         {"refused", done.refused},
                         {"second_opinion",
                          {{"verdict", second.verdict},
                           {"effects", second.effects},
                           {"model", second.model}}},
                         {"path", path}},
                    1) +
         "\n";
}

namespace {

bool names_the_same(const Exploration& done, const SecondOpinion& second) {
  const std::set<std::string> ours(done.families.begin(), done.families.end());
  return ours == std::set<std::string>(second.effects.begin(), second.effects.end());
}

std::string title_of(const Exploration& done, const SecondOpinion& second) {
  if (done.end == ExplorationEnd::sure) return fmt::format("What is missing: {}", done.verdict);
  if (done.verdict.empty()) return "Not sure what is missing";
  std::string title = fmt::format("Not sure what is missing: {} leads", done.verdict);
  if (second.verdict.empty() || names_the_same(done, second)) return title;
  const std::string said = fmt::format("{}", fmt::join(second.effects, "+"));
  return fmt::format("{}, the diagnosis says {}", title, said.empty() ? second.verdict : said);
}

}  // namespace

std::string exploration_terminal(const Exploration& done, const SecondOpinion& second,
                                 const loop::ExplorerOptions& options) {
  std::string text =
      done.verdict.empty()
          ? fmt::format("no verdict from {} movements: {}\n", done.steps.size(),
                        end_words(done, options))
          : fmt::format("{} (e-value {:.3g}, weight {:.4g}): {}\n", done.verdict,
                        elementary::exp(done.log_e_value), done.weight, end_words(done, options));
  text += fmt::format("  {} movements, {:.1f} s of motion, {} rows\n", done.steps.size(),
                      done.seconds, done.data.rows());
  if (!done.refused.empty()) {
    text += fmt::format("  {} movements were refused, the last: {}\n", done.refused.size(),
                        done.refused.back());
  }
  if (done.unknown) text += fmt::format("  it lives in {}\n", fmt::join(done.inputs, " x "));
  if (done.left.size() > 1) {
    text += fmt::format("  not excluded: {}\n", weights_words(done.left, kMostLeft));
  }
  if (!done.untestable.empty()) {
    text += fmt::format("  cannot be tested here: {}\n", fmt::join(done.untestable, ", "));
  }
  if (!second.verdict.empty()) {
    text += fmt::format("  the loop's diagnosis of these rows{}: {} {}\n",
                        names_the_same(done, second) ? "" : " says otherwise", second.verdict,
                        fmt::join(second.effects, " "));
  }
  return text;
}

std::string step_line(const ExplorationStep& step) {
  return fmt::format("{} ({:.1f} s){}", movement_words(step.movement), step.cost_s,
                     step.looked ? ": " + weights_words(step.verdicts, 3) : std::string());
}

std::string exploration_markdown(const Exploration& done, const SecondOpinion& second,
                                 const loop::ExplorerOptions& options) {
  std::string text = fmt::format("# {}\n\n{}\n", title_of(done, second),
                                 exploration_terminal(done, second, options));
  if (!done.failure.empty()) text += fmt::format("The failure: {}\n\n", done.failure);
  text += "| | movement | s | asked to tell apart | expected nats | what it told | left |\n";
  text += "|--:|---|--:|---|--:|---|--:|\n";
  for (std::size_t i = 0; i < done.steps.size(); ++i) {
    const ExplorationStep& step = done.steps[i];
    std::string why = step.why;
    for (std::size_t at = 0; (at = why.find('|', at)) != std::string::npos; at += 2) {
      why.insert(at, "\\");
    }
    text += fmt::format("| {} | {} | {:.1f} | {} | {} | {} | {} |\n", i + 1,
                        movement_words(step.movement), step.cost_s, why,
                        step.expected > 0 ? fmt::format("{:.1f}", step.expected) : "",
                        step.looked ? weights_words(step.verdicts, 3) : "",
                        step.looked ? fmt::format("{}", step.left) : "");
  }
  if (!second.model.empty()) {
    text += fmt::format("\nThe loop's refitted model: `{}`\n", second.model);
  }
  return without_tags(text);
}

}  // namespace tribench
