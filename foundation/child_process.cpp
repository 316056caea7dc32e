// SPDX-License-Identifier: MIT
#include "foundation/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

#include "foundation/error.hpp"

extern char** environ;

namespace tribench {
namespace {

[[noreturn]] void throw_failed(const std::string& what, int error) {
  throw Error(ErrorKind::failed, fmt::format("{}: {}", what, std::strerror(error)));
}

struct Pipe {
  int read_end = -1;
  int write_end = -1;
  Pipe() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw_failed("cannot make a pipe", errno);
    read_end = ends[0];
    write_end = ends[1];
  }
  ~Pipe() {
    if (read_end >= 0) ::close(read_end);
    if (write_end >= 0) ::close(write_end);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  static int release(int& end) { return std::exchange(end, -1); }
};

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> result;
  result.reserve(words.size() + 1);
  for (std::string& word : words) result.push_back(word.data());
  result.push_back(nullptr);
  return result;
}

std::vector<std::string> environment_with(const std::vector<std::string>& extra) {
  std::vector<std::string> all = extra;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text(*entry);
    const std::string_view name = text.substr(0, text.find('='));
    bool overridden = false;
    for (const std::string& given : extra) {
      overridden = overridden || std::string_view(given).substr(0, given.find('=')) == name;
    }
    if (!overridden) all.emplace_back(text);
  }
  return all;
}

// Attributes and file actions of posix_spawn, freed on every path.
struct SpawnSetup {
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_t actions;
  SpawnSetup() {
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_init(&actions);
  }
  ~SpawnSetup() {
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
  }
  SpawnSetup(const SpawnSetup&) = delete;
  SpawnSetup& operator=(const SpawnSetup&) = delete;

  // The child starts with no signal blocked and with the default answer to those we handle.
  void set_signals_and_group(bool own_group) {
    sigset_t none;
    sigset_t defaults;
    sigemptyset(&none);
    sigemptyset(&defaults);
    for (const int signal : {SIGINT, SIGTERM, SIGPIPE, SIGXFSZ}) sigaddset(&defaults, signal);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &defaults);
    int flags = POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF;
    if (own_group) {
      posix_spawnattr_setpgroup(&attributes, 0);
      flags |= POSIX_SPAWN_SETPGROUP;
    }
    posix_spawnattr_setflags(&attributes, static_cast<short>(flags));
  }
};

}  // namespace

ChildProcess::ChildProcess(const ChildOptions& options) : own_group_(options.own_group) {
  if (options.command.empty()) throw Error(ErrorKind::failed, "an empty command cannot be run");
  Pipe input;
  Pipe output;
  Pipe errors;
  SpawnSetup setup;
  setup.set_signals_and_group(own_group_);
  posix_spawn_file_actions_adddup2(&setup.actions, input.read_end, 0);
  posix_spawn_file_actions_adddup2(&setup.actions, output.write_end, 1);
  posix_spawn_file_actions_adddup2(&setup.actions, errors.write_end, 2);
  if (!options.working_directory.empty()) {
    posix_spawn_file_actions_addchdir_np(&setup.actions, options.working_directory.c_str());
  }
  std::vector<std::string> words = options.command;
  std::vector<std::string> environment = environment_with(options.environment);
  const int error = posix_spawnp(&pid_, words.front().c_str(), &setup.actions, &setup.attributes,
                                 pointers(words).data(), pointers(environment).data());
  if (error != 0) throw_failed(fmt::format("cannot run '{}'", words.front()), error);
  input_ = Pipe::release(input.write_end);
  streams_ = {Pipe::release(output.read_end), Pipe::release(errors.read_end)};
  for (const int stream : streams_) ::fcntl(stream, F_SETFL, O_NONBLOCK);
}

ChildProcess::~ChildProcess() {
  close_input();
  if (!reaped_) {
    kill();
    reap();
  }
  for (const int stream : streams_) {
    if (stream >= 0) ::close(stream);
  }
}

