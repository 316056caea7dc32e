// SPDX-License-Identifier: MIT
//
// Files from the disk, one or several as one campaign.
#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "foundation/error.hpp"
#include "problems/reading/csv.hpp"
#include "problems/reading/file_text.hpp"
#include "problems/reading/recording_scales.hpp"

namespace tribench {

DataFile read_csv(const std::filesystem::path& file, const CsvOptions& options) {
  const std::string text = read_file_text(file);
  return parse_csv(text, file.string(), options);
}

namespace {

void check_same_channels(const DataFile& all, const DataFile& next, std::string_view file) {
  const auto names = [](const DataFile& reading) {
    std::vector<std::string> list;
    for (const Channel& channel : reading.data.channels) list.push_back(channel.name);
    for (const TextColumn& column : reading.texts) list.push_back(column.name + " (text)");
    return list;
  };
  if (names(all) == names(next)) return;
  throw_bad_input(fmt::format("its columns ({}) are not those of the first file ({})",
                              fmt::join(names(next), ", "), fmt::join(names(all), ", ")),
                  file, "give files with the same columns in the same order");
}

bool knows_unit(const DataFile& file, const std::string& column) {
  return std::ranges::any_of(file.readings, [&](const ColumnReading& reading) {
    return reading.column == column && !reading.unit.empty() && !reading.unit_asked;
  });
}

// Numbers of which one file knows the unit and the other does not may be 57.3 times too large.
void check_same_units(const DataFile& all, const DataFile& next, std::string_view file) {
  for (std::size_t j = 0; j < all.data.channels.size(); ++j) {
    const Channel& first = all.data.channels[j];
    const Channel& other = next.data.channels[j];
    const bool is_same = first.unit == other.unit && first.role == other.role &&
                         knows_unit(all, first.name) == knows_unit(next, other.name);
    if (is_same) continue;
    const auto meaning = [](const DataFile& of, const Channel& channel) {
      return fmt::format("{} in {}", role_name(channel.role),
                         knows_unit(of, channel.name) ? "'" + channel.unit + "'"
                                                      : std::string("a unit that is not named"));
    };
    throw_bad_input(fmt::format("'{}' is {}, and in the first file {}", other.name,
                                meaning(next, other), meaning(all, first)),
                    file,
                    fmt::format("say what it is in both: --roles '{}=ROLE[UNIT]'", other.name));
  }
}

void drop_spare_channels(DataFile& file) {
  std::erase_if(file.data.channels, [&](const Channel& channel) {
    return std::ranges::count(file.spare, channel.name) > 0;
  });
  file.spare.clear();
}

void append(DataFile& all, DataFile next, std::string_view file) {
  if (all.spare != next.spare) {
    drop_spare_channels(all);
    drop_spare_channels(next);
  }
  check_same_channels(all, next, file);
  check_same_units(all, next, file);
  const auto first = static_cast<int>(all.data.movement_names.size());
  for (std::string& name : next.data.movement_names) {
    auto& names = all.data.movement_names;
    const bool taken = std::find(names.begin(), names.end(), name) != names.end();
    names.push_back(taken ? fmt::format("{} ({})", name, file) : std::move(name));
  }
  for (const int movement : next.data.movement) all.data.movement.push_back(first + movement);
  for (std::size_t j = 0; j < all.data.channels.size(); ++j) {
    auto& values = all.data.channels[j].values;
    const auto& more = next.data.channels[j].values;
    values.insert(values.end(), more.begin(), more.end());
  }
  for (std::size_t j = 0; j < all.texts.size(); ++j) {
    auto& values = all.texts[j].values;
    const auto& more = next.texts[j].values;
    values.insert(values.end(), more.begin(), more.end());
  }
  all.dropped_rows += next.dropped_rows;
  for (std::string& warning : next.warnings) {
    all.warnings.push_back(fmt::format("{}: {}", file, warning));
  }
}

// Whether a file's rows stand in `all` from row `first` on, whatever their time.
bool stands_from(std::size_t first, const DataFile& all, const DataFile& next) {
  constexpr std::size_t kFewestRows = 100;  // fewer may be alike by chance
  const std::size_t rows = next.data.rows();
  if (rows < kFewestRows || first + rows > all.data.rows()) return false;
  return std::ranges::equal(
      all.data.channels, next.data.channels, [&](const Channel& one, const Channel& other) {
        const auto begin = one.values.begin() + static_cast<std::ptrdiff_t>(first);
        return one.name == other.name &&
               (one.role == Role::time ||
                std::equal(other.values.begin(), other.values.end(), begin));
      });
}

}  // namespace

DataFile read_csv_files(std::span<const std::filesystem::path> files, const CsvOptions& options) {
  if (files.empty()) throw_bad_input("no data file is given", {}, "name one CSV file or more");
  DataFile all = read_csv(files.front(), options);
  std::vector<RecordingScale> scales = {scale_of(all.data, files.front().string())};
  std::vector<std::pair<std::size_t, std::filesystem::path>> taken = {{0, files.front()}};
  for (const std::filesystem::path& file : files.subspan(1)) {
    DataFile next = read_csv(file, options);
    const auto same = std::ranges::find_if(
        taken, [&](const auto& one) { return stands_from(one.first, all, next); });
    if (same != taken.end()) {
      all.warnings.push_back(
          fmt::format("{} has the very rows of {}: left out, a recording counts "
                      "once",
                      file.string(), same->second.string()));
      continue;
    }
    taken.emplace_back(all.data.rows(), file);
    scales.push_back(scale_of(next.data, file.string()));
    append(all, std::move(next), file.string());
  }
  for (std::string& warning : check_scales(scales)) all.warnings.push_back(std::move(warning));
  return all;
}

}  // namespace tribench
