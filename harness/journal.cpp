// SPDX-License-Identifier: MIT
#include "harness/journal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/random.hpp"
#include "foundation/text.hpp"

namespace tribench {
namespace {

using nlohmann::json;

// A line is {"check":"0123456789abcdef","body":...}; the check is the key of the body's text.
constexpr std::string_view kBeforeCheck = "{\"check\":\"";
constexpr std::string_view kBetween = "\",\"body\":";
constexpr std::size_t kCheckDigits = 16;
constexpr std::size_t kBodyStart = kBeforeCheck.size() + kCheckDigits + kBetween.size();
constexpr double kSecondsBetweenSyncs = 1.0;

// The body of a good line, empty for any other. Without the line's end.
std::string_view body_of(std::string_view line) {
  if (line.size() < kBodyStart + 1 || !line.starts_with(kBeforeCheck) || line.back() != '}') {
    return {};
  }
  const std::string_view body = line.substr(kBodyStart, line.size() - kBodyStart - 1);
  const std::string check = fmt::format("{:016x}", key_of(body));
  return line.substr(kBeforeCheck.size(), kCheckDigits) == check ? body : std::string_view();
}

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

[[noreturn]] void throw_failed(const std::filesystem::path& file, std::string_view what,
                               std::string_view mend = {}) {
  throw Error(ErrorKind::failed, fmt::format("{}: {}", what, std::strerror(errno)), file.string(),
              mend);
}

int open_locked(const std::filesystem::path& file, int flags) {
  const int descriptor = ::open(file.c_str(), flags | O_CLOEXEC, 0644);
  if (descriptor < 0) {
    if (errno == EEXIST) {
      throw_bad_input("there is a run in this folder already", file.string(),
                      "give another --out, or go on with it by --resume");
    }
    throw_failed(file, "cannot write the journal", "choose a folder that can be written to");
  }
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    ::close(descriptor);
    throw_bad_input("another run is writing this journal", file.string(),
                    "wait for it to end, or give another --out");
  }
  return descriptor;
}

std::string identity_body(const RunIdentity& identity) {
  json text = {{"grid", identity.grid}, {"code", identity.code}, {"data", identity.data}};
  if (!identity.programs.empty()) text["programs"] = identity.programs;
  return write_json(json{{"identity", std::move(text)}});
}

RunIdentity parse_identity(std::string_view body, const std::filesystem::path& file) {
  try {
    const json object = read_json<json>(body).at("identity");
    RunIdentity identity{object.at("grid"), object.at("code"), object.at("data")};
    if (object.contains("programs")) {
      identity.programs = object.at("programs").get<std::map<std::string, std::string>>();
    }
    return identity;
  } catch (const json::exception&) {  // an empty body, or one that this program did not write
    throw_bad_input("this is not a run's journal", file.string());
  }
}

// Nothing where the body is none or says something else: another version may have written it.
std::optional<CellResult> result_of(std::string_view body) {
  if (body.empty()) return std::nullopt;
  try {
    return parse_result(body);
  } catch (const Error&) {
    return std::nullopt;
  }
}

// The lines that are in one text and not in the other.
std::string line_difference(const std::string& before, const std::string& after) {
  const auto lines_of = [](const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
  };
  const std::vector<std::string> old_lines = lines_of(before);
  const std::vector<std::string> new_lines = lines_of(after);
  std::string text;
  const auto append_missing = [&text](const std::vector<std::string>& from,
                                      const std::vector<std::string>& in, char mark) {
    for (const std::string& line : from) {
      if (std::ranges::count(in, line) == 0) text += fmt::format("  {} {}\n", mark, line);
    }
  };
  append_missing(old_lines, new_lines, '-');
  append_missing(new_lines, old_lines, '+');
  return text;
}

// A file that one of the two does not have shows as none.
std::string program_difference(const std::map<std::string, std::string>& before,
                               const std::map<std::string, std::string>& now) {
  constexpr std::size_t kShown = 12;  // hexadecimal digits
  std::map<std::string, std::string> all = before;
  all.insert(now.begin(), now.end());
  const auto hash_in = [](const std::map<std::string, std::string>& files,
                          const std::string& name) {
    const auto found = files.find(name);
    return found == files.end() ? std::string("none") : found->second;
  };
  std::string text;
  for (const auto& [name, hash] : all) {
    const std::string old = hash_in(before, name);
    const std::string fresh = hash_in(now, name);
    if (old == fresh) continue;
    text += fmt::format("the program's file differs, {}: {} -> {}\n", name, old.substr(0, kShown),
                        fresh.substr(0, kShown));
  }
  return text;
}

}  // namespace

std::string journal_line(std::string_view body) {
  return fmt::format("{}{:016x}{}{}}}\n", kBeforeCheck, key_of(body), kBetween, body);
}

