// SPDX-License-Identifier: MIT
//
// The one table of each kind of row: the names of its columns, where their values live and how they
// are written. CSV, JSON, journal and page are made from it, so that a new figure is a member of
// the row and a line here.
//
// Not for reading a record: its members are there for that.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "reports/record/record.hpp"

namespace tribench {

// Numbers and flags are written as such; everything from FailureReason on is text (field_text).
template <typename Row>
using RecordMember =
    std::variant<int Row::*, bool Row::*, std::uint64_t Row::*, double Row::*, std::string Row::*,
                 FailureReason Row::*, std::optional<CellStatus> Row::*,
                 std::optional<Singularity> Row::*, std::optional<PhysicsProof> Row::*,
                 std::optional<GridCheck> Row::*>;

struct ColumnRules {
  bool is_cost = false;           // decided by time and machine (a double)
  bool needs_formula = false;     // empty in CSV where the row has no formula
  bool may_be_absent = false;     // from JSON: older programs did not write it
  bool only_where_known = false;  // in JSON: few rows have it, the others stay as they were
};

template <typename Row>
struct RecordColumn {
  const char* name;
  RecordMember<Row> member;
  ColumnRules rules = {};
};

// In the order of the files.
std::span<const RecordColumn<Record>> result_columns();
std::span<const RecordColumn<FrontRecord>> front_columns();
std::span<const RecordColumn<TraceRecord>> trace_columns();
std::span<const RecordColumn<CurveRecord>> curve_columns();
std::span<const RecordColumn<PlannedCell>> planned_columns();

// A value that is written as text, and its reading; false where the text is none of its words.
inline std::string field_text(const std::string& value) { return value; }
inline std::string field_text(const FailureReason& value) { return reason_text(value); }
template <typename Enum>
std::string field_text(const std::optional<Enum>& value) {
  return std::string(record_word(value));
}

inline bool read_field_text(std::string_view text, std::string& value) {
  value.assign(text);
  return true;
}
inline bool read_field_text(std::string_view text, FailureReason& value) {
  value = read_reason(text);
  return true;
}
template <typename Enum>
bool read_field_text(std::string_view text, std::optional<Enum>& value) {
  return read_record_word(text, value);
}

}  // namespace tribench
