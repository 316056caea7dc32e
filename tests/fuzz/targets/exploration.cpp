// SPDX-License-Identifier: MIT
//
// An exploration's journal either is refused with its place, or is gone on from: opened again it
// has as many answers, whatever was torn off.
#include <nlohmann/json.hpp>

#include "foundation/output_file.hpp"
#include "foundation/scratch_folder.hpp"
#include "harness/exploration/exploration_folder.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace tribench;

// The setting that the first line has, so that the lines after it are read.
ExplorationSetting setting_of(std::string_view journal) {
  const auto line = nlohmann::json::parse(journal.substr(0, journal.find('\n')), nullptr, false);
  const auto text = [&](const char* key) {
    const bool is_text = line.is_object() && line.contains(key) && line[key].is_string();
    return is_text ? line[key].get<std::string>() : std::string();
  };
  return {text("asked"), text("limits"), 0, 0};
}

}  // namespace

TRIBENCH_FUZZ_TARGET(exploration) {
  static const ScratchFolder folder;
  write_file(folder.path() / "journal.jsonl", std::string(input));
  std::size_t answers = 0;
  const auto open = [&] {
    ExplorationSetting setting = setting_of(input);
    answers = ExplorationFolder(folder.path(), setting).answers();
  };
  if (!fuzz::reads(open)) return;
  const std::size_t first = answers;
  fuzz::expect(fuzz::reads(open), "what was gone on from is refused");
  fuzz::expect(answers == first, "opened again it has other answers");
}
