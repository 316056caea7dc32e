// SPDX-License-Identifier: MIT
//
// A folder of its own for each program that is run beside this one, removed with what it holds.
#pragma once

#include <sys/types.h>

#include <filesystem>

namespace tribench {

class ScratchFolder {
 public:
  // Throws Error (failed) where it cannot be made.
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// Where process `pid` keeps these folders; to be removed by whoever ends that process by force.
std::filesystem::path external_scratch_folder(pid_t pid);

}  // namespace tribench
