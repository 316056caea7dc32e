// SPDX-License-Identifier: MIT
#include "problems/measured/data_folder.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "foundation/error.hpp"
#include "problems/file_hash.hpp"

namespace tribench::measured {
namespace {

namespace fs = std::filesystem;

fs::path existing_folder(const fs::path& folder, const char* said_by) {
  std::error_code code;
  if (fs::is_directory(folder, code)) return folder;
  throw_bad_input(fmt::format("{} names no folder", said_by), folder.string(),
                  "give the folder that holds the measured sets");
}

}  // namespace

std::optional<fs::path> find_data_folder(const std::optional<fs::path>& given) {
  if (given) return existing_folder(*given, "--data");
  if (const char* named = std::getenv("TRIBENCH_DATA"); named != nullptr && *named != '\0') {
    return existing_folder(named, "$TRIBENCH_DATA");
  }
  std::error_code code;
  if (fs::is_directory("data", code)) return fs::path("data");
  return std::nullopt;
}

std::vector<FileCheck> check_set(const Manifest& manifest, const fs::path& folder) {
  std::vector<FileCheck> checks;
  for (const File& file : manifest.files) {
    FileCheck check{manifest.name, file.name, FileState::missing, {}};
    const fs::path path = folder / file.name;
    std::error_code code;
    if (fs::is_regular_file(path, code)) {
      const std::string hash = sha256_of(path);
      check.state = hash == file.sha256 ? FileState::good : FileState::changed;
      if (check.state == FileState::changed) check.found = hash;
    }
    checks.push_back(std::move(check));
  }
  return checks;
}

fs::path add_set(const Manifest& manifest, const fs::path& from, const fs::path& data_folder) {
  const fs::path base = existing_folder(from, "--from");
  std::error_code code;
  const fs::path inner = base / manifest.name;
  const fs::path source = fs::is_directory(inner, code) ? inner : base;
  for (const FileCheck& check : check_set(manifest, source)) {
    if (check.state == FileState::good) continue;
    throw_bad_input(check.state == FileState::missing
                        ? std::string("the file is not there")
                        : fmt::format("the file's hash is {}, not the manifest's", check.found),
                    (source / check.file).string(),
                    fmt::format("get '{}' from {}", manifest.name, manifest.source));
  }
  const fs::path target = data_folder / manifest.name;
  fs::create_directories(target, code);
  for (const File& file : manifest.files) {
    if (!code) {
      fs::copy_file(source / file.name, target / file.name, fs::copy_options::overwrite_existing,
                    code);
    }
  }
  if (code) {
    throw Error(ErrorKind::failed, fmt::format("cannot copy: {}", code.message()), target.string(),
                "check that the folder can be written");
  }
  return target;
}

}  // namespace tribench::measured
