// SPDX-License-Identifier: MIT
#include "harness/exploration/exploration_folder.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/output_file.hpp"
#include "foundation/output_folder.hpp"
#include "problems/reading/csv.hpp"
#include "problems/reading/file_text.hpp"

namespace tribench {
namespace {

using Json = nlohmann::ordered_json;

void append_line(const std::filesystem::path& file, const Json& line) {
  std::ofstream out(file, std::ios::app | std::ios::binary);
  out << write_json(line) << '\n';
  out.flush();
  if (!out) throw Error(ErrorKind::environment, "cannot be written to", file.string());
}

// What was being written when the program was killed was not answered: it is cut off, and the next
// answer has a line of its own.
void cut_off_torn_line(const std::filesystem::path& file) {
  std::string text = read_file_text(file);
  const std::size_t whole = text.rfind('\n') + 1;  // 0 where no line is
  if (whole == text.size()) return;
  text.resize(whole);
  write_file(file, text);
}

std::vector<Json> read_lines(const std::filesystem::path& file) {
  std::vector<Json> lines;
  std::istringstream text(read_file_text(file));
  for (std::string line; std::getline(text, line);) {
    const std::string place = fmt::format("{}:{}", file.string(), lines.size() + 1);
    lines.push_back(read_json_or_throw<Json>(line, place));
    const char* first = lines.size() == 1 ? "asked" : "movement";
    if (!lines.back().is_object() || !lines.back().contains(first)) {
      throw_bad_input(fmt::format("no '{}' in this line of an exploration's journal", first), place,
                      "give another --out");
    }
  }
  return lines;
}

}  // namespace

ExplorationFolder::ExplorationFolder(std::filesystem::path folder, ExplorationSetting& setting)
    : journal_(std::move(folder)) {
  make_output_folder(journal_);
  const std::filesystem::path place = std::exchange(journal_, journal_ / "journal.jsonl");
  std::vector<Json> lines;
  if (std::filesystem::exists(journal_)) {
    cut_off_torn_line(journal_);
    lines = read_lines(journal_);
  }
  if (lines.empty()) {
    append_line(journal_, {{"asked", setting.asked},
                           {"limits", setting.limits},
                           {"start_rad", setting.start_rad},
                           {"seconds_left", setting.seconds_left}});
    return;
  }
  if (lines[0].at("asked") != setting.asked) {
    throw_bad_input(fmt::format("the folder holds the exploration {}, not '{}'",
                                write_json(lines[0].at("asked")), setting.asked),
                    place.string(), "give another --out, or the same options");
  }
  // A journal of before there were limits has none.
  if (lines[0].value("limits", Json("")) != setting.limits) {
    throw_bad_input("the folder holds an exploration within other limits", place.string(),
                    "give another --out, or the same limits");
  }
  try {
    setting.start_rad = lines[0].at("start_rad");
    setting.seconds_left = lines[0].at("seconds_left");
    for (std::size_t k = 1; k < lines.size(); ++k) {
      known_.push_back({lines[k].at("movement"), lines[k].at("refused"), lines[k].at("recording")});
    }
  } catch (const Json::exception& error) {
    throw_bad_input(fmt::format("no journal of an exploration: {}", json_complaint(error)),
                    journal_.string(), "give another --out");
  }
}

Dataset ExplorationFolder::known_answer(const std::string& movement) {
  const Answer answer = std::move(known_.front());
  known_.pop_front();
  if (answer.movement != movement) {
    throw Error(ErrorKind::failed, "another movement is asked for than the first time",
                journal_.string(), "give another --out");
  }
  if (!answer.refused.empty()) throw_bad_input(answer.refused);
  return parse_csv(answer.recording, journal_.string()).data;
}

void ExplorationFolder::write_down(const Answer& answer) const {
  append_line(journal_, {{"movement", answer.movement},
                         {"refused", answer.refused},
                         {"recording", answer.recording}});
}

loop::ExecuteMovement ExplorationFolder::remembering(loop::ExecuteMovement execute) {
  return [this, execute = std::move(execute)](const PlannedMovement& movement) {
    const std::string line = movements_text({movement}, "rad", "rad/s");
    if (!known_.empty()) return known_answer(line);
    try {
      Dataset rows = execute(movement);
      std::ostringstream text;
      write_csv(rows, text);
      write_down({line, "", text.str()});
      return rows;
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::bad_input) write_down({line, error.what(), ""});
      throw;
    }
  };
}

}  // namespace tribench
