// SPDX-License-Identifier: MIT
//
// Every parameter of every method over values that nobody means: each is a number in range, or is
// refused with the range. A signal and a hang are the defects this looks for.
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "algorithms/registry.hpp"
#include "foundation/child_process.hpp"
#include "foundation/number_text.hpp"
#include "foundation/random.hpp"
#include "harness/cli/program.hpp"
#include "tests/support/run_program.hpp"

namespace tribench::testing {
namespace {

struct Sweep {
  std::uint64_t evaluations;
  double seconds;  // of CPU, told to the method
  double hang_s;   // wall time after which it counts as a hang
};

struct Tally {
  int cases = 0;
  int fitted = 0;
  int refused = 0;
  int too_little = 0;  // in range, but the budget did not reach a formula
};

std::vector<std::string> values_of(const ParameterSpec& spec) {
  std::set<std::string> values = {"0",   "-1", "0.5",  "1e9",
                                  "nan", "",   "text", "18446744073709551615"};
  values.insert(spec.choices.begin(), spec.choices.end());
  if (!std::holds_alternative<std::string>(spec.default_value) &&
      !std::holds_alternative<bool>(spec.default_value)) {
    for (const double bound : {spec.low, spec.high}) {
      for (const double off : {-1.0, 0.0, 1.0}) values.insert(fmt::format("{}", bound + off));
    }
  }
  return {values.begin(), values.end()};
}

// Whether a value can be one of the parameter's: a number in its range, where it is a number.
bool spec_may_take(const ParameterSpec& spec, const std::string& value) {
  if (std::holds_alternative<std::string>(spec.default_value) ||
      std::holds_alternative<bool>(spec.default_value)) {
    return true;
  }
  const std::optional<double> number = read_number<double>(value);
  if (!number) return false;
  const bool is_besides = spec.besides && *number == *spec.besides;
  return is_besides || (spec.low <= *number && *number <= spec.high);
}

std::string friction_csv() {
  std::string text = "v,g,tau\n";
  RandomStream random(key_of("parameter sweep"));
  for (int row = 0; row < 60; ++row) {
    const double v = random.uniform(-2, 2);
    const double g = random.uniform(-20, 20);
    text += fmt::format("{:.6f},{:.6f},{:.6f}\n", v, g,
                        (v > 0 ? 3 : -3) + 2 * v + 0.05 * g * v + 0.05 * random.normal());
  }
  return text;
}

class ParameterSweep : public ::testing::Test {
 protected:
  void SetUp() override { write_text(folder_ / "friction.csv", friction_csv()); }

  // One parameter's values, in a process of their own: begun as a copy of this one, as starts of
  // the program's file would take most of the time. What ends or hangs it is the value that it has
  // not answered; the others have another process.
  void check(const std::string& method, const ParameterSpec& spec, const Sweep& sweep,
             std::span<const std::string> values) {
    const std::string& name = spec.name;
    while (!values.empty()) {
      int ends[2];
      ASSERT_EQ(::pipe(ends), 0);
      const pid_t child = start(method, name, sweep, values, ends[1]);
      ::close(ends[1]);
      ASSERT_GT(child, 0);
      std::size_t answered = 0;
      bool is_alive = true;
      while (is_alive && answered < values.size()) {
        SCOPED_TRACE(fmt::format("{} --parameter '{}={}'", method, name, values[answered]));
        is_alive = judge_next(child, ends[0], answered, sweep.hang_s,
                              spec_may_take(spec, values[answered]));
        ++answered;
      }
      ::close(ends[0]);
      if (is_alive) ::waitpid(child, nullptr, 0);
      values = values.subspan(answered);
    }
  }

