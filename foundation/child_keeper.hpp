// SPDX-License-Identifier: MIT
//
// The process that stands between this one and a program run beside it, and leaves nothing of the
// program behind (child_process.hpp says when). Private to the foundation.
#pragma once

#include <sys/types.h>

namespace tribench {

inline constexpr const char* kKeeperName = "tribench-keep";  // as /proc shows it; 15 bytes at most

// All of it is made before the fork: a child of a process with threads may not allocate.
struct KeptProgram {
  const char* file;
  char* const* words;
  char* const* environment;
  const char* folder;   // null: this process's own
  const char* scratch;  // a folder that the keeper removes at the end; null: none
  int streams[3];       // become its standard input, output and errors
  int life;             // read end of a pipe; the keeper ends all when the other end is closed
  int report;           // write end of a pipe: a KeeperStart, and at the end what waitpid gives
};

struct KeeperStart {
  pid_t pid = -1;  // of the program
  int error = 0;   // why it could not be run, as errno
};

// The keeper's pid, or -1 with errno. It runs in a session of its own.
pid_t start_keeper(const KeptProgram& program);

// What the keeper reports, in this order. A keeper that was killed reports SIGKILL.
KeeperStart read_start(int report);
int read_end(int report);

}  // namespace tribench
