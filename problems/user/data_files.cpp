// SPDX-License-Identifier: MIT
//
// From what a user names to files with hashes and problems with names.
#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "foundation/error.hpp"
#include "foundation/number_text.hpp"
#include "problems/file_hash.hpp"
#include "problems/reading/channel_names.hpp"
#include "problems/reading/csv_layout.hpp"
#include "problems/reading/file_text.hpp"
#include "problems/user/user_problem.hpp"

namespace tribench::user {
namespace {

namespace fs = std::filesystem;

bool is_data_file(const fs::path& file) {
  constexpr std::array<std::string_view, 6> kEndings = {".csv",    ".tsv",    ".txt",
                                                        ".csv.gz", ".tsv.gz", ".txt.gz"};
  const std::string name = file.filename().string();
  return !name.starts_with('.') &&
         std::ranges::any_of(kEndings, [&](std::string_view end) { return name.ends_with(end); });
}

std::vector<fs::path> files_in(const fs::path& folder, const std::string& place) {
  std::vector<fs::path> files;
  std::error_code code;
  for (fs::directory_iterator at(folder, code), end; !code && at != end; at.increment(code)) {
    if (at->is_regular_file(code) && is_data_file(at->path())) files.push_back(at->path());
  }
  if (files.empty()) {
    throw_bad_input(fmt::format("the folder '{}' has no data file", folder.string()), place,
                    "data files end in .csv, .tsv or .txt, packed ones in .gz besides");
  }
  std::ranges::sort(files);
  return files;
}

std::vector<fs::path> files_like(const fs::path& pattern, const std::string& place) {
  glob_t found{};
  // Own order: the locale's is another on another machine.
  const int failure = ::glob(pattern.c_str(), GLOB_NOSORT, nullptr, &found);
  std::vector<fs::path> files;
  for (std::size_t i = 0; failure == 0 && i < found.gl_pathc; ++i) {
    files.emplace_back(found.gl_pathv[i]);
  }
  ::globfree(&found);
  if (files.empty()) {
    throw_bad_input(fmt::format("no file is called '{}'", pattern.string()), place,
                    "name a CSV file, a folder of them, or a pattern as in 'logs/*.csv'");
  }
  std::ranges::sort(files);
  return files;
}

bool is_same_data(const DataSource& one, const DataSource& other) {
  if (!one.sha256.empty() && one.sha256 == other.sha256) return true;
  std::error_code missing;  // whoever reads the file says so
  return fs::equivalent(one.file, other.file, missing);
}

bool is_among(const DataSource& one, std::span<const DataSource> others) {
  return std::ranges::any_of(others,
                             [&](const DataSource& other) { return is_same_data(one, other); });
}

bool is_text(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.ends_with(".txt") || name.ends_with(".txt.gz");
}

bool has_column(const fs::path& file, const std::string& column) {
  try {
    const std::vector<std::string> header = find_layout(read_file_text(file), file.string()).header;
    return std::ranges::any_of(header, [&](const std::string& name) {
      return name == column || without_unit(name) == column;
    });
  } catch (const Error&) {
    return false;  // no table at all
  }
}

}  // namespace

std::vector<fs::path> find_data_files(const fs::path& named, const std::string& place) {
  std::error_code code;
  if (fs::is_directory(named, code)) return files_in(named, place);
  if (fs::exists(named, code)) return {named};
  return files_like(named, place);
}

std::vector<DataSource> hashed(std::span<const fs::path> files) {
  std::vector<DataSource> sources;
  for (const fs::path& file : files) sources.push_back({file, sha256_of(file)});
  return sources;
}

std::vector<DataSource> find_sources(const fs::path& named, const std::string& place) {
  const std::vector<fs::path> files = find_data_files(named, place);
  std::vector<DataSource> sources = hashed(files);
  for (DataSource& source : sources) source.is_found = source.file != named;
  return sources;
}

void require_apart(std::span<const DataSource> train, std::span<const DataSource> test,
                   const std::string& place) {
  for (const DataSource& source : train) {
    if (!is_among(source, test)) continue;
    throw_bad_input(
        fmt::format("'{}' trains, and it or a copy of it tests: errors on it would say nothing",
                    source.file.string()),
        place, "leave it out of one of the two, or hold out a share of its rows by a split");
  }
}

void require_apart(std::span<const fs::path> train, const fs::path& test,
                   const std::string& place) {
  const auto source_of = [](const fs::path& file) {
    std::error_code missing;
    const bool has_bytes = fs::is_regular_file(file, missing);
    return DataSource{file, has_bytes ? sha256_of(file) : std::string()};
  };
  std::vector<DataSource> sources;
  for (const fs::path& file : train) sources.push_back(source_of(file));
  const DataSource tested = source_of(test);
  require_apart(sources, {&tested, 1}, place);
}

void leave_out_tests(std::vector<DataSource>& train, std::span<const DataSource> test,
                     const std::string& place) {
  std::vector<DataSource> kept;
  for (const DataSource& source : train) {
    if (!source.is_found || !is_among(source, test)) kept.push_back(source);
  }
  if (!kept.empty()) train = std::move(kept);
  require_apart(train, test, place);
}

std::vector<fs::path> take_out_notes(std::vector<DataSource>& sources, const std::string& target) {
  std::vector<DataSource> kept;
  std::vector<fs::path> notes;
  for (const DataSource& source : sources) {
    if (source.is_found && is_text(source.file) && !has_column(source.file, target)) {
      notes.push_back(source.file);
    } else {
      kept.push_back(source);
    }
  }
  if (kept.empty()) return {};
  sources = std::move(kept);
  return notes;
}

std::string name_of_file(const fs::path& file) {
  fs::path stem = file.filename();
  if (stem.extension() == ".gz") stem = stem.stem();
  std::string name;
  for (const char c : stem.stem().string()) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '.';
    if (is_plain) {
      name += c;
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  while (name.ends_with('_')) name.pop_back();
  while (!name.empty() && std::isalnum(static_cast<unsigned char>(name.front())) == 0) {
    name.erase(0, 1);
  }
  constexpr std::size_t kLongest = 64;
  return name.empty() ? "data" : name.substr(0, kLongest);
}

HeldOut parse_held_out(const std::string& text, const std::string& place) {
  HeldOut held_out;
  const std::size_t equals = text.rfind('=');
  if (equals != std::string::npos && equals > 0) {
    held_out.kind = HeldOut::Kind::values;
    held_out.column = text.substr(0, equals);
    held_out.values = {text.substr(equals + 1)};
    return held_out;
  }
  const auto share = read_number<double>(text);
  if (!share || !(*share > 0 && *share < 1)) {
    throw_bad_input(fmt::format("'{}' is no split", text), place,
                    "write a share as in 0.25, or COLUMN=VALUE as in fold=3");
  }
  held_out.share = *share;
  return held_out;
}

}  // namespace tribench::user