  // The status of the value with this number, as the process tells it; false where it tells none.
  bool judge_next(pid_t child, int from, std::size_t number, double hang_s, bool may_be_taken) {
    pollfd told = {from, POLLIN, 0};
    const bool is_told = ::poll(&told, 1, static_cast<int>(1000 * hang_s)) == 1;
    int status = 0;
    if (is_told && ::read(from, &status, sizeof status) == sizeof status) {
      judge({status, 0}, read_text(errors_of(number)), may_be_taken);
      return true;
    }
    if (!is_told) {
      ::kill(child, SIGKILL);
      ADD_FAILURE() << "hangs";
    }
    ::waitpid(child, &status, 0);
    if (is_told) {
      judge(
          {WIFEXITED(status) ? WEXITSTATUS(status) : 0, WIFSIGNALED(status) ? WTERMSIG(status) : 0},
          read_text(errors_of(number)), may_be_taken);
    }
    return false;
  }

  std::filesystem::path errors_of(std::size_t number) const {
    return folder_ / ("errors" + std::to_string(number));
  }

  // Tells the status of each value that it comes to.
  pid_t start(const std::string& method, const std::string& name, const Sweep& sweep,
              std::span<const std::string> values, int to) {
    std::fflush(nullptr);  // what is not written yet would be written twice
    const pid_t child = ::fork();
    if (child != 0) return child;
    if (std::freopen("/dev/null", "r", stdin) == nullptr ||
        std::freopen("/dev/null", "w", stdout) == nullptr) {
      ::_exit(125);
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (std::freopen(errors_of(i).c_str(), "w", stderr) == nullptr) ::_exit(125);
      std::vector<std::string> words = {"tribench",
                                        "fit",
                                        (folder_ / "friction.csv").string(),
                                        "--target",
                                        "tau",
                                        "--inputs",
                                        "v,g",
                                        "--method",
                                        method,
                                        "--parameter",
                                        fmt::format("{}={}", name, values[i]),
                                        "--evaluations",
                                        std::to_string(sweep.evaluations),
                                        "--seconds",
                                        fmt::format("{}", sweep.seconds)};
      std::vector<char*> arguments;
      for (std::string& word : words) arguments.push_back(word.data());
      arguments.push_back(nullptr);
      const int status = run_program(static_cast<int>(words.size()), arguments.data(), registry_);
      std::fflush(nullptr);
      if (::write(to, &status, sizeof status) != sizeof status) ::_exit(125);
    }
    ::_exit(0);
  }

  void judge(const ChildExit& exit, const std::string& errors, bool may_be_taken) {
    ++tally_.cases;
    ASSERT_EQ(exit.signal, 0) << signal_name(exit.signal) << "\n" << errors;
    if (!may_be_taken) {
      EXPECT_EQ(exit.status, 2) << "taken, and out of its range";
    }
    if (exit.status == 0) {
      ++tally_.fitted;
    } else if (exit.status == 2) {
      ++tally_.refused;
      EXPECT_NE(errors.find("; "), std::string::npos) << "no mend: " << errors;
    } else {
      ++tally_.too_little;
      EXPECT_NE(errors.find("no formula"), std::string::npos) << errors;
    }
  }

  void run(const Sweep& sweep) {
    for (const AlgorithmEntry& entry : registry_.entries()) {
      for (const ParameterSpec& spec : entry.parameters) {
        check(entry.name, spec, sweep, values_of(spec));
      }
    }
    fmt::print("{} cases: {} fitted, {} refused, {} beyond the budget; 0 signals, 0 hangs\n",
               tally_.cases, tally_.fitted, tally_.refused, tally_.too_little);
    EXPECT_GT(tally_.cases, 900);
    EXPECT_GT(tally_.fitted, 300);
    EXPECT_GT(tally_.refused, 500);
  }

  Registry registry_;
  TemporaryFolder folder_;
  Tally tally_;
};

TEST_F(ParameterSweep, AnswersEveryValueWithATinyBudget) { run({20'000, 0.2, 30}); }

// For the night: with a budget that lets the parameters act.
TEST_F(ParameterSweep, DISABLED_AnswersEveryValueWithARealBudget) { run({100'000'000, 2, 60}); }

}  // namespace
}  // namespace tribench::testing
