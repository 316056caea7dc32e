// SPDX-License-Identifier: MIT
//
// A program run beside this one, with pipes on its three standard streams, and the promise that
// nothing of it is left: a keeper process stands between, to which every process that the program
// starts falls back when its parent has gone (a child subreaper: setsid and double forks do not
// lead away from it, and the program's parent, which it may kill, is yet another process). The
// keeper ends them all when the program has ended, when kill() is called, and when this process is
// gone, by SIGKILL too. Linux only. It does nothing that is not allowed between a fork and an exec
// in a program with threads.
//
// Not a shell: the command is a list of words; the first is a path or is looked up in PATH.
#pragma once

#include <sys/types.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tribench {

struct ChildOptions {
  std::vector<std::string> command = {};
  std::vector<std::string> environment = {};     // NAME=value, besides this process's own
  std::filesystem::path working_directory = {};  // empty: this process's own
  // A folder that is removed when the program and all it has started have ended, even where this
  // process is killed before: make it by ScratchFolder; empty: none.
  std::filesystem::path scratch = {};
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
  // Throws Error (failed) where the program cannot be started, (environment) where the machine has
  // no room for one more process.
  explicit ChildProcess(const ChildOptions& options);
  // Ends the program if it still runs, and all it has started.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }

  // False where the process no longer reads. Blocks while the pipe is full.
  bool write(std::string_view text);
  // Takes off `text` what the pipe takes, once it takes something; waits for that up to
  // `timeout_s`, less where a signal comes. False where the process no longer reads.
  bool write_some(std::string_view& text, double timeout_s);
  void close_input();
  // Waits up to `timeout_s` for output; returns at once when there is some.
  ChildOutput read(double timeout_s);

  // SIGTERM to the program alone, which may ignore it. No error where it has ended already.
  void ask_to_end() const;
  // SIGKILL to the program and to all it has started. No error where it has ended already.
  void kill();
  // Waits up to `timeout_s` for the program's end; it can close its streams long before.
  bool ends_within(double timeout_s) const;
  // Waits for the end of the program and of all it has started; the same answer from then on.
  ChildExit wait();

 private:
  void drain(int index, std::string& into);
  void reap() noexcept;

  pid_t keeper_ = -1;
  pid_t pid_ = -1;
  bool reaped_ = false;
  ChildExit exit_;
  int life_ = -1;    // the keeper ends all when this is closed
  int report_ = -1;  // what the keeper says of the program
  int input_ = -1;
  std::array<int, 2> streams_{-1, -1};  // its output, its errors
};

// What a program left behind that was run to its end.
struct ChildRun {
  ChildExit exit;
  std::string output;
  std::string errors;
  bool timed_out = false;   // it was ended because its time was up
  bool broken_off = false;  // it was asked to end, and has not exited with status 0 all the same
};
// A program that was asked to end may bring to a stop what it moves.
inline constexpr double kSecondsToEnd = 5;
// What a program may take; beyond that it is ended.
struct ChildLimits {
  double wall_s = 1e9;
  std::size_t output_bytes = SIZE_MAX;  // of both streams together
  // Once true the program is asked to end, and ended kSecondsToEnd later; looked at every second,
  // and when a signal comes.
  const std::atomic<bool>* end = nullptr;
};
// Hands `input` to the program, as far as it reads, closes its standard input and waits for its
// end. Throws Error (failed) where it cannot be started or prints without end.
ChildRun run_child(const ChildOptions& options, std::string_view input = {},
                   const ChildLimits& limits = {});

// A program's file as it will be run: found in PATH where the word has no slash; the word where it
// is not there.
std::string found_in_path(const std::string& word);

// "SIGSEGV" for 11; "signal 99" where there is no name.
std::string signal_name(int signal);

// For messages: "status 3: " or "SIGKILL: " and the end of what it printed to its standard error,
// or that this was nothing.
std::string told_of_end(const ChildExit& exit, std::string_view errors);

// The most resident memory, in MiB, that one process had of those that ended under a ChildProcess
// since the last reset: of the programs and of what they started and waited for. The kernel's own
// figure for a process's children (getrusage) cannot be reset.
double peak_memory_of_children_mib();
void reset_peak_memory_of_children();

// CPU seconds and resident memory of a process and of all it has started that still run. A keeper's
// memory is that of the process it was forked from and is not counted twice.
struct ProcessUse {
  double cpu_s = 0;
  double resident_mib = 0;
};
// Zeroes for a process that does not exist. Cost: a few reads of /proc.
ProcessUse process_tree_use(pid_t pid);

}  // namespace tribench
