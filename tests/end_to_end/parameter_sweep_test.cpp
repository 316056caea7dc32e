// SPDX-License-Identifier: MIT
//
// Every parameter of every method over values that nobody means: each is a number in range, or is
// refused with the range. A signal and a hang are the defects this looks for.
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <set>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "algorithms/registry.hpp"
#include "foundation/child_process.hpp"
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

std::set<std::string> values_of(const ParameterSpec& spec) {
  std::set<std::string> values = {"0",   "-1", "0.5",  "1e9",
                                  "nan", "",   "text", "18446744073709551615"};
  values.insert(spec.choices.begin(), spec.choices.end());
  if (!std::holds_alternative<std::string>(spec.default_value) &&
      !std::holds_alternative<bool>(spec.default_value)) {
    for (const double bound : {spec.low, spec.high}) {
      for (const double off : {-1.0, 0.0, 1.0}) values.insert(fmt::format("{}", bound + off));
    }
  }
  return values;
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

  void check(const std::string& method, const std::string& name, const std::string& value,
             const Sweep& sweep) {
    SCOPED_TRACE(fmt::format("{} --parameter '{}={}'", method, name, value));
    const std::filesystem::path errors = folder_ / "errors";
    const pid_t child =
        start({"tribench", "fit", (folder_ / "friction.csv").string(), "--target", "tau",
               "--inputs", "v,g", "--method", method, "--parameter",
               fmt::format("{}={}", name, value), "--evaluations",
               std::to_string(sweep.evaluations), "--seconds", fmt::format("{}", sweep.seconds)},
              errors);
    ASSERT_GT(child, 0);
    const auto begin = std::chrono::steady_clock::now();
    int status = 0;
    while (::waitpid(child, &status, WNOHANG) == 0) {
      const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
      if (taken.count() > sweep.hang_s) {
        ::kill(child, SIGKILL);
        ::waitpid(child, &status, 0);
        ADD_FAILURE() << "hangs";
        return;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    judge({WIFEXITED(status) ? WEXITSTATUS(status) : 0, WIFSIGNALED(status) ? WTERMSIG(status) : 0},
          read_text(errors));
  }

  // The program in a process of its own, begun as a copy of this one: a thousand starts of the file
  // would take most of the time.
  static pid_t start(std::vector<std::string> words, const std::filesystem::path& errors) {
    std::fflush(nullptr);  // what is not written yet would be written twice
    const pid_t child = ::fork();
    if (child != 0) return child;
    if (std::freopen("/dev/null", "r", stdin) == nullptr ||
        std::freopen("/dev/null", "w", stdout) == nullptr ||
        std::freopen(errors.c_str(), "w", stderr) == nullptr) {
      ::_exit(125);
    }
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const int status = run_program(static_cast<int>(words.size()), arguments.data(), Registry());
    std::fflush(nullptr);
    ::_exit(status);
  }

  void judge(const ChildExit& exit, const std::string& errors) {
    ++tally_.cases;
    ASSERT_EQ(exit.signal, 0) << signal_name(exit.signal) << "\n" << errors;
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
    const Registry registry;
    for (const AlgorithmEntry& entry : registry.entries()) {
      for (const ParameterSpec& spec : entry.parameters) {
        for (const std::string& value : values_of(spec)) {
          check(entry.name, spec.name, value, sweep);
        }
      }
    }
    fmt::print("{} cases: {} fitted, {} refused, {} beyond the budget; 0 signals, 0 hangs\n",
               tally_.cases, tally_.fitted, tally_.refused, tally_.too_little);
    EXPECT_GT(tally_.cases, 900);
    EXPECT_GT(tally_.fitted, 300);
    EXPECT_GT(tally_.refused, 500);
  }

  TemporaryFolder folder_;
  Tally tally_;
};

TEST_F(ParameterSweep, AnswersEveryValueWithATinyBudget) { run({20'000, 0.2, 30}); }

// For the night: with a budget that lets the parameters act.
TEST_F(ParameterSweep, DISABLED_AnswersEveryValueWithARealBudget) { run({100'000'000, 2, 60}); }

}  // namespace
}  // namespace tribench::testing
