// SPDX-License-Identifier: MIT
#include "reports/record/record_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "reports/record/record_columns.hpp"

namespace tribench {
namespace {

using nlohmann::json;

template <typename Json, typename Value>
Json value_json(const Value& value) {
  if constexpr (std::is_floating_point_v<Value>) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
  } else if constexpr (std::is_arithmetic_v<Value>) {
    return value;
  } else {
    return field_text(value);
  }
}

template <typename Json, typename Row>
Json field_json(const Row& row, const RecordColumn<Row>& column) {
  return std::visit([&](auto member) { return value_json<Json>(row.*member); }, column.member);
}

[[noreturn]] void refuse(const json& field, const char* name) {
  throw Error(ErrorKind::failed, fmt::format("{} is not a value of {}", write_json(field), name));
}

template <typename Value>
void read_value(const json& object, const char* name, Value& value) {
  const json& field = object.at(name);
  if constexpr (std::is_floating_point_v<Value>) {
    value = field.is_null() ? kMissing : field.get<double>();
  } else if constexpr (std::is_same_v<Value, bool>) {
    value = field.get<bool>();
  } else if constexpr (std::is_arithmetic_v<Value>) {
    const auto whole = json_whole_number<Value>(field);
    if (!whole) refuse(field, name);
    value = *whole;
  } else if (!read_field_text(field.get_ref<const std::string&>(), value)) {
    refuse(field, name);
  }
}

// The columns from `first` on, as one object.
template <typename Row>
json object_of(const Row& row, std::span<const RecordColumn<Row>> columns, std::size_t first) {
  json object = json::object();
  for (const RecordColumn<Row>& column : columns.subspan(first)) {
    json value = field_json<json>(row, column);
    if (column.rules.only_where_known && value.is_null()) continue;
    object[column.name] = std::move(value);
  }
  return object;
}

template <typename Row>
Row row_of(const json& object, std::span<const RecordColumn<Row>> columns, std::size_t first) {
  Row row;
  for (const RecordColumn<Row>& column : columns.subspan(first)) {
    if (column.rules.may_be_absent && !object.contains(column.name)) continue;
    std::visit([&](auto member) { read_value(object, column.name, row.*member); }, column.member);
  }
  return row;
}

}  // namespace

json record_json(const Record& record) { return object_of(record, result_columns(), 0); }
json front_json(const FrontRecord& front) { return object_of(front, front_columns(), 1); }
json trace_json(const TraceRecord& trace) { return object_of(trace, trace_columns(), 1); }

Record parse_record(const json& object) { return row_of(object, result_columns(), 0); }

FrontRecord parse_front(const json& object, const std::string& cell) {
  FrontRecord front = row_of(object, front_columns(), 1);
  front.cell = cell;
  return front;
}

TraceRecord parse_trace(const json& object, const std::string& cell) {
  TraceRecord trace = row_of(object, trace_columns(), 1);
  trace.cell = cell;
  return trace;
}

nlohmann::ordered_json record_row(const Record& record, const std::vector<std::string>& columns) {
  using nlohmann::ordered_json;
  ordered_json row = ordered_json::array();
  for (const std::string& name : columns) {
    const auto all = result_columns();
    const auto column = std::ranges::find(all, name, &RecordColumn<Record>::name);
    if (column == all.end()) throw Error(ErrorKind::failed, "no column of records", name);
    const bool has_none = column->rules.needs_formula && record.formula.empty();
    row.push_back(has_none ? ordered_json(nullptr) : field_json<ordered_json>(record, *column));
  }
  return row;
}

}  // namespace tribench
