// SPDX-License-Identifier: MIT
#include "harness/study/loop_outcome.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "foundation/error.hpp"
#include "problems/friction/planted_effects.hpp"
#include "reports/csv.hpp"

namespace tribench {
namespace {

bool contains(const std::vector<std::string>& names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

bool overlaps(const LoopAnswer::Burst& claim, const kuka::PlantedCollision& burst,
              const std::vector<double>& time) {
  return claim.movement == burst.movement && claim.begin_s <= time[burst.last_row] &&
         claim.end_s >= time[burst.first_row];
}

std::size_t in_library(const std::vector<std::string>& planted) {
  return static_cast<std::size_t>(std::ranges::count_if(
      planted, [](const std::string& family) { return find_planted_shape(family).in_library; }));
}

void judge_errors(LoopOutcome& out, const LoopAnswer& answer, const kuka::PlantedData& planted) {
  const std::vector<double>& target = planted.data.find(Role::friction_torque)->values;
  double rows = 0;
  for (std::size_t i = 0; i < target.size(); ++i) {
    if (!std::isfinite(answer.before[i]) || !std::isfinite(answer.after[i])) continue;
    out.mae_before += std::abs(target[i] - answer.before[i]);
    out.mae_after += std::abs(target[i] - answer.after[i]);
    out.mae_noise += std::abs(planted.truth.noise[i]);
    rows += 1;
  }
  for (double* sum : {&out.mae_before, &out.mae_after, &out.mae_noise}) *sum /= std::max(1.0, rows);
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

double number_in(std::string_view text) {
  double value = 0;
  if (!read_csv_number(text, value)) {
    throw_bad_input(fmt::format("'{}' is no number", text), "runs.csv",
                    "give --out a folder of its own");
  }
  return value;
}

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

bool LoopOutcome::is_exact() const {
  const std::size_t known = in_library(planted);
  return right() == known && claimed.size() == known && unknown == (known < planted.size());
}

bool LoopOutcome::is_wrong() const { return claimed.size() > right() && !is_covered() && !unknown; }

bool LoopOutcome::is_located() const {
  if (!unknown || planted.size() != 1) return false;
  std::vector<std::string> wanted;
  for (const Role role : find_planted_shape(planted[0]).lives_in) {
    wanted.emplace_back(role_name(role));
  }
  std::vector<std::string> named = inputs;
  std::ranges::sort(wanted);
  std::ranges::sort(named);
  return wanted == named;
}

LoopOutcome judge_answer(const LoopCase& one, const LoopAnswer& answer,
                         const kuka::PlantedData& planted) {
  LoopOutcome out;
  out.key = one.key();
  out.group = one.group;
  out.scale = one.scale;
  out.seed = one.seed;
  for (const kuka::PlantedEffect& effect : planted.truth.effects) {
    out.planted.push_back(effect.family);
  }
  for (const LoopAnswer::Effect& effect : answer.effects) {
    out.claimed.push_back(effect.family);
    out.aliases.insert(out.aliases.end(), effect.aliases.begin(), effect.aliases.end());
  }
  out.unknown = answer.unknown;
  out.inputs = answer.inputs;
  out.events = answer.bursts.size();
  out.bursts = planted.truth.collisions.size();
  const std::vector<double>& time = planted.data.find(Role::time)->values;
  for (const kuka::PlantedCollision& burst : planted.truth.collisions) {
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
                                           flag(o.is_exact()),
                                           csv_number(o.cpu_s)};
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
  o.scale = number_in(fields[2]);
  o.seed = count(3);
  o.planted = split_list(fields[4]);
  o.claimed = split_list(fields[5]);
  o.aliases = split_list(fields[6]);
  o.unknown = fields[7] == "1";
  o.inputs = split_list(fields[8]);
  o.events = count(9);
  o.bursts = count(10);
  o.bursts_found = count(11);
  o.mae_before = number_in(fields[12]);
  o.mae_after = number_in(fields[13]);
  o.mae_noise = number_in(fields[14]);
  o.naive.f_test = fields[15] == "1";
  o.naive.bic = fields[16] == "1";
  o.cpu_s = number_in(fields[18]);
  return o;
}

}  // namespace tribench
