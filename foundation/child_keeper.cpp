// SPDX-License-Identifier: MIT
#include "foundation/child_keeper.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <initializer_list>

// Everything below that runs in the child keeps to what signal-safety(7) allows: no allocation, no
// locks, no exceptions; all memory is on the stack.
namespace tribench {
namespace {

template <typename Value>
bool write_value(int descriptor, const Value& value) {
  return ::write(descriptor, &value, sizeof value) == sizeof value;
}

template <typename Value>
bool read_value(int descriptor, Value& value) {
  auto* bytes = reinterpret_cast<char*>(&value);
  std::size_t done = 0;
  while (done < sizeof value) {
    const ssize_t count = ::read(descriptor, bytes + done, sizeof value - done);
    if (count == 0 || (count < 0 && errno != EINTR)) return false;
    if (count > 0) done += static_cast<std::size_t>(count);
  }
  return true;
}

// The program starts with no signal blocked and the default answer to those that are handled here.
void reset_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGPIPE, SIGXFSZ, SIGCHLD}) {
    struct sigaction defaults = {};
    defaults.sa_handler = SIG_DFL;
    ::sigaction(signal, &defaults, nullptr);
  }
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
}

// In the program's process: says its pid and becomes the program, or says why not.
[[noreturn]] void become(const KeptProgram& program, int said, int why_not) {
  write_value(said, ::getpid());
  ::setpgid(0, 0);
  int streams[3];  // out of the way first: one of them may be 0, 1 or 2 itself
  for (int k = 0; k < 3; ++k) streams[k] = ::fcntl(program.streams[k], F_DUPFD_CLOEXEC, 3);
  for (int k = 0; k < 3; ++k) ::dup2(streams[k], k);
  if (program.folder == nullptr || ::chdir(program.folder) == 0) {
    reset_signals();
    ::execve(program.file, program.words, program.environment);
  }
  write_value(why_not, errno);
  ::_exit(127);
}

// Sends SIGKILL to every child of this process; theirs become children of this one as they die.
void kill_children() {
  // The keeper has one thread: its children are all in one file.
  const int list = ::open("/proc/thread-self/children", O_RDONLY | O_CLOEXEC);
  if (list < 0) return;
  char text[4096];
  pid_t pid = 0;
  for (ssize_t count = 0; (count = ::read(list, text, sizeof text)) > 0;) {
    for (ssize_t i = 0; i < count; ++i) {
      if (text[i] >= '0' && text[i] <= '9') {
        pid = 10 * pid + (text[i] - '0');
      } else {
        if (pid > 1) ::kill(pid, SIGKILL);
        pid = 0;
      }
    }
  }
  if (pid > 1) ::kill(pid, SIGKILL);
  ::close(list);
}

// Ends and reaps all that is left, round by round.
void end_all() {
  for (;;) {
    kill_children();
    if (::waitpid(-1, nullptr, 0) < 0 && errno == ECHILD) return;
  }
}

// Last: a scratch folder is removed once no process can write there any more.
void remove_folder(const char* folder) {
  const pid_t pid = ::_Fork();
  if (pid == 0) {
    const char* words[] = {"rm", "-rf", "--", folder, nullptr};
    const char* none[] = {nullptr};
    ::execve("/bin/rm", const_cast<char* const*>(words), const_cast<char* const*>(none));
    ::_exit(127);
  }
  while (pid > 0 && ::waitpid(pid, nullptr, 0) < 0 && errno == EINTR) {
  }
}

// True where the stand-in has ended; reaps the orphans that have ended too.
bool reap_ended(pid_t stand_in) {
  bool has_ended = false;
  for (pid_t pid = 0; (pid = ::waitpid(-1, nullptr, WNOHANG)) > 0;) {
    has_ended = has_ended || pid == stand_in;
  }
  return has_ended;
}

