// SPDX-License-Identifier: MIT
//
// The closed loop's answer on a terminal, in the order of the page.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "reports/loop_words.hpp"

namespace tribench {
namespace {

constexpr std::size_t kMostLines = 12;
constexpr std::size_t kMostEffects = 6;  // a line each

constexpr std::string_view kBold = "\033[1m";
constexpr std::string_view kGreen = "\033[32m";
constexpr std::string_view kYellow = "\033[33m";
constexpr std::string_view kSoft = "\033[2m";
constexpr std::string_view kEnd = "\033[0m";

std::string painted(std::string_view text, std::string_view code, bool colour) {
  return colour ? fmt::format("{}{}{}", code, text, kEnd) : std::string(text);
}

std::string_view grade_colour(const std::string& grade) {
  return grade == "very sure" || grade == "sure" ? kGreen : kYellow;
}

std::vector<std::string> effect_lines(const LoopWords& words, bool colour) {
  std::size_t wide = 0;
  std::size_t amount = 0;
  std::size_t share = 0;
  for (const LoopCard& card : words.cards) {
    wide = std::max(wide, card.noun.size());
    amount = std::max(amount, card.amount.size());
    share = std::max(share, card.share.size());
  }
  std::vector<std::string> lines;
  for (const LoopCard& card : words.cards) {
    if (lines.size() + 1 == kMostEffects && words.cards.size() > kMostEffects) {
      lines.push_back(fmt::format("  and {} more", words.cards.size() - lines.size()));
      break;
    }
    lines.push_back(fmt::format("  {:<{}}  {:>{}}  {:>{}}  {}", card.noun, wide, card.amount,
                                amount, card.share, share,
                                painted(card.grade, grade_colour(card.grade), colour)));
  }
  return lines;
}

// "Cannot be tested here: 10 effects (no gravity torque; no reversal)."
std::string untestable_line(const LoopRecord& record) {
  std::vector<std::string> reasons;
  for (const LoopUntestable& one : record.untestable) {
    const std::string reason = plain_text(record, one.reason);
    if (std::ranges::count(reasons, reason) == 0) reasons.push_back(reason);
  }
  const std::size_t more = reasons.size() > 2 ? reasons.size() - 2 : 0;
  reasons.resize(reasons.size() - more);
  return fmt::format("Cannot be tested here: {} effect{} ({}{}).", record.untestable.size(),
                     record.untestable.size() == 1 ? "" : "s", fmt::join(reasons, "; "),
                     more > 0 ? "; ..." : "");
}

}  // namespace

std::string loop_terminal(const LoopRecord& record, bool colour) {
  const LoopWords words = loop_words(record);
  std::vector<std::string> lines = {painted(words.headline, kBold, colour), words.error};
  const std::vector<std::string> effects = effect_lines(words, colour);
  lines.insert(lines.end(), effects.begin(), effects.end());
  for (const std::string* one : {&words.leftover, &words.unused, &words.detectable}) {
    if (!one->empty()) lines.push_back(*one);
  }
  for (std::size_t i = 1; i < words.needed.size() && i < 3; ++i) {
    lines.push_back(fmt::format("Also needed: {}.", words.needed[i]));
  }
  std::string next = words.next;
  if (!next.empty()) next[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(next[0])));
  lines.push_back("Next: " + next);
  if (!record.untestable.empty()) lines.push_back(painted(untestable_line(record), kSoft, colour));
  if (!words.remarks.empty()) {
    const std::size_t more = words.remarks.size() - 1;
    lines.push_back(
        painted(more == 0 ? words.remarks[0]
                          : fmt::format("{} ({} more remarks in loop.md)", words.remarks[0], more),
                kSoft, colour));
  }
  if (lines.size() > kMostLines) lines.resize(kMostLines);
  return fmt::format("{}\n", fmt::join(lines, "\n"));
}

}  // namespace tribench