bool ChildProcess::write(std::string_view text) {
  // A reader that has gone away is an answer here, not a reason to die.
  sigset_t pipe_signal;
  sigset_t before;
  sigemptyset(&pipe_signal);
  sigaddset(&pipe_signal, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &pipe_signal, &before);
  bool written = input_ >= 0;
  while (written && !text.empty()) {
    const ssize_t count = ::write(input_, text.data(), text.size());
    if (count > 0) {
      text.remove_prefix(static_cast<std::size_t>(count));
    } else if (errno != EINTR) {
      written = false;
      const timespec at_once{};
      sigtimedwait(&pipe_signal, nullptr, &at_once);
    }
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return written;
}

void ChildProcess::close_input() {
  if (input_ >= 0) ::close(std::exchange(input_, -1));
}

void ChildProcess::drain(int index, std::string& into) {
  int& stream = streams_[static_cast<std::size_t>(index)];
  std::array<char, 65536> buffer;
  while (stream >= 0) {
    const ssize_t count = ::read(stream, buffer.data(), buffer.size());
    if (count > 0) {
      into.append(buffer.data(), static_cast<std::size_t>(count));
      if (into.size() > (1U << 24)) return;  // the rest at the next call
    } else if (count == 0) {
      ::close(std::exchange(stream, -1));
    } else if (errno != EINTR) {
      return;
    }
  }
}

ChildOutput ChildProcess::read(double timeout_s) {
  ChildOutput result;
  std::array<pollfd, 2> polled{{{streams_[0], POLLIN, 0}, {streams_[1], POLLIN, 0}}};
  if (streams_[0] >= 0 || streams_[1] >= 0) {
    ::poll(polled.data(), polled.size(), static_cast<int>(timeout_s * 1000) + 1);
  }
  drain(0, result.output);
  drain(1, result.errors);
  result.ended = streams_[0] < 0 && streams_[1] < 0;
  return result;
}

void ChildProcess::kill() {
  if (reaped_) return;
  ::kill(own_group_ ? -pid_ : pid_, SIGKILL);
}

bool ChildProcess::reap() noexcept {
  while (!reaped_) {
    int status = 0;
    if (::waitpid(pid_, &status, 0) < 0) {
      if (errno == EINTR) continue;
      return false;
    }
    reaped_ = true;
    if (own_group_) ::kill(-pid_, SIGKILL);  // what it has left behind
    if (WIFSIGNALED(status)) exit_.signal = WTERMSIG(status);
    if (WIFEXITED(status)) exit_.status = WEXITSTATUS(status);
  }
  return true;
}

ChildExit ChildProcess::wait() {
  if (!reap()) throw_failed("cannot wait for a child process", errno);
  return exit_;
}

ChildRun run_child(const ChildOptions& options, std::string_view input) {
  ChildProcess child(options);
  if (!input.empty()) child.write(input);
  child.close_input();
  ChildRun run;
  for (bool ended = false; !ended;) {
    const ChildOutput part = child.read(1.0);
    run.output += part.output;
    run.errors += part.errors;
    ended = part.ended;
  }
  run.exit = child.wait();
  return run;
}

std::string signal_name(int signal) {
  const char* name = ::sigabbrev_np(signal);
  return name != nullptr ? fmt::format("SIG{}", name) : fmt::format("signal {}", signal);
}

ProcessUse process_tree_use(pid_t pid) {
  std::ifstream stat(fmt::format("/proc/{}/stat", pid));
  std::string line;
  if (!std::getline(stat, line)) return {};
  // Fields after the name, which stands in brackets and may hold blanks: 14 and 15 are user and
  // system ticks, 24 the resident pages (proc(5)).
  std::istringstream fields(line.substr(line.rfind(')') + 1));
  std::vector<std::string> field(25);
  for (std::size_t i = 3; i <= 24; ++i) fields >> field[i];
  ProcessUse use;
  use.cpu_s = (std::strtod(field[14].c_str(), nullptr) + std::strtod(field[15].c_str(), nullptr)) /
              static_cast<double>(::sysconf(_SC_CLK_TCK));
  use.resident_mib = std::strtod(field[24].c_str(), nullptr) *
                     static_cast<double>(::sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0);
  std::ifstream children(fmt::format("/proc/{}/task/{}/children", pid, pid));
  for (pid_t child = 0; children >> child;) {
    const ProcessUse part = process_tree_use(child);
    use.cpu_s += part.cpu_s;
    use.resident_mib += part.resident_mib;
  }
  return use;
}

}  // namespace tribench
