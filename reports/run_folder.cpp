// SPDX-License-Identifier: MIT
#include "reports/run_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>
#include <unordered_set>

#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/number_text.hpp"
#include "foundation/text.hpp"
#include "reports/record/record_csv.hpp"

namespace tribench {
namespace {

namespace fs = std::filesystem;

void add_complaints(RunFolder& run, std::string_view file, const CsvReading& reading) {
  for (const std::string& complaint : reading.complaints) {
    run.complaints.push_back(fmt::format("{}: {}", file, complaint));
  }
  if (reading.dropped > reading.complaints.size()) {
    run.complaints.push_back(
        fmt::format("{}: {} more rows dropped", file, reading.dropped - reading.complaints.size()));
  }
}

void read_records(RunFolder& run) {
  const fs::path file = run.path / "results.csv";
  if (!fs::exists(file)) {
    run.complaints.push_back(
        "results.csv is missing: no cell has ended, or the run was not "
        "closed; resume it or render it again");
    return;
  }
  const CsvReading reading =
      read_results(file, [&](Record&& record) { run.records.push_back(std::move(record)); });
  add_complaints(run, "results.csv", reading);
  std::stable_sort(run.records.begin(), run.records.end(), comes_before);
  const auto same = [](const Record& a, const Record& b) { return a.cell == b.cell; };
  const auto end = std::unique(run.records.begin(), run.records.end(), same);
  if (end != run.records.end()) {
    run.complaints.push_back(
        fmt::format("results.csv: {} cells stand there more than once; the "
                    "first is used",
                    run.records.end() - end));
    run.records.erase(end, run.records.end());
  }
}

void read_plan(RunFolder& run) {
  const fs::path file = run.path / "planned.csv";
  if (!fs::exists(file)) return;
  std::unordered_set<std::string_view> done;
  for (const Record& record : run.records) done.insert(record.cell);
  add_complaints(run, "planned.csv", read_planned(file, [&](PlannedCell&& cell) {
                   ++run.planned;
                   if (!done.contains(cell.cell)) run.missing.push_back(std::move(cell));
                 }));
}

void flatten(const std::string& prefix, const nlohmann::ordered_json& value,
             std::vector<std::pair<std::string, std::string>>& out) {
  if (value.is_object()) {
    for (const auto& [key, item] : value.items()) {
      flatten(prefix.empty() ? key : fmt::format("{}.{}", prefix, key), item, out);
    }
  } else if (value.is_array() && !value.empty()) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      flatten(fmt::format("{}.{}", prefix, i), value[i], out);
    }
  } else {
    out.emplace_back(prefix, value.is_string() ? value.get<std::string>() : write_json(value));
  }
}

void read_provenance(RunFolder& run) {
  const auto text = read_file_if_there(run.path / "provenance.json");
  if (!text) {
    run.complaints.push_back("provenance.json is missing: what made this run is not known");
    return;
  }
  const auto json = read_json<nlohmann::ordered_json>(*text);
  if (json.is_discarded()) {
    run.complaints.push_back("provenance.json is damaged: what made this run is not known");
    return;
  }
  flatten("", json, run.provenance);
}

// The value of a key in a table, as written; grid.toml is written by the program, so a line is
// enough.
std::string grid_value(const fs::path& file, std::string_view table, std::string_view key) {
  std::ifstream in = open_file_if_there(file);
  std::string line;
  bool is_inside = false;
  while (std::getline(in, line)) {
    if (line.starts_with("[")) is_inside = line == fmt::format("[{}]", table);
    const std::size_t equals = line.find('=');
    if (is_inside && equals != std::string::npos && trimmed(line.substr(0, equals)) == key) {
      return std::string(trimmed(line.substr(equals + 1)));
    }
  }
  return {};
}

std::string grid_name(const fs::path& file) {
  const std::string text = grid_value(file, "grid", "name");
  return text.size() < 2 ? std::string() : text.substr(1, text.size() - 2);  // in quotes
}

}  // namespace

std::size_t RunFolder::failed() const {
  return static_cast<std::size_t>(
      std::count_if(records.begin(), records.end(), [](const Record& r) { return !is_ok(r); }));
}

std::string RunFolder::provenance_of(const std::string& key) const {
  const auto found = std::find_if(provenance.begin(), provenance.end(),
                                  [&](const auto& entry) { return entry.first == key; });
  return found == provenance.end() ? std::string() : found->second;
}

RunFolder read_run_folder(const fs::path& folder) {
  const bool any = fs::exists(folder / "results.csv") || fs::exists(folder / "cells.jsonl") ||
                   fs::exists(folder / "grid.toml");
  if (!any) {
    throw_bad_input("holds neither results.csv nor cells.jsonl nor grid.toml", folder.string(),
                    "name the folder that 'tribench run --out' wrote");
  }
  RunFolder run;
  run.path = folder;
  read_records(run);
  read_plan(run);
  read_provenance(run);
  run.name = grid_name(folder / "grid.toml");
  run.budget = read_number<std::uint64_t>(grid_value(folder / "grid.toml", "budget", "evaluations"))
                   .value_or(0);
  if (run.name.empty()) run.name = fs::absolute(folder).lexically_normal().filename().string();
  return run;
}

}  // namespace tribench
