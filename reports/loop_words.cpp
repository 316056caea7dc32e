// SPDX-License-Identifier: MIT
#include "reports/loop_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "reports/figures.hpp"

namespace tribench {
namespace {

using nlohmann::json;
using Words = std::pair<std::string_view, std::string_view>;

constexpr std::array<Words, 18> kFamilies = {{
    {"asymmetry", "a difference between the two directions"},
    {"stribeck", "the Stribeck effect (friction falls as motion starts)"},
    {"nonlinear_viscous", "viscous friction that is not linear in velocity"},
    {"load_coulomb", "Coulomb friction that grows with load"},
    {"load_viscous", "viscous friction that grows with load"},
    {"power_quadrant_gain",
     "friction that differs between driving and back-driving, in "
     "proportion to the load"},
    {"power_quadrant_step", "friction that steps where the load changes sign"},
    {"payload", "an error of payload or gravity model"},
    {"output_ripple", "ripple once or a few times per turn of the link"},
    {"gear_ripple", "ripple of the gear"},
    {"temperature", "temperature"},
    {"drift", "a drift through the campaign"},
    {"hysteresis", "hysteresis after a reversal (presliding)"},
    {"lag", "friction that lags behind velocity"},
    {"inertia", "an error of inertia"},
    {"coupling", "coupling to other joints"},
    {"offset", "a constant offset"},
    {"backlash", "backlash of the gear"},
}};

constexpr std::array<Words, 9> kMovements = {{
    {"R1", "repeat at least 5 settings twice, hours apart"},
    {"R2", "drive both directions over the same stroke and posture"},
    {"R3", "drive in two postures, or with a known payload"},
    {"R4", "drive reversals and a multisine that covers velocity and acceleration"},
    {"R5", "drive in random order with one cool-down"},
    {"R6", "drive slow passes with 20 samples a gear ripple at least"},
    {"R7", "move the other joints one at a time, in 20 separate stretches"},
    {"R8", "hold still, approached from both sides"},
    {"R9", "record 30 movements at least"},
}};

template <std::size_t N>
std::string_view words_for(const std::array<Words, N>& words, std::string_view name) {
  for (const auto& [key, text] : words) {
    if (key == name) return text;
  }
  return {};
}

std::string alias_clause(const json& effect) {
  std::vector<std::string> exact;
  std::vector<std::string> near;
  for (const json& alias : items_of(effect, "alias")) {
    const std::string words = family_words(text_of(alias, "family"));
    const bool is_exact = flag_of(alias, "exact");
    const std::string ask = is_exact ? text_of(alias, "separate_by") : std::string();
    (is_exact ? exact : near)
        .push_back(ask.empty()
                       ? words
                       : fmt::format("{} (to settle that: {})", words, movement_words(ask)));
  }
  std::string text;
  if (!exact.empty()) {
    text +=
        fmt::format(" In these data it cannot be told from {} at all.", fmt::join(exact, " or "));
  }
  if (!near.empty()) text += fmt::format(" It could also be {}.", fmt::join(near, " or "));
  return text;
}

std::string request_clause(const json& effect) {
  std::vector<std::string> requests;
  for (const json& request : items_of(effect, "separate_by")) {
    if (request.is_string()) requests.push_back(movement_words(request.get<std::string>()));
  }
  return requests.empty() ? std::string()
                          : fmt::format(" To settle it: {}.", fmt::join(requests, "; "));
}

std::string unit_of(const json& loop) {
  const std::string unit = text_of(member_of(loop, "pictures"), "unit");
  return unit.empty() ? "N m" : unit;
}

}  // namespace

double number_of(const json& object, const char* key) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  if (!object.is_object() || found == object.end() || !found->is_number()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return found->get<double>();
}

double element_of(const json& array, std::size_t i) {
  if (!array.is_array() || i >= array.size() || !array[i].is_number()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return array[i].get<double>();
}

std::string text_of(const json& object, const char* key) {
  if (!object.is_object()) return {};
  const auto found = object.find(key);
  if (found == object.end() || found->is_null()) return {};
  if (found->is_string()) return found->get<std::string>();
  return found->is_number_float() ? figure(found->get<double>()) : found->dump();
}

json items_of(const json& object, const char* key) {
  if (!object.is_object() || !object.contains(key) || !object[key].is_array()) return json::array();
  return object[key];
}

json member_of(const json& object, const char* key) {
  if (!object.is_object() || !object.contains(key) || !object[key].is_object()) {
    return json::object();
  }
  return object[key];
}

bool flag_of(const json& object, const char* key) {
  return object.is_object() && object.contains(key) && object[key].is_boolean() &&
         object[key].get<bool>();
}

std::string family_words(std::string_view family) {
  const std::string_view words = words_for(kFamilies, family);
  return std::string(words.empty() ? family : words);
}

std::string movement_words(std::string_view request) {
  const std::string_view words = words_for(kMovements, request);
  return words.empty() ? std::string(request) : fmt::format("{} ({})", words, request);
}

std::string parameters_of(const json& effect) {
  std::vector<std::string> parts;
  for (const json& parameter : items_of(effect, "params")) {
    parts.push_back(fmt::format(
        "{} = {} ({} .. {})", text_of(parameter, "name"), figure(number_of(parameter, "value")),
        figure(number_of(parameter, "lo")), figure(number_of(parameter, "hi"))));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string closed_share(const json& error) {
  const double low = number_of(error, "closed_fraction");
  if (std::isnan(low)) return {};
  const double high = number_of(error, "closed_fraction_high");
  std::string text = fmt::format("{:.0f} %", 100 * low);
  if (!std::isnan(high) && std::lround(100 * high) > std::lround(100 * low)) {
    text = fmt::format("{:.0f} .. {:.0f} %", 100 * low, 100 * high);
  }
  const json interval = items_of(error, "closed_fraction_ci");
  const double from = element_of(interval, 0);
  const double to = element_of(interval, 1);
  if (std::isnan(from) || std::isnan(to)) return text;
  return fmt::format("{} (the lower figure's 95 % interval: {:.0f} .. {:.0f} %)", text, 100 * from,
                     100 * to);
}

namespace {

// The sizes from which on effects would have shown.
std::string detectable_clause(const json& loop) {
  std::vector<std::string> sizes;
  for (const json& one : items_of(loop, "candidates")) {
    const double size = number_of(one, "detectable");
    if (std::isnan(size)) continue;
    sizes.push_back(
        fmt::format("{} above {} {}", text_of(one, "family"), figure(size, 2), unit_of(loop)));
  }
  if (sizes.empty()) return {};
  return fmt::format(" Would have shown (root mean square): {}.", fmt::join(sizes, ", "));
}

std::vector<std::string> texts_of(const json& object, const char* key) {
  std::vector<std::string> all;
  for (const json& item : items_of(object, key)) {
    if (item.is_string()) all.push_back(item.get<std::string>());
  }
  return all;
}

}  // namespace

std::string verdict_sentence(const json& loop) {
  const std::string verdict = text_of(loop, "verdict");
  const std::size_t count = items_of(loop, "effects").size();
  if (verdict == "NONE" && loop.contains("candidates") && items_of(loop, "candidates").empty()) {
    return "Nothing is claimed: these data can test none of the effects.";
  }
  if (verdict == "CANNOT_TELL") {
    return fmt::format("These data cannot tell: nothing in them can be tested. Needed: {}.",
                       fmt::join(texts_of(loop, "needed"), "; "));
  }
  if (verdict == "NONE") {
    return (items_of(loop, "untestable").empty()
                ? "Nothing is missing: the residual shows no structure."
                : "Nothing is missing that these data can show: the residual has no structure.") +
           detectable_clause(loop);
  }
  const json error = member_of(loop, "error");
  const bool denied = error.contains("confirmed") && !flag_of(error, "confirmed");
  const std::string doubt = denied ? " The held-out movements do not confirm it." : "";
  if (verdict == "EFFECTS") {
    return (count == 1 ? "One effect was missing and has been added."
                       : fmt::format("{} effects were missing and have been added.", count)) +
           doubt;
  }
  if (verdict == "UNKNOWN") {
    return count == 0 ? "Something is missing that is none of the known effects."
                      : fmt::format(
                            "{} added, and something is still missing that is none of the "
                            "known effects.",
                            count == 1 ? "One effect was" : fmt::format("{} effects were", count)) +
                            doubt;
  }
  return verdict.empty() ? "No verdict was reached." : fmt::format("Verdict: {}.", verdict);
}

std::string effect_sentence(const json& effect, const json& loop) {
  const std::string family = text_of(effect, "family");
  std::string text = fmt::format("**{}**, {}:", family, family_words(family));
  const double rms = number_of(effect, "rms_contribution");
  if (!std::isnan(rms)) text += fmt::format(" contributes {} {} rms", figure(rms), unit_of(loop));
  const std::string parameters = parameters_of(effect);
  if (!parameters.empty()) text += fmt::format(", with {} at 95 %", parameters);
  const double p = number_of(effect, "p_adj");
  if (!std::isnan(p)) text += fmt::format("; p = {} after correction for the search", figure(p, 2));
  const std::string objection = text_of(effect, "not_physical");
  if (!objection.empty()) {
    text += fmt::format("; not physical ({}), so that it stands for something else", objection);
  } else if (flag_of(effect, "provisional")) {
    text += "; provisional, because it shares an input with what is still unexplained";
  }
  for (const json& note : items_of(effect, "notes")) {
    if (note.is_string()) text += "; " + note.get<std::string>();
  }
  const double share = number_of(effect, "chosen_share");
  if (!std::isnan(share)) {
    text +=
        fmt::format("; chosen in {:.0f} % of the searches with movements left out", 100 * share);
  }
  return text + '.' + alias_clause(effect) + request_clause(effect);
}

std::string leftover_sentence(const json& loop) {
  const json leftover = member_of(loop, "leftover");
  const json inputs = items_of(leftover, "inputs");
  if (text_of(loop, "verdict") != "UNKNOWN" || inputs.empty()) return {};
  std::vector<std::string> names;
  for (const json& input : inputs) {
    if (input.is_string()) names.push_back(input.get<std::string>());
  }
  const double p = number_of(leftover, "p");
  // An effect whose parameters are not physical fits there, and so leaves nothing to be tested.
  if (p > number_of(member_of(loop, "alpha"), "gen")) {
    return fmt::format(
        "What is missing depends on **{}**: an effect fits there that cannot be "
        "physical.",
        fmt::join(names, " and "));
  }
  return fmt::format("What is still unexplained depends on **{}** (p = {}).",
                     fmt::join(names, " and "), figure(p, 2));
}

std::vector<std::string> untestable_sentences(const json& loop) {
  std::vector<std::string> all;
  for (const json& item : items_of(loop, "untestable")) {
    const std::string ask = text_of(item, "ask");
    all.push_back(
        fmt::format("{}: {}.{}", family_words(text_of(item, "family")), text_of(item, "reason"),
                    ask.empty() ? "" : fmt::format(" To test it: {}.", movement_words(ask))));
  }
  return all;
}

std::vector<std::string> aliased_sentences(const json& loop) {
  std::vector<std::string> all;
  for (const json& item : items_of(loop, "aliased")) {
    const json families = items_of(item, "families");
    if (families.size() != 2 || !families[0].is_string() || !families[1].is_string()) continue;
    const std::string ask = text_of(item, "separate_by");
    all.push_back(fmt::format(
        "{} and {} (correlation {}).{}", family_words(families[0].get<std::string>()),
        family_words(families[1].get<std::string>()), figure(number_of(item, "corr")),
        ask.empty() ? "" : fmt::format(" To tell them apart: {}.", movement_words(ask))));
  }
  return all;
}

std::vector<std::string> event_sentences(const json& loop) {
  std::vector<std::string> all;
  for (const json& event : items_of(loop, "events")) {
    const std::string name = text_of(event, "movement_name");
    all.push_back(fmt::format("movement {}, {} to {} s, peak {} {}",
                              name.empty() ? text_of(event, "movement") : name,
                              figure(number_of(event, "t0")), figure(number_of(event, "t1")),
                              figure(number_of(event, "peak")), unit_of(loop)));
  }
  return all;
}

std::vector<std::string> remarks(const json& loop) {
  std::vector<std::string> all;
  for (const char* key : {"warnings", "notes"}) {
    for (const json& remark : items_of(loop, key)) {
      if (remark.is_string()) all.push_back(remark.get<std::string>() + '.');
    }
  }
  return all;
}

}  // namespace tribench
