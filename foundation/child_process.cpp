// SPDX-License-Identifier: MIT
#include "foundation/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

#include "foundation/child_keeper.hpp"
#include "foundation/error.hpp"
#include "foundation/text.hpp"

extern char** environ;

namespace tribench {
namespace {

[[noreturn]] void throw_failed(const std::string& what, int error) {
  const bool no_room = error == EAGAIN || error == ENOMEM || error == EMFILE || error == ENFILE;
  const bool no_descriptor = error == EMFILE || error == ENFILE;
  throw Error(no_room ? ErrorKind::environment : ErrorKind::failed,
              fmt::format("{}: {}", what, std::strerror(error)), {},
              no_descriptor ? "allow more open files (ulimit -n)"
              : no_room     ? "allow more processes or memory (ulimit -u, -v), or fewer --jobs"
                            : "");
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

std::atomic<long> peak_of_children_kib{0};

void note_peak_memory(long kib) noexcept {
  long known = peak_of_children_kib.load();
  while (kib > known && !peak_of_children_kib.compare_exchange_weak(known, kib)) {
  }
}

}  // namespace

std::string found_in_path(const std::string& word) {
  if (word.find('/') != std::string::npos) return word;
  const char* variable = std::getenv("PATH");
  std::string_view path = variable != nullptr ? variable : "/usr/local/bin:/usr/bin:/bin";
  while (!path.empty()) {
    const std::size_t end = std::min(path.find(':'), path.size());
    const std::string candidate = fmt::format("{}/{}", end == 0 ? "." : path.substr(0, end), word);
    if (::access(candidate.c_str(), X_OK) == 0) return candidate;
    path.remove_prefix(std::min(end + 1, path.size()));
  }
  return word;  // execve will say that it is not there
}

double peak_memory_of_children_mib() {
  return static_cast<double>(peak_of_children_kib.load()) / 1024;
}

void reset_peak_memory_of_children() { peak_of_children_kib = 0; }

ChildProcess::ChildProcess(const ChildOptions& options) {
  if (options.command.empty()) throw Error(ErrorKind::failed, "an empty command cannot be run");
  std::vector<std::string> words = options.command;
  std::vector<std::string> environment = environment_with(options.environment);
  const std::string file = found_in_path(words.front());
  const std::vector<char*> word_pointers = pointers(words);
  const std::vector<char*> environment_pointers = pointers(environment);
  Pipe input;
  Pipe output;
  Pipe errors;
  Pipe life;
  Pipe report;
  const KeptProgram program{
      file.c_str(),
      word_pointers.data(),
      environment_pointers.data(),
      options.working_directory.empty() ? nullptr : options.working_directory.c_str(),
      options.scratch.empty() ? nullptr : options.scratch.c_str(),
      {input.read_end, output.write_end, errors.write_end},
      life.read_end,
      report.write_end};
  keeper_ = start_keeper(program);
  if (keeper_ < 0) throw_failed(fmt::format("cannot start '{}'", words.front()), errno);
  ::close(Pipe::release(report.write_end));
  ::close(Pipe::release(life.read_end));
  life_ = Pipe::release(life.write_end);
  report_ = Pipe::release(report.read_end);
  const KeeperStart start = read_start(report_);
  pid_ = start.pid;
  if (start.error != 0) {
    reap();
    throw_failed(fmt::format("cannot run '{}'", words.front()), start.error);
  }
  input_ = Pipe::release(input.write_end);
  streams_ = {Pipe::release(output.read_end), Pipe::release(errors.read_end)};
  for (const int stream : {input_, streams_[0], streams_[1]}) {
    ::fcntl(stream, F_SETFL, O_NONBLOCK);
  }
}

ChildProcess::~ChildProcess() {
  close_input();
  kill();
  reap();
  for (const int stream : streams_) {
    if (stream >= 0) ::close(stream);
  }
}

bool ChildProcess::write(std::string_view text) {
  constexpr double kPatienceS = 1000;
  while (!text.empty()) {
    if (!write_some(text, kPatienceS)) return false;
  }
  return input_ >= 0;
}

bool ChildProcess::write_some(std::string_view& text, double timeout_s) {
  pollfd polled{input_, POLLOUT, 0};
  if (input_ < 0) return false;
  if (::poll(&polled, 1, static_cast<int>(timeout_s * 1000) + 1) <= 0) return true;
  // A reader that has gone away is an answer here, not a reason to die.
  sigset_t pipe_signal;
  sigset_t before;
  sigemptyset(&pipe_signal);
  sigaddset(&pipe_signal, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &pipe_signal, &before);
  const ssize_t count = ::write(input_, text.data(), text.size());
  const bool is_read = count >= 0 || errno == EINTR || errno == EAGAIN;
  if (count > 0) text.remove_prefix(static_cast<std::size_t>(count));
  if (!is_read) {
    const timespec at_once{};
    sigtimedwait(&pipe_signal, nullptr, &at_once);
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return is_read;
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

bool ChildProcess::ends_within(double timeout_s) const {
  if (report_ < 0) return true;
  pollfd report{report_, POLLIN, 0};
  return ::poll(&report, 1, static_cast<int>(timeout_s * 1000) + 1) > 0;
}

void ChildProcess::ask_to_end() const {
  if (!ends_within(0)) ::kill(pid_, SIGTERM);
}

void ChildProcess::kill() {
  if (life_ >= 0) ::close(std::exchange(life_, -1));
}

void ChildProcess::reap() noexcept {
  if (reaped_) return;
  const int status = read_end(report_);
  if (WIFSIGNALED(status)) exit_.signal = WTERMSIG(status);
  if (WIFEXITED(status)) exit_.status = WEXITSTATUS(status);
  rusage use{};
  pid_t ended = 0;
  while ((ended = ::wait4(keeper_, nullptr, 0, &use)) < 0 && errno == EINTR) {
  }
  if (ended == keeper_) note_peak_memory(use.ru_maxrss);
  ::close(std::exchange(report_, -1));
  kill();  // the keeper has gone: this only closes the pipe
  reaped_ = true;
}

ChildExit ChildProcess::wait() {
  reap();
  return exit_;
}

ChildRun run_child(const ChildOptions& options, std::string_view input, const ChildLimits& limits) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  constexpr double kShortS = 0.05;  // for the one side of the pipes, while the other may be full
  ChildProcess child(options);
  if (input.empty()) child.close_input();
  ChildRun run;
  bool is_silent = false;  // it has closed its streams
  bool is_asked = false;   // to end
  double wall_s = limits.wall_s;
  for (bool ended = false; !ended;) {
    const double gone_s = std::chrono::duration<double>(Clock::now() - start).count();
    if (limits.end != nullptr && *limits.end && !is_asked) {
      is_asked = true;
      child.ask_to_end();
      wall_s = std::min(wall_s, gone_s + kSecondsToEnd);
    }
    const double left_s = wall_s - gone_s;
    if (left_s <= 0) {
      run.timed_out = !is_asked;
      child.kill();
      break;
    }
    double wait_s = std::min(left_s, 1.0);
    if (const std::size_t before = input.size(); before > 0) {
      if (!child.write_some(input, std::min(left_s, kShortS))) input = {};
      if (input.empty()) child.close_input();
      wait_s = input.size() < before ? 0 : std::min(left_s, kShortS);
    }
    if (is_silent) {
      ended = child.ends_within(wait_s);
      continue;
    }
    const ChildOutput part = child.read(wait_s);
    run.output += part.output;
    run.errors += part.errors;
    if (run.output.size() + run.errors.size() > limits.output_bytes) {
      throw Error(ErrorKind::failed, "the program prints without end", options.command.front());
    }
    is_silent = part.ended;
  }
  run.exit = child.wait();
  run.broken_off = is_asked && !run.exit.ok();
  return run;
}

std::string signal_name(int signal) {
  const char* name = ::sigabbrev_np(signal);
  return name != nullptr ? fmt::format("SIG{}", name) : fmt::format("signal {}", signal);
}

std::string told_of_end(const ChildExit& exit, std::string_view errors) {
  constexpr std::size_t kMost = 400;  // bytes of what it said
  const std::string how =
      exit.signal != 0 ? signal_name(exit.signal) : fmt::format("status {}", exit.status);
  std::string_view said = trimmed(errors);
  if (said.empty()) return how + ", with nothing on its standard error";
  said.remove_prefix(said.size() - std::min(said.size(), kMost));
  // No half of a character.
  while (!said.empty() && (said.front() & 0xC0) == 0x80) said.remove_prefix(1);
  return fmt::format("{}: {}", how, said);
}

ProcessUse process_tree_use(pid_t pid) {
  std::ifstream stat(fmt::format("/proc/{}/stat", pid));
  std::string line;
  if (!std::getline(stat, line)) return {};
  const bool is_keeper = line.find(fmt::format("({})", kKeeperName)) != std::string::npos;
  // Fields after the name, which stands in brackets and may hold blanks: 14 and 15 are user and
  // system ticks, 24 the resident pages (proc(5)).
  std::istringstream fields(line.substr(line.rfind(')') + 1));
  std::vector<std::string> field(25);
  for (std::size_t i = 3; i <= 24; ++i) fields >> field[i];
  ProcessUse use;
  use.cpu_s = (std::strtod(field[14].c_str(), nullptr) + std::strtod(field[15].c_str(), nullptr)) /
              static_cast<double>(::sysconf(_SC_CLK_TCK));
  if (!is_keeper) {
    use.resident_mib = std::strtod(field[24].c_str(), nullptr) *
                       static_cast<double>(::sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0);
  }
  std::ifstream children(fmt::format("/proc/{}/task/{}/children", pid, pid));
  for (pid_t child = 0; children >> child;) {
    const ProcessUse part = process_tree_use(child);
    use.cpu_s += part.cpu_s;
    use.resident_mib += part.resident_mib;
  }
  return use;
}

}  // namespace tribench
