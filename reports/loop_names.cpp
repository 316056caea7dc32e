// SPDX-License-Identifier: MIT
//
// Names of families, symbols and quantities in words.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <regex>
#include <utility>

#include "reports/figures.hpp"
#include "reports/loop_words.hpp"

namespace tribench {
namespace {

const LoopFamily* find_family(const LoopRecord& record, std::string_view name) {
  const auto found = std::ranges::find(record.families, name, &LoopFamily::name);
  return found == record.families.end() ? nullptr : &*found;
}

std::string replaced(const std::string& text, const std::string& pattern, const std::string& by) {
  return std::regex_replace(text, std::regex(pattern), by);
}

std::string with_titles(const LoopRecord& record, std::string text) {
  for (const LoopFamily& family : record.families) {
    const std::string quoted = '\'' + family.name + '\'';
    for (std::size_t at = 0; (at = text.find(quoted, at)) != std::string::npos;) {
      text.replace(at, quoted.size(), family.title);
      at += family.title.size();
    }
    if (family.name.find('_') == std::string::npos) continue;
    text = replaced(text, "\\b" + family.name + "\\b", family.title);
  }
  return text;
}

}  // namespace

std::string spaced(std::string text) {
  std::ranges::replace(text, '_', ' ');
  return text;
}

std::string target_words(const LoopRecord& record) {
  std::string unit = record.unit;
  std::erase_if(unit, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
  if (unit.empty()) return spaced(record.target);
  return spaced(replaced(record.target, '_' + unit + "\\b", ""));
}

LoopUnit torque_unit(const LoopRecord& record) {
  return readable_unit(record.unit.empty() ? "N m" : record.unit, record.error.mae_before);
}

std::string family_title(const LoopRecord& record, std::string_view family) {
  const LoopFamily* known_family = find_family(record, family);
  return known_family == nullptr ? spaced(std::string(family)) : known_family->title;
}

std::string family_phrase(const LoopRecord& record, std::string_view name) {
  const LoopFamily* family = find_family(record, name);
  return family == nullptr || family->phrase.empty() ? family_title(record, name) : family->phrase;
}

std::string varying_term(const LoopRecord& record) {
  const std::string& term = record.leftover.varying.term;
  return term == "coulomb_friction" ? "Coulomb friction" : spaced(term);
}

std::string plain_text(const LoopRecord& record, std::string text) {
  text = replaced(text, R"( \((R[1-9](, )?)+\))", "");
  text = replaced(text, R"( \(--[^)]*\))", "");
  text = with_titles(record, std::move(text));
  const std::string& varying = record.leftover.varying.term;
  if (!varying.empty()) text = replaced(text, '\'' + varying + '\'', varying_term(record));
  for (const LoopExperiment& one : record.experiments) {
    text = replaced(text, "\\b" + one.code + "\\b", one.text);
  }
  // What is quoted or an option is the user's own and stays.
  std::string out;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\'') quoted = !quoted && text.find('\'', i + 1) != std::string::npos;
    const bool inside = i > 0 && i + 1 < text.size() &&
                        std::isalnum(static_cast<unsigned char>(text[i - 1])) != 0 &&
                        std::isalnum(static_cast<unsigned char>(text[i + 1])) != 0;
    out += text[i] == '_' && inside && !quoted ? ' ' : text[i];
  }
  return out;
}

std::string readable_formula(std::string formula) {
  formula = replaced(formula, R"(\bsgn_([A-Za-z0-9_]+))", "sgn($1)");
  return replaced(formula, R"(\+ -)", "- ");
}

std::string parameter_words(const LoopEffect& effect) {
  std::vector<std::string> parts;
  for (const LoopParameter& p : effect.parameters) {
    parts.push_back(p.low < p.high
                        ? fmt::format("{} = {} ({} .. {})", spaced(p.name),
                                      figure(p.value, kLoopDigits), figure(p.low), figure(p.high))
                        : fmt::format("{} = {}", spaced(p.name), figure(p.value, kLoopDigits)));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace tribench
