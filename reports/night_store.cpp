// SPDX-License-Identifier: MIT
#include "reports/night_store.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>

#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/output_folder.hpp"
#include "foundation/plain_name.hpp"
#include "foundation/text.hpp"

namespace tribench {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr const char* kNights = "nights";
constexpr const char* kBlessings = "blessings";
constexpr const char* kNightEnd = ".night";
constexpr const char* kBlessingEnd = ".json";

[[noreturn]] void throw_failed(const fs::path& file) {
  throw Error(ErrorKind::failed, fmt::format("cannot be written: {}", std::strerror(errno)),
              file.string(), "check the disk's free space and the folder's rights");
}

// Under another name first, on the disk before it gets its own: whole or not at all.
void write_durably(const fs::path& file, std::string_view text) {
  fs::path partial = file;
  partial += ".partial";
  const int descriptor = ::open(partial.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor < 0) throw_failed(file);
  while (!text.empty()) {
    const ssize_t count = ::write(descriptor, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      ::close(descriptor);
      throw_failed(file);
    }
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  const bool is_on_disk = ::fsync(descriptor) == 0;
  ::close(descriptor);
  if (!is_on_disk || ::rename(partial.c_str(), file.c_str()) != 0) throw_failed(file);
  const int folder = ::open(file.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    ::fsync(folder);
    ::close(folder);
  }
}

// Stems of the files of a kind, sorted: names begin with the time.
std::vector<std::string> stems(const fs::path& folder, const char* end) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == end) names.push_back(entry.path().stem().string());
  }
  std::ranges::sort(names);
  return names;
}

}  // namespace

NightStore::NightStore(fs::path folder) : folder_(std::move(folder)) {
  make_output_folder(folder_ / kNights);
  make_output_folder(folder_ / kBlessings);
}

fs::path NightStore::file_of(const std::string& name) const {
  require_plain_name(name, "a night", folder_.string());
  return folder_ / kNights / (name + kNightEnd);
}

void NightStore::record(const Night& night) {
  const fs::path file = file_of(night.name);
  const std::string text = print_night(night);
  if (const auto before = read_file_if_there(file); before && *before != text) {
    throw_bad_input("this night is recorded already, with other results", file.string(),
                    "nights are never changed: record the run under another name");
  }
  write_durably(file, text);
}

std::vector<std::string> NightStore::names() const { return stems(folder_ / kNights, kNightEnd); }

Night NightStore::read(const std::string& name, bool with_seeds) const {
  const fs::path file = file_of(name);
  const auto text = read_file_if_there(file);
  if (!text) {
    throw_bad_input("the night's record is missing", file.string(),
                    "bring it back from a copy of the store, or bless another night");
  }
  return read_night(*text, file.string(), with_seeds);
}

void NightStore::bless(const Blessing& blessing) {
  read(blessing.night, false);
  if (blessing.reason.empty()) {
    throw_bad_input("a blessing needs a reason", "bless", "say why this level is the right one");
  }
  if (const std::vector<Blessing> before = blessings();
      !before.empty() && blessing.when < before.back().when) {
    throw_bad_input(fmt::format("the clock says {}, and the last blessing is of {}", blessing.when,
                                before.back().when),
                    "bless", "set the clock: the last blessing by its time is the one that counts");
  }
  // Two in the same second: the later one has the longer name, and sorts behind.
  std::string name = blessing.when;
  std::erase(name, ':');
  while (fs::exists(folder_ / kBlessings / (name + kBlessingEnd))) name += "+";
  write_durably(folder_ / kBlessings / (name + kBlessingEnd),
                write_json(ordered_json{{"night", blessing.night},
                                        {"reason", blessing.reason},
                                        {"when", blessing.when}},
                           1) +
                    "\n");
}

std::vector<Blessing> NightStore::blessings() const {
  std::vector<Blessing> all;
  for (const std::string& name : stems(folder_ / kBlessings, kBlessingEnd)) {
    const fs::path file = folder_ / kBlessings / (name + kBlessingEnd);
    try {
      const ordered_json object = read_json<ordered_json>(read_file_if_there(file).value_or(""));
      all.push_back({object.at("night"), object.value("reason", ""), object.value("when", "")});
    } catch (const ordered_json::exception&) {  // no JSON, no object, another type
      throw_bad_input("this blessing is damaged", file.string(),
                      "bring it back from a copy of the store");
    }
  }
  return all;
}

std::optional<Night> NightStore::base() const {
  const std::vector<Blessing> all = blessings();
  if (!all.empty()) return read(all.back().night);
  if (names().empty()) return std::nullopt;
  throw_bad_input("the store has nights and no base", folder_.string(),
                  "name it: tribench history bless STORE REASON --night NAME");
}

std::vector<std::string> NightStore::prune(std::size_t keep, bool remove) {
  std::set<std::string> blessed;
  for (const Blessing& each : blessings()) blessed.insert(each.night);
  const std::vector<std::string> all = names();
  std::vector<std::string> going;
  for (std::size_t i = 0; i + keep < all.size(); ++i) {
    if (!blessed.contains(all[i])) going.push_back(all[i]);
  }
  for (const std::string& name : going) {
    if (remove) fs::remove(file_of(name));
  }
  return going;
}

}  // namespace tribench
