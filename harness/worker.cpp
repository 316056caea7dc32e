// SPDX-License-Identifier: MIT
#include "harness/worker.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <iostream>
#include <new>
#include <nlohmann/json.hpp>
#include <string>

#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "harness/run_cell.hpp"

namespace tribench {
namespace {

// Standard output is for answers alone: they get a descriptor of their own, and what a method or a
// library prints goes to standard error.
int take_over_output() {
  const int answers = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 10);
  if (answers < 0) throw Error(ErrorKind::failed, "the worker has no standard output");
  ::dup2(STDERR_FILENO, STDOUT_FILENO);
  return answers;
}

void send(int answers, const char* name, const std::string& json) {
  const std::string line = fmt::format("{{\"{}\":{}}}\n", name, json);
  std::string_view rest = line;
  while (!rest.empty()) {
    const ssize_t count = ::write(answers, rest.data(), rest.size());
    if (count > 0) {
      rest.remove_prefix(static_cast<std::size_t>(count));
    } else if (errno != EINTR) {
      ::_exit(1);  // the reader is gone
    }
  }
}

// The kernel holds the memory limit: allocation fails. Programs started from here inherit it. CPU
// and wall time are watched from outside: a kernel limit on CPU would make the process's CPU clock
// tick in steps of milliseconds, and every time measured with it.
void set_limits([[maybe_unused]] const CellLimits& limits) {
#ifndef TRIBENCH_SANITIZED  // whose shadow memory would count; what is resident is watched anyway
  rlimit memory{};
  getrlimit(RLIMIT_DATA, &memory);
  memory.rlim_cur = static_cast<rlim_t>(limits.memory_mib * 1024 * 1024);
  setrlimit(RLIMIT_DATA, &memory);
#endif
  rlimit core{};  // a crash is expected here and needs no core file
  setrlimit(RLIMIT_CORE, &core);
}

}  // namespace

int run_worker(const Registry& registry) {
  const int answers = take_over_output();
  CellRunner runner(registry);
  for (std::string line; std::getline(std::cin, line);) {
    try {
      const CellTask task = parse_task(line);
      set_limits(task.limits);
      const CellResult result = runner.run(task, [answers](const Record& record) {
        send(answers, "started", print_result({record, {}, {}}));
      });
      send(answers, "finished", print_result(result));
    } catch (const Error& error) {
      // Nothing a cell can do wrong comes here: CellRunner makes a record of it.
      send(answers, "environment", write_json(nlohmann::json(error.what())));
    } catch (const std::bad_alloc&) {
      send(answers, "out_of_memory", "true");
      return 1;
    }
  }
  return 0;
}

}  // namespace tribench
