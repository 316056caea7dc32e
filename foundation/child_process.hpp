// SPDX-License-Identifier: MIT
//
// A program run beside this one: spawned (never forked: a fork after OpenMP has started is
// undefined), in a process group of its own so that it can be ended with all it has started, with
// pipes on its three standard streams. Used for worker processes and methods in other languages.
//
// Not a shell: the command is a list of words; the first is a path or is looked up in PATH.
#pragma once

#include <sys/types.h>

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tribench {

struct ChildOptions {
  std::vector<std::string> command = {};
  std::vector<std::string> environment = {};     // NAME=value, besides this process's own
  std::filesystem::path working_directory = {};  // empty: this process's own
  bool own_group = true;  // false: stays in this process's group and ends with it
};

// How a process ended.
struct ChildExit {
  int status = 0;  // its exit status; meaningless where a signal ended it
  int signal = 0;  // 0 where it exited by itself
  bool ok() const { return signal == 0 && status == 0; }
};

// What one wait for output brought.
struct ChildOutput {
  std::string output;  // from its standard output
  std::string errors;  // from its standard error
  bool ended = false;  // both streams are closed
};

class ChildProcess {
 public:
  // Throws Error (failed) where the program cannot be started.
  explicit ChildProcess(const ChildOptions& options);
  // Ends the process group if it still runs.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }

  // False where the process no longer reads. Blocks while the pipe is full.
  bool write(std::string_view text);
  void close_input();
  // Waits up to `timeout_s` for output; returns at once when there is some.
  ChildOutput read(double timeout_s);

  // SIGKILL to the group (to the process alone where it has none of its own). No error where it
  // has ended already.
  void kill();
  // Waits for the end and reaps it; the same answer from then on.
  ChildExit wait();

 private:
  void drain(int index, std::string& into);
  bool reap() noexcept;  // false where the process cannot be waited for; errno says why

  pid_t pid_ = -1;
  bool own_group_ = true;
  bool reaped_ = false;
  ChildExit exit_;
  int input_ = -1;
  std::array<int, 2> streams_{-1, -1};  // its output, its errors
};

// What a program left behind that was run to its end.
struct ChildRun {
  ChildExit exit;
  std::string output;
  std::string errors;
};
// Hands `input` to the program, closes its standard input and waits for its end. For programs that
// read their input before they print much. Throws Error (failed) where it cannot be started.
ChildRun run_child(const ChildOptions& options, std::string_view input = {});

// "SIGSEGV" for 11; "signal 99" where there is no name.
std::string signal_name(int signal);

// CPU seconds and resident memory of a process and of all it has started that still run.
struct ProcessUse {
  double cpu_s = 0;
  double resident_mib = 0;
};
// Zeroes for a process that does not exist. Cost: a few reads of /proc.
ProcessUse process_tree_use(pid_t pid);

}  // namespace tribench
