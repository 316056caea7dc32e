// SPDX-License-Identifier: MIT
#include "harness/study/loop_outcome.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "foundation/error.hpp"
#include "harness/study/runs_file.hpp"
#include "reports/csv.hpp"

namespace tribench {
namespace {

bool contains(const std::vector<std::string>& names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

bool overlaps(const LoopAnswer::Burst& claim, const PlantedCollision& burst,
              const std::vector<double>& time) {
  return claim.movement == burst.movement && claim.begin_s <= time[burst.last_row] &&
         claim.end_s >= time[burst.first_row];
}

bool names(const PlantedEffect& effect, const std::string& family) {
  return contains(effect.names, family);
}

// The planted effects that a library has and that none of the families names.
std::size_t count_unnamed(const std::vector<PlantedEffect>& effects,
                          const std::vector<std::string>& families) {
  return static_cast<std::size_t>(std::ranges::count_if(effects, [&](const PlantedEffect& effect) {
    return effect.in_library() &&
           std::ranges::none_of(families, [&](const auto& f) { return names(effect, f); });
  }));
}

bool belongs(const std::vector<PlantedEffect>& effects, const std::string& family) {
  return std::ranges::any_of(effects, [&](const PlantedEffect& effect) {
    return names(effect, family) || contains(effect.beside, family);
  });
}

// UNKNOWN in exactly the inputs in which the one effect lives.
bool is_located(const LoopAnswer& answer, const std::vector<PlantedEffect>& effects) {
  if (!answer.unknown || effects.size() != 1) return false;
  std::vector<std::string> wanted;
  for (const Role role : effects[0].lives_in) wanted.emplace_back(role_name(role));
  std::vector<std::string> named = answer.inputs;
  std::ranges::sort(wanted);
  std::ranges::sort(named);
  return wanted == named;
}

void judge_errors(LoopOutcome& out, const LoopAnswer& answer, const PlantedData& planted) {
  const std::vector<double>& target = planted.data.find(Role::friction_torque)->values;
  double rows = 0;
  for (std::size_t i = 0; i < target.size(); ++i) {
    if (!std::isfinite(answer.before[i]) || !std::isfinite(answer.after[i])) continue;
    out.mae_before += std::abs(target[i] - answer.before[i]);
    out.mae_after += std::abs(target[i] - answer.after[i]);
    out.mae_state +=
        std::abs(target[i] - (answer.with_state.empty() ? answer.after : answer.with_state)[i]);
    out.mae_noise += std::abs(planted.truth.noise[i]);
    rows += 1;
  }
  for (double* sum : {&out.mae_before, &out.mae_after, &out.mae_state, &out.mae_noise})
    *sum /= std::max(1.0, rows);
}

std::vector<std::string> split_list(std::string_view text) {
  std::vector<std::string> words;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(';'), text.size());
    words.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return words;
}

double number_in(std::string_view text) { return number_in_field(text, "runs.csv"); }

}  // namespace

std::size_t LoopOutcome::right() const {
  return static_cast<std::size_t>(std::ranges::count_if(
      planted, [&](const std::string& family) { return contains(claimed, family); }));
}

bool LoopOutcome::is_covered() const {
  return std::ranges::all_of(planted, [&](const std::string& family) {
    return contains(claimed, family) || contains(aliases, family);
  });
}

bool LoopOutcome::is_first_right() const {
  return !claimed.empty() && contains(planted, claimed[0]);
}

bool LoopOutcome::is_wrong() const { return claimed.size() > right() && !is_covered() && !unknown; }

std::string_view says_name(Says says) {
  constexpr std::array<std::string_view, kSays.size()> kNames = {
      "exact", "another_shape", "with_unknown", "with_more", "partly",
      "alias", "wrong",         "unknown",      "nothing"};
  return kNames[static_cast<std::size_t>(says)];
}

Says find_says(std::string_view name) {
  for (const Says says : kSays) {
    if (says_name(says) == name) return says;
  }
  throw_bad_input(fmt::format("'{}' is no answer of this study", name), "a list of runs",
                  "give --out a folder of its own");
}

Says judge_story(const LoopAnswer& answer, const std::vector<PlantedEffect>& effects) {
  std::vector<std::string> claimed;
  std::vector<std::string> covered;
  for (const LoopAnswer::Effect& effect : answer.effects) {
    claimed.push_back(effect.family);
    covered.push_back(effect.family);
    covered.insert(covered.end(), effect.aliases.begin(), effect.aliases.end());
  }
  const bool outside = !std::ranges::all_of(effects, &PlantedEffect::in_library);
  const bool none_wrong =
      std::ranges::all_of(claimed, [&](const auto& f) { return belongs(effects, f); });
  const std::size_t unnamed = count_unnamed(effects, claimed);
  if (unnamed == 0 && none_wrong && answer.unknown == outside) {
    const bool shaped = std::ranges::none_of(answer.effects, &LoopAnswer::Effect::another_shape);
    return shaped ? Says::exact : Says::another_shape;
  }
  const bool any_named = effects.size() > unnamed && !claimed.empty() && !outside;
  if (unnamed == 0 && any_named) return none_wrong ? Says::with_unknown : Says::with_more;
  if (answer.unknown) return Says::unknown;
  if (claimed.empty()) return Says::nothing;
  if (none_wrong) return Says::partly;
  return count_unnamed(effects, covered) == 0 && !outside && !effects.empty() ? Says::alias
                                                                              : Says::wrong;
}

LoopOutcome judge_answer(const LoopCase& one, const LoopAnswer& answer,
                         const PlantedData& planted) {
  LoopOutcome out;
  out.key = one.key();
  out.group = one.group;
  out.noise = one.noise;
  out.design = one.design;
  out.scale = one.scale;
  out.seed = one.seed;
  for (const PlantedEffect& effect : planted.truth.effects) {
    out.planted.push_back(effect.family);
    out.stiffness += effect.stiffness;
  }
  for (const LoopAnswer::Effect& effect : answer.effects) {
    out.claimed.push_back(effect.family);
    if (effect.stiffness > 0) {
      out.said_stiffness = effect.stiffness;
      out.said_low = effect.stiffness_low;
      out.said_high = effect.stiffness_high;
    }
    out.aliases.insert(out.aliases.end(), effect.aliases.begin(), effect.aliases.end());
  }
  out.unknown = answer.unknown;
  out.inputs = answer.inputs;
  out.says = judge_story(answer, planted.truth.effects);
  out.located = is_located(answer, planted.truth.effects);
  out.events = answer.bursts.size();
  out.bursts = planted.truth.collisions.size();
  const std::vector<double>& time = planted.data.find(Role::time)->values;
  for (const PlantedCollision& burst : planted.truth.collisions) {
    const bool found = std::ranges::any_of(answer.bursts, [&](const LoopAnswer::Burst& claim) {
      return overlaps(claim, burst, time);
    });
    out.bursts_found += found ? 1 : 0;
  }
  judge_errors(out, answer, planted);
  return out;
}

std::string outcome_row(const LoopOutcome& o) {
  const auto flag = [](bool value) { return std::string(value ? "1" : "0"); };
  const std::vector<std::string> fields = {o.key,
                                           o.group,
                                           o.noise,
                                           o.design,
                                           csv_number(o.scale),
                                           std::to_string(o.seed),
                                           fmt::format("{}", fmt::join(o.planted, ";")),
                                           fmt::format("{}", fmt::join(o.claimed, ";")),
                                           fmt::format("{}", fmt::join(o.aliases, ";")),
                                           flag(o.unknown),
                                           fmt::format("{}", fmt::join(o.inputs, ";")),
                                           std::to_string(o.events),
                                           std::to_string(o.bursts),
                                           std::to_string(o.bursts_found),
                                           csv_number(o.mae_before),
                                           csv_number(o.mae_after),
                                           csv_number(o.mae_noise),
                                           flag(o.naive.f_test),
                                           flag(o.naive.bic),
                                           std::string(says_name(o.says)),
                                           flag(o.located),
                                           csv_number(o.cpu_s),
                                           csv_number(o.mae_state),
                                           csv_number(o.stiffness),
                                           csv_number(o.said_stiffness),
                                           csv_number(o.said_low),
                                           csv_number(o.said_high)};
  std::string row;
  append_csv_row(row, fields);
  return row;
}

LoopOutcome read_outcome(std::span<const std::string_view> fields) {
  const auto count = [&](std::size_t at) {
    return static_cast<std::size_t>(number_in(fields[at]));
  };
  LoopOutcome o;
  o.key = fields[0];
  o.group = fields[1];
  o.noise = fields[2];
  o.design = fields[3];
  o.scale = number_in(fields[4]);
  o.seed = count(5);
  o.planted = split_list(fields[6]);
  o.claimed = split_list(fields[7]);
  o.aliases = split_list(fields[8]);
  o.unknown = fields[9] == "1";
  o.inputs = split_list(fields[10]);
  o.events = count(11);
  o.bursts = count(12);
  o.bursts_found = count(13);
  o.mae_before = number_in(fields[14]);
  o.mae_after = number_in(fields[15]);
  o.mae_noise = number_in(fields[16]);
  o.naive.f_test = fields[17] == "1";
  o.naive.bic = fields[18] == "1";
  o.says = find_says(fields[19]);
  o.located = fields[20] == "1";
  o.cpu_s = number_in(fields[21]);
  o.mae_state = number_in(fields[22]);
  o.stiffness = number_in(fields[23]);
  o.said_stiffness = number_in(fields[24]);
  o.said_low = number_in(fields[25]);
  o.said_high = number_in(fields[26]);
  return o;
}

}  // namespace tribench
