// SPDX-License-Identifier: MIT
//
// A folder for files that are not kept: requests to other programs, runs made to be compared. Its
// name cannot be foretold and only its owner may enter it, so that no other user of the machine can
// put files there or swap them.
#pragma once

#include <filesystem>

namespace tribench {

// Made in the system's folder for temporary files ($TMPDIR, else /tmp); removed with all it holds
// when the object ends. A process that is killed leaves its folder behind: give such a process a
// ScratchFolder of its starter's as its TMPDIR, and the starter removes all of it.
class ScratchFolder {
 public:
  // Throws Error (environment) where it cannot be made.
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace tribench