std::string RunIdentity::difference(const RunIdentity& other) const {
  std::string text;
  if (grid != other.grid) {
    text += "the grid differs (- before, + now):\n" + line_difference(grid, other.grid);
  }
  if (code != other.code) text += fmt::format("the code differs: {} -> {}\n", code, other.code);
  if (data != other.data) text += fmt::format("the data differ: {} -> {}\n", data, other.data);
  return text + program_difference(programs, other.programs);
}

JournalContents read_journal(const std::filesystem::path& file) {
  std::ifstream stream = open_file_if_there(file);
  if (!stream) throw_bad_input("there is no journal", file.string(), "is this a run's folder?");
  JournalContents contents;
  std::map<std::string, std::size_t> place_of_cell;
  std::uintmax_t offset = 0;
  std::size_t number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    const bool has_end = !stream.eof();
    offset += line.size() + (has_end ? 1 : 0);
    contents.bytes = offset;
    const std::string_view body = has_end ? body_of(line) : std::string_view();
    if (number == 1) {
      contents.identity = parse_identity(body, file);
    } else if (std::optional<CellResult> result = result_of(body); !result) {
      contents.damage.push_back(
          fmt::format("line {} is {}; its cell is missing", number, has_end ? "damaged" : "torn"));
      continue;
    } else {
      const auto [place, is_new] =
          place_of_cell.try_emplace(result->record.cell, contents.results.size());
      if (is_new) {
        contents.results.push_back(std::move(*result));
      } else {
        contents.results[place->second] = std::move(*result);
      }
    }
    contents.good_bytes = offset;
  }
  if (number == 0) {
    throw_bad_input("the journal is empty", file.string(),
                    "no cell was written: remove the file and run again");
  }
  return contents;
}

Journal::Journal(std::filesystem::path file, int descriptor, std::uintmax_t size)
    : file_(std::move(file)), descriptor_(descriptor), size_(size), last_sync_s_(now_s()) {}

Journal::Journal(Journal&& other) noexcept
    : file_(std::move(other.file_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_),
      failed_(other.failed_),
      last_sync_s_(other.last_sync_s_) {}

Journal::~Journal() {
  if (descriptor_ < 0) return;
  ::fdatasync(descriptor_);
  ::close(descriptor_);
}

Journal Journal::create(const std::filesystem::path& file, const RunIdentity& identity) {
  Journal journal(file, open_locked(file, O_WRONLY | O_CREAT | O_EXCL), 0);
  try {
    journal.write_line(identity_body(identity));
  } catch (const Error&) {  // an empty file would stand in the way of every later run
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    throw;
  }
  return journal;
}

Journal Journal::resume(const std::filesystem::path& file, const JournalContents& contents) {
  const int descriptor = open_locked(file, O_WRONLY);
  struct stat status {};
  if (::fstat(descriptor, &status) != 0 ||
      static_cast<std::uintmax_t>(status.st_size) != contents.bytes) {
    ::close(descriptor);
    throw_bad_input("another run wrote to this journal just now", file.string(),
                    "wait for it to end, and go on by --resume again");
  }
  // A torn last line goes; a damaged line in the middle stays where it is.
  const std::uintmax_t size = contents.good_bytes;
  if (::ftruncate(descriptor, static_cast<off_t>(size)) != 0) {
    ::close(descriptor);
    throw_failed(file, "cannot cut off the torn last line");
  }
  ::lseek(descriptor, 0, SEEK_END);
  return {file, descriptor, size};
}

void Journal::write_line(const std::string& body) {
  const std::string line = journal_line(body);
  std::size_t written = 0;
  while (written < line.size()) {
    const ssize_t count = ::write(descriptor_, line.data() + written, line.size() - written);
    if (count > 0) {
      written += static_cast<std::size_t>(count);
    } else if (errno != EINTR) {
      failed_ = true;
      const int error = errno;
      // Half a line would have to be explained later; the cut frees room, so it works on a full
      // disk too, and where it does not, reading drops the torn line.
      if (::ftruncate(descriptor_, static_cast<off_t>(size_)) == 0) {
        ::lseek(descriptor_, 0, SEEK_END);
      }
      errno = error;
      throw_failed(file_, "cannot write to the journal",
                   "every cell written so far is safe: make room and go on by --resume");
    }
  }
  size_ += line.size();
}

// What is written to a file without a name is lost when the run ends, hours later perhaps.
void Journal::refuse_if_removed() {
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0 || status.st_nlink > 0) return;
  failed_ = true;
  throw Error(ErrorKind::failed, "the journal was removed while the run went on", file_.string(),
              "run again, and leave the folder alone until the run has ended");
}

void Journal::sync_if_due() {
  if (now_s() - last_sync_s_ < kSecondsBetweenSyncs) return;
  ::fdatasync(descriptor_);
  last_sync_s_ = now_s();
}

void Journal::append(const CellResult& result) {
  const std::string body = print_result(result);
  const std::lock_guard lock(mutex_);
  if (failed_) return;
  refuse_if_removed();
  write_line(body);
  sync_if_due();
}

}  // namespace tribench
