// SPDX-License-Identifier: MIT
#include "harness/study/recordings.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <fstream>
#include <span>
#include <sstream>

#include "foundation/error.hpp"
#include "foundation/random.hpp"
#include "foundation/text.hpp"
#include "foundation/toml_table.hpp"
#include "harness/study/loop_cases.hpp"
#include "problems/reading/csv.hpp"
#include "reports/csv.hpp"

namespace tribench {

namespace embedded {
std::string_view measured_recordings();
}

namespace {

constexpr double kSmallestScale = 0.5;  // below, finding it is a matter of luck

std::string csv_text(const CsvCells& cells) {
  std::string text;
  append_csv_row(text, cells.header);
  for (const CsvLine& line : cells.lines) {
    if (!line.blank()) append_csv_row(text, line.cells);
  }
  return text;
}

RecordingToTell recording_of(const LoopCase& one) {
  std::ostringstream text;
  write_csv(one.make().data, text);
  RecordingToTell recording{one.key(),
                            {{"recording.csv", split_csv(text.str(), "recording.csv")}},
                            {"--gear-ratio", fmt::format("{}", one.gear_ratio)},
                            one.seed};
  if (one.any_sign) recording.options.emplace_back("--any-sign");
  return recording;
}

RecordingToTell recording_of(const TomlTable& table, const std::filesystem::path& folder) {
  for (const char* key : {"name", "files"}) table.require(key);
  RecordingToTell recording;
  std::vector<std::string> files;
  table.read("name", recording.name);
  table.read("files", files);
  table.read("options", recording.options);
  for (const std::string& file : files) {
    const auto text = read_file_if_there(folder / file);
    if (!text) return recording;
    recording.files.push_back(
        {std::filesystem::path(file).filename().string(), split_csv(*text, file)});
  }
  return recording;
}

}  // namespace

std::vector<RecordingToTell> planted_recordings(LoopGenerator generator, int count,
                                                std::uint64_t first_seed, std::string_view only) {
  // So few null runs that they are near a tenth of the draw.
  std::vector<LoopCase> cases = generator == LoopGenerator::simulated
                                    ? make_simulated_cases(1, 2, first_seed)
                                    : make_loop_cases(8, 2, first_seed);
  std::erase_if(cases, [&](const LoopCase& one) {
    return !one.key().starts_with(only) || (one.scale != 0 && one.scale < kSmallestScale);
  });
  if (cases.empty()) {
    throw_bad_input(fmt::format("no planted campaign begins with '{}'", only), "--only",
                    "as in the lines printed: single/stribeck, null, pair");
  }
  RandomStream(key_of("recordings/planted")).split(first_seed).shuffle(std::span(cases));
  cases.resize(std::min(cases.size(), static_cast<std::size_t>(count)));
  std::vector<RecordingToTell> recordings;
  for (const LoopCase& one : cases) recordings.push_back(recording_of(one));
  return recordings;
}

RecordingList read_recordings(std::string_view toml, const std::string& name,
                              const std::filesystem::path& folder) {
  const toml::table root = parse_toml(toml, name);
  const TomlTable file(root, name, "", {"recording"});
  RecordingList list;
  for (const TomlTable& table : file.array_of_tables("recording", {"name", "files", "options"})) {
    RecordingToTell recording = recording_of(table, folder);
    if (recording.files.empty()) {
      list.missing.push_back(recording.name);
    } else {
      list.recordings.push_back(std::move(recording));
    }
  }
  return list;
}

std::string_view measured_recordings_toml() { return embedded::measured_recordings(); }

std::vector<std::string> write_recording(const RecordingToTell& recording,
                                         const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  std::vector<std::string> words = {"loop"};
  for (const RecordingFile& file : recording.files) {
    words.push_back((folder / file.name).string());
    std::ofstream out(words.back(), std::ios::binary);
    out << csv_text(file.cells);
    if (!out.flush()) throw Error(ErrorKind::failed, "cannot write", words.back());
  }
  words.insert(words.end(), recording.options.begin(), recording.options.end());
  words.insert(words.end(), {"--seed", fmt::format("{}", recording.seed)});
  return words;
}

}  // namespace tribench
