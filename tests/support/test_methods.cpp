// SPDX-License-Identifier: MIT
#include "tests/support/test_methods.hpp"

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <new>
#include <stdexcept>
#include <thread>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "foundation/error.hpp"
#include "foundation/scratch_folder.hpp"

namespace tribench {
namespace {

FitResult mean_of_target(const FitContext& context) {
  double sum = 0;
  double count = 0;
  for (const double y : context.data.target) {
    if (!std::isfinite(y)) continue;
    sum += y;
    count += 1;
  }
  FitResult result;
  result.front.push_back(Expression::constant(count > 0 ? sum / count : 0));
  return result;
}

// A line through random numbers: small, and different for every stream.
FitResult search(FitContext& context) {
  FitResult result = mean_of_target(context);
  Evaluator evaluator;
  std::vector<double> values(context.data.rows());
  RandomStream random = context.random;
  double best = std::numeric_limits<double>::infinity();
  Expression chosen = result.front.front();
  for (;;) {
    const Expression line =
        Expression::binary(Op::add, Expression::constant(random.normal()),
                           Expression::binary(Op::mul, Expression::constant(random.uniform(0, 30)),
                                              Expression::variable(0)));
    if (!context.budget.spend(node_rows(line, values.size()))) break;
    evaluator.evaluate(line, context.data.table(), values);
    double sum = 0;
    for (std::size_t r = 0; r < values.size(); ++r) {
      const double error = values[r] - context.data.target[r];
      sum += error * error;
    }
    if (!(sum < best)) continue;
    best = sum;
    chosen = line;
    if (context.progress != nullptr) context.progress->improved(sum, context.budget.spent());
  }
  result.front.push_back(chosen);
  result.chosen = 1;
  return result;
}

FitResult spin(FitContext& context, double seconds) {
  const double start = process_cpu_seconds();
  volatile double sink = 0;
  while (process_cpu_seconds() - start < seconds) {
    for (int i = 0; i < 1000; ++i) sink = sink + 1;
  }
  return mean_of_target(context);
}

// Of each block one byte is written: what it asks for counts, and some machines take a second for
// the pages of a quarter of a gigabyte.
[[noreturn]] FitResult eat_memory() {
  std::vector<std::unique_ptr<char[]>> hoard;
  for (;;) {
    hoard.push_back(std::make_unique_for_overwrite<char[]>(8U << 20));
    hoard.back()[0] = 'x';
  }
}

[[noreturn]] FitResult fill_disk() {
  const ScratchFolder folder;
  std::ofstream stream(folder.path() / "fill");
  const std::string block(1U << 20, 'x');
  for (int i = 0; i < 64 && stream; ++i) stream << block << std::flush;
  throw Error(ErrorKind::failed, "no room is left on the device");
}

// Ends the process by the signal itself, also where a sanitizer would catch it and exit with 1.
void crash() {
  std::signal(SIGSEGV, SIG_DFL);
  std::raise(SIGSEGV);
}

enum class Behaviour {
  mean,
  search,
  sleep,
  spin,
  crash,
  abort,
  hang,
  busy_hang,
  eat_memory,
  exit,
  throws,
  nothing,
  pole,
  fill_disk,
  flaky
};

class TestMethod : public Regressor {
 public:
  TestMethod(Behaviour behaviour, double seconds) : behaviour_(behaviour), seconds_(seconds) {}

  FitResult fit(FitContext& context) const override {
    switch (behaviour_) {
      case Behaviour::mean:
        return mean_of_target(context);
      case Behaviour::search:
        return search(context);
      case Behaviour::sleep:
        std::this_thread::sleep_for(std::chrono::duration<double>(seconds_));
        return mean_of_target(context);
      case Behaviour::spin:
        return spin(context, seconds_);
      case Behaviour::crash:
        crash();
        break;
      case Behaviour::abort:
        std::thread([] { throw std::runtime_error("nobody"); }).join();
        break;
      case Behaviour::hang:
        for (;;) ::pause();
      case Behaviour::busy_hang:
        return spin(context, 1e9);
      case Behaviour::eat_memory:
        return eat_memory();
      case Behaviour::exit:
        ::_exit(7);
      case Behaviour::throws:
        throw std::runtime_error("a method's own words");
      case Behaviour::nothing:
        return {};
      case Behaviour::pole:
        return pole(context);
      case Behaviour::fill_disk:
        return fill_disk();
      case Behaviour::flaky:
        return flaky(context);
    }
    return {};
  }

 private:
  // 1 / (x - c) with c between two data points.
  static FitResult pole(const FitContext&) {
    FitResult result;
    result.front.push_back(Expression::binary(
        Op::div, Expression::constant(1),
        Expression::binary(Op::sub, Expression::variable(0), Expression::constant(0.0123456789))));
    return result;
  }

  // Counts the fits of this process: what a real method must not do, and a leak in one does.
  static FitResult flaky(const FitContext& context) {
    static int fits = 0;
    if (++fits > 1) crash();
    return mean_of_target(context);
  }

  Behaviour behaviour_;
  double seconds_;
};

template <Behaviour behaviour>
std::unique_ptr<Regressor> make(const Parameters& parameters, const MakeMethod&) {
  return std::make_unique<TestMethod>(behaviour, parameters.number("seconds"));
}

template <Behaviour behaviour>
void add(Registry& registry, const char* name, bool fixed_form = false) {
  registry.add({name,
                "a method of the tests",
                {{"seconds", "how long, in s", 0.05, 0, 1e6, {}}},
                fixed_form,
                make<behaviour>});
}

}  // namespace

void add_test_methods(Registry& registry) {
  add<Behaviour::mean>(registry, "test_mean", true);
  add<Behaviour::search>(registry, "test_search");
  add<Behaviour::sleep>(registry, "test_sleep", true);
  add<Behaviour::spin>(registry, "test_spin", true);
  add<Behaviour::crash>(registry, "test_crash", true);
  add<Behaviour::abort>(registry, "test_abort", true);
  add<Behaviour::hang>(registry, "test_hang", true);
  add<Behaviour::busy_hang>(registry, "test_busy_hang", true);
  add<Behaviour::eat_memory>(registry, "test_eat_memory", true);
  add<Behaviour::exit>(registry, "test_exit", true);
  add<Behaviour::throws>(registry, "test_throw", true);
  add<Behaviour::nothing>(registry, "test_nothing", true);
  add<Behaviour::pole>(registry, "test_pole");
  add<Behaviour::fill_disk>(registry, "test_fill_disk", true);
  add<Behaviour::flaky>(registry, "test_flaky", true);
}

}  // namespace tribench
