// SPDX-License-Identifier: MIT
#include "reports/record/record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "reports/record/record_columns.hpp"

namespace tribench {
namespace {

using std::string_view_literals::operator""sv;

// The words of each enumeration, in the order of its enumerators.
constexpr std::array kStatusWords = {"failed"sv, "ok"sv};
constexpr std::array kSingularityWords = {"proved_free"sv, "refuted"sv, "undecided"sv};
constexpr std::array kPhysicsWords = {"proved"sv, "refuted"sv, "undecided"sv};
constexpr std::array kGridCheckWords = {"seen"sv, "missed"sv};
constexpr std::array kFailureWords = {""sv,        "timeout"sv, "cpu_limit"sv,   "out_of_memory"sv,
                                      "crashed"sv, "error"sv,   "unsupported"sv, "quarantined"sv};
static_assert(kFailureWords.size() == static_cast<std::size_t>(FailureKind::other));

constexpr std::string_view kEndedByClock = "ended by the clock";
constexpr std::string_view kOverBudget = "over budget: ";
constexpr std::string_view kCpuSeconds = " CPU seconds";
constexpr std::string_view kBetweenNotes = "; ";

void add_to_note(Record& record, std::string_view text) {
  if (!record.note.empty()) record.note += kBetweenNotes;
  record.note += text;
}

// How much is another machine's affair, and the next run's: the same result says another number.
void forget_seconds_over_budget(std::string& note) {
  if (note.find(kOverBudget) == std::string::npos) return;
  std::string kept;
  for (std::size_t start = 0; start < note.size();) {
    const std::size_t end = std::min(note.find(kBetweenNotes, start), note.size());
    const std::string_view part = std::string_view(note).substr(start, end - start);
    start = end + kBetweenNotes.size();
    if (part.starts_with(kOverBudget) && part.ends_with(kCpuSeconds)) continue;
    if (!kept.empty()) kept += kBetweenNotes;
    kept += part;
  }
  note = std::move(kept);
}

template <typename Enum, std::size_t N>
std::string_view word_of(std::optional<Enum> value, const std::array<std::string_view, N>& words) {
  return value ? words[static_cast<std::size_t>(*value)] : std::string_view();
}

template <typename Enum, std::size_t N>
bool read_word(std::string_view text, const std::array<std::string_view, N>& words,
               std::optional<Enum>& value) {
  if (text.empty()) {
    value.reset();
    return true;
  }
  const auto found = std::ranges::find(words, text);
  if (found == words.end()) return false;
  value = static_cast<Enum>(found - words.begin());
  return true;
}

// Errors below what rounding makes of a target are none, and what differs in the last digits is the
// same: a formula is no better for the order in which it was summed.
constexpr double kRoundingPercent = 1e-10;
constexpr int kPlacedDigits = 10;

}  // namespace

double placing_error(const Record& record) {
  if (!is_ok(record) || std::isnan(record.mae_test)) {
    return std::numeric_limits<double>::infinity();
  }
  if (record.relative_error_test <= kRoundingPercent) return 0;
  return std::stod(fmt::format("{:.{}e}", record.mae_test, kPlacedDigits - 1));
}

std::string_view record_word(std::optional<CellStatus> value) {
  return word_of(value, kStatusWords);
}

std::string_view record_word(std::optional<Singularity> value) {
  return word_of(value, kSingularityWords);
}

std::string_view record_word(std::optional<PhysicsProof> value) {
  return word_of(value, kPhysicsWords);
}

std::string_view record_word(std::optional<GridCheck> value) {
  return word_of(value, kGridCheckWords);
}

bool read_record_word(std::string_view text, std::optional<CellStatus>& value) {
  return read_word(text, kStatusWords, value);
}

bool read_record_word(std::string_view text, std::optional<Singularity>& value) {
  return read_word(text, kSingularityWords, value);
}

bool read_record_word(std::string_view text, std::optional<PhysicsProof>& value) {
  return read_word(text, kPhysicsWords, value);
}

bool read_record_word(std::string_view text, std::optional<GridCheck>& value) {
  return read_word(text, kGridCheckWords, value);
}

std::string reason_text(const FailureReason& reason) {
  if (reason.kind == FailureKind::other) return reason.detail;
  std::string text(kFailureWords[static_cast<std::size_t>(reason.kind)]);
  if (!reason.detail.empty()) text += " (" + reason.detail + ")";
  return text;
}

FailureReason read_reason(std::string_view text) {
  for (std::size_t i = 0; i < kFailureWords.size(); ++i) {
    const std::string_view word = kFailureWords[i];
    if (text == word) return {static_cast<FailureKind>(i), {}};
    if (word.empty() || !text.starts_with(word)) continue;
    const std::string_view rest = text.substr(word.size());
    if (rest.size() > 3 && rest.starts_with(" (") && rest.ends_with(')')) {
      return {static_cast<FailureKind>(i), std::string(rest.substr(2, rest.size() - 3))};
    }
  }
  return {FailureKind::other, std::string(text)};
}

bool is_limit(FailureKind kind) {
  return kind == FailureKind::timeout || kind == FailureKind::cpu_limit ||
         kind == FailureKind::out_of_memory;
}

void mark_failed(Record& record, FailureKind kind, std::string detail) {
  record.status = CellStatus::failed;
  record.reason = {kind, std::move(detail)};
}

void add_costs(Record& record, const Record& further) {
  record.fit_cpu_s += further.fit_cpu_s;
  record.fit_wall_s += further.fit_wall_s;
  record.evaluations += further.evaluations;
  record.fit_instructions += further.fit_instructions;
  record.peak_memory_mib = std::max(record.peak_memory_mib, further.peak_memory_mib);
  if (was_ended_by_clock(further) && !was_ended_by_clock(record)) note_end_by_clock(record);
}

void note_end_by_clock(Record& record) {
  add_to_note(record, fmt::format("{}: not reproducible", kEndedByClock));
}

void note_overspending(Record& record, double seconds, std::uint64_t evaluations) {
  constexpr double kTolerated = 1.1;
  constexpr double kLeastSeconds = 0.5;  // starting and ending take some
  const double spent_s = record.fit_cpu_s;
  if (spent_s > kTolerated * seconds && spent_s > seconds + kLeastSeconds) {
    add_to_note(record,
                fmt::format("{}{:.1f} of {:g}{}", kOverBudget, spent_s, seconds, kCpuSeconds));
  }
  const auto spent = static_cast<double>(record.evaluations);
  if (spent > kTolerated * static_cast<double>(evaluations)) {
    add_to_note(record, fmt::format("{}{} of {} evaluations", kOverBudget, record.evaluations,
                                    evaluations));
  }
}

bool was_ended_by_clock(const Record& record) {
  return record.note.find(kEndedByClock) != std::string::npos;
}

void forget_costs(Record& record) {
  for (const RecordColumn<Record>& column : result_columns()) {
    if (column.rules.is_cost) record.*std::get<double Record::*>(column.member) = kMissing;
  }
  forget_seconds_over_budget(record.note);
}

}  // namespace tribench
