// SPDX-License-Identifier: MIT
//
// A study's runs in a CSV file that grows by a line whenever one has ended, so that nothing is lost
// when the study is; a study begun again goes on with what the file has.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "foundation/error.hpp"
#include "foundation/output_folder.hpp"
#include "foundation/text.hpp"
#include "reports/csv.hpp"

namespace tribench {

// How a run is written down.
template <typename Run>
struct RunFormat {
  std::vector<std::string> columns;
  std::function<std::string(const Run&)> row;  // with its line end
  // Throws Error (bad_input) where a field is no number.
  std::function<Run(std::span<const std::string_view>)> read;
  std::function<std::string(const Run&)> key;  // which run it is
};

// A field of such a file. Throws Error (bad_input) where it is no number.
inline double number_in_field(std::string_view text, std::string_view file) {
  double value = 0;
  if (!read_csv_number(text, value)) {
    throw_bad_input("'" + std::string(text) + "' is no number", std::string(file),
                    "give --out a folder of its own");
  }
  return value;
}

template <typename Run>
class RunsFile {
 public:
  // Empty file: nothing is read or written. Throws Error (bad_input) where the file is there and is
  // another one, (failed) where it cannot be written.
  RunsFile(const std::filesystem::path& file, RunFormat<Run> format)
      : file_(file), format_(std::move(format)) {
    if (file_.empty()) return;
    make_output_folder(file_.parent_path());
    read_back();
    write_afresh();
  }

  std::optional<Run> done(const std::string& key) const {
    const auto found = done_.find(key);
    return found == done_.end() ? std::nullopt : std::optional(found->second);
  }

  // Safe from several threads.
  void append(const Run& run) {
    if (file_.empty()) return;
    const std::lock_guard lock(mutex_);
    stream_ << format_.row(run) << std::flush;
    if (!stream_) throw Error(ErrorKind::failed, "cannot write", file_.string());
  }

 private:
  void read_back() {
    std::ifstream in = open_file_if_there(file_);
    if (!in) return;
    const auto header = [&](const std::vector<std::string_view>& names) {
      if (std::ranges::equal(names, format_.columns)) return;
      throw_bad_input("this is no list of runs of this study", file_.string(),
                      "give --out a folder of its own");
    };
    read_csv(in, header, [&](const std::vector<std::string_view>& fields) {
      Run one = format_.read(fields);
      std::string key = format_.key(one);
      done_.insert_or_assign(std::move(key), std::move(one));
    });
  }

  // So that a torn last line is gone.
  void write_afresh() {
    stream_.open(file_, std::ios::trunc);
    std::string header;
    append_csv_row(header, format_.columns);
    stream_ << header;
    for (const auto& [key, run] : done_) stream_ << format_.row(run);
    stream_ << std::flush;
    if (!stream_) throw Error(ErrorKind::failed, "cannot write", file_.string());
  }

  std::filesystem::path file_;
  RunFormat<Run> format_;
  std::ofstream stream_;
  std::map<std::string, Run> done_;
  std::mutex mutex_;
};

}  // namespace tribench