// Until the program has ended, the other side has closed the pipe, or the keeper is asked to end.
void keep(pid_t stand_in, int life, int signals) {
  for (;;) {
    pollfd polled[2] = {{life, 0, 0}, {signals, POLLIN, 0}};
    if (::poll(polled, 2, -1) < 0 && errno != EINTR) return;
    if (polled[0].revents != 0) return;
    if (polled[1].revents == 0) continue;
    signalfd_siginfo signal;
    if (::read(signals, &signal, sizeof signal) != sizeof signal) continue;
    if (signal.ssi_signo != SIGCHLD) return;
    if (reap_ended(stand_in)) return;
  }
}

// Nothing of the other process may be held open (a pipe's end, a lock, a terminal) but these.
template <int count>
void keep_open(int (&descriptors)[count]) {
  constexpr int kFirst = 3;
  for (int& each : descriptors) each = ::fcntl(each, F_DUPFD, kFirst + count);
  for (int k = 0; k < count; ++k) descriptors[k] = ::dup2(descriptors[k], kFirst + k);
  ::close_range(kFirst + count, ~0U, 0);
  const int nothing = ::open("/dev/null", O_RDWR);
  for (int k = 0; k < kFirst; ++k) ::dup2(nothing, k);
  ::close(nothing);
}

// The program's parent, which says the program's status and ends. A program that kills its parent
// kills this one and not the keeper, to which it falls back.
[[noreturn]] void stand_in(const KeptProgram& program, int said, int why_not) {
  const pid_t child = ::_Fork();
  if (child == 0) become(program, said, why_not);
  if (child < 0) write_value(why_not, errno);
  int open_here[] = {said};
  keep_open(open_here);
  int status = 0;
  if (child > 0 && ::waitpid(child, &status, 0) == child) write_value(open_here[0], status);
  ::_exit(0);
}

[[noreturn]] void run_keeper(const KeptProgram& program) {
  ::setsid();
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  ::prctl(PR_SET_NAME, kKeeperName);
  sigset_t kept;
  sigfillset(&kept);
  ::sigprocmask(SIG_SETMASK, &kept, nullptr);
  sigemptyset(&kept);
  for (const int signal : {SIGCHLD, SIGTERM, SIGINT, SIGHUP}) sigaddset(&kept, signal);
  const int signals = ::signalfd(-1, &kept, SFD_CLOEXEC);
  int why_not[2];
  int said[2];
  if (signals < 0 || ::pipe2(why_not, O_CLOEXEC) != 0 || ::pipe2(said, O_CLOEXEC) != 0) {
    write_value(program.report, KeeperStart{-1, errno});
    ::_exit(127);
  }
  const pid_t parent = ::_Fork();
  if (parent == 0) stand_in(program, said[1], why_not[1]);
  KeeperStart start{-1, parent < 0 ? errno : 0};
  ::close(why_not[1]);
  ::close(said[1]);
  if (parent > 0) {
    read_value(said[0], start.pid);
    read_value(why_not[0], start.error);
  }
  int open_here[] = {program.life, program.report, signals, said[0]};
  keep_open(open_here);
  const auto [life, report, asked, told] = open_here;
  write_value(report, start);
  if (start.error == 0) keep(parent, life, asked);
  end_all();
  if (program.scratch != nullptr) remove_folder(program.scratch);
  int status = SIGKILL;  // as waitpid gives it: nobody is left to say more
  read_value(told, status);
  write_value(report, status);
  ::_exit(0);
}

}  // namespace

pid_t start_keeper(const KeptProgram& program) {
  // _Fork, not fork: handlers that libraries have registered for a fork may take locks, and one
  // that stops a pool of threads would stop ours.
  const pid_t pid = ::_Fork();
  if (pid == 0) run_keeper(program);
  return pid;
}

KeeperStart read_start(int report) {
  KeeperStart start;
  if (!read_value(report, start)) return {-1, ECHILD};
  return start;
}

int read_end(int report) {
  int status = 0;
  return read_value(report, status) ? status : SIGKILL;  // as waitpid gives it for a signal
}

}  // namespace tribench
