// SPDX-License-Identifier: MIT
//
// The exported step, compiled and run over a motion, against columns and evaluator: C bit by bit in
// both precisions, Python and MATLAB (Octave) closely.
#include "algorithms/states/state_export.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "foundation/error.hpp"
#include "foundation/random.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"

namespace tribench {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::output_of;

const std::vector<std::string> kNames = {"v", "g", "sgn_v"};

// All laws, all in one formula, and one with names that clash with the code's own.
const std::vector<std::string>& texts() {
  static const std::vector<std::string> kTexts = {
      "z = lugre(v, sliding=0.0002, breakaway=0.0003, stribeck_velocity=0.01); 20000*z + "
      "30*(v - abs(v)*z/(0.0002 + 0.0001*exp(-(v/0.01)^2))) + 4*v",
      "a = lag(v, time_constant=0.02); b = dahl(v, sliding=0.0003); c = slip(v, limit=0.0004); "
      "d = backlash(v, g, half_gap=0.001, drift=0.003); e = warmth(v, g, time_constant=1.5); "
      "f = warmth(v, time_constant=0.7); h = gms(v, limit=0.0002, breakaway=0.0003, "
      "stribeck_velocity=0.01, attraction=0.02); "
      "a + 3*b*(1 - 0.2*e) + 50*c - d^3 + f + 900*h*abs(g) + sgn_v*exp(-abs(g)) + 0.1*g",
  };
  return kTexts;
}

struct Sampled {
  std::vector<double> v;
  std::vector<double> g;
  std::vector<double> dt;
};

Sampled make_motion() {
  Sampled motion;
  RandomStream random(8);
  double t = 0;
  for (int r = 0; r < 3000; ++r) {
    motion.dt.push_back(r == 0 ? 0.0 : 0.001 + 0.001 * random.uniform());
    t += motion.dt.back();
    motion.v.push_back(r % 500 < 20 ? 0.0 : 0.03 * std::sin(5 * t) + 0.004 * random.normal());
    motion.g.push_back(2 * std::cos(t));
  }
  return motion;
}

// What the program itself makes of it, in T.
template <typename T, typename Evaluate>
std::vector<T> expected(const StatefulFormula& formula, const Sampled& motion) {
  Evaluate evaluator;
  std::vector<T> values;
  std::vector<BasicStateMemory<T>> memories(formula.states.size());
  std::vector<T> before;
  for (std::size_t r = 0; r < motion.v.size(); ++r) {
    const T v = static_cast<T>(motion.v[r]);
    std::vector<T> point = {v, static_cast<T>(motion.g[r]),
                            static_cast<T>(v > 0   ? 1
                                           : v < 0 ? -1
                                                   : 0)};
    for (std::size_t k = 0; k < formula.states.size(); ++k) {
      const StateDeclaration& state = formula.states[k];
      const auto drive = [&state](const std::vector<T>& at) {
        return BasicDrive<T>{at[state.drives[0]],
                             state.drives.size() > 1 ? at[state.drives[1]] : T(1)};
      };
      const std::vector<T> p(state.parameters.begin(), state.parameters.end());
      if (r == 0) {
        memories[k] = state_at_rest(state.law, drive(point));
      } else {
        advance(state.law, std::span<const T>(p), memories[k], drive(before), drive(point),
                static_cast<T>(motion.dt[r]));
      }
    }
    before = point;
    for (const BasicStateMemory<T>& memory : memories) point.push_back(memory.z);
    values.push_back(evaluator.evaluate_at(formula.formula, point));
  }
  return values;
}

fs::path fresh_folder(const std::string& name) {
  const fs::path folder = testing::scratch_folder() / ("tribench_states_" + name);
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

bool runs(const std::string& command) { return std::system(command.c_str()) == 0; }

bool has(const std::string& program) {
  return runs(fmt::format("command -v {} >/dev/null 2>&1", program));
}

void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

std::string code_of(const std::string& text, CodeForm form, bool single = false) {
  const StatefulFormula formula = parse_stateful(text, kNames);
  StatefulExportOptions options;
  options.single = single;
  options.box = parse_box("v=-1:1,g=-3:3");
  return export_stateful(formula, kNames, form, options);
}

// A library of the step, for this processor.
void* compile(const std::string& code, const std::string& name) {
  const fs::path folder = fresh_folder(name);
  write(folder / "step.c", code);
  const std::string library = (folder / "step.so").string();
  const std::string command = fmt::format(
      "cc -std=c99 -O2 -march=native -ffp-contract=off -Wall -Wextra -Werror -Wdouble-promotion "
      "-fPIC -shared -o {} {} -lm",
      library, (folder / "step.c").string());
  if (!runs(command)) return nullptr;
  return dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
}

// Larger than any state of these formulas.
struct alignas(16) Memory {
  unsigned char bytes[512];
};

// What stands under the clock: a sanitizer's checks of this loop are no part of a step.
template <typename T>
__attribute__((no_sanitize("address", "undefined", "thread"))) void run_steps(
    T (*step)(Memory*, T, T, T), Memory* memory, const Sampled& motion, T* values) {
  const double* const v = motion.v.data();
  const double* const g = motion.g.data();
  const double* const dt = motion.dt.data();
  const std::size_t rows = motion.v.size();
  for (std::size_t r = 0; r < rows; ++r) {
    values[r] = step(memory, static_cast<T>(v[r]), static_cast<T>(g[r]), static_cast<T>(dt[r]));
  }
}

template <typename T>
std::vector<T> run_c(void* library, const Sampled& motion) {
  using Init = void (*)(Memory*);
  using Step = T (*)(Memory*, T, T, T);
  const auto init = reinterpret_cast<Init>(dlsym(library, "friction_init"));
  const auto step = reinterpret_cast<Step>(dlsym(library, "friction_step"));
  EXPECT_NE(init, nullptr);
  EXPECT_NE(step, nullptr);
  std::vector<T> values(motion.v.size());
  Memory memory;
  init(&memory);
  run_steps(step, &memory, motion, values.data());
  return values;
}

TEST(StateExport, CHasTheBitsThatWereJudgedInDoubleAndInFloat) {
  if (!has("cc")) GTEST_SKIP() << "no C compiler";
  const Sampled motion = make_motion();
  for (std::size_t i = 0; i < texts().size(); ++i) {
    const StatefulFormula formula = parse_stateful(texts()[i], kNames);
    void* const whole = compile(code_of(texts()[i], CodeForm::c), fmt::format("double{}", i));
    ASSERT_NE(whole, nullptr);
    EXPECT_EQ(run_c<double>(whole, motion), (expected<double, Evaluator>(formula, motion)));
    void* const half = compile(code_of(texts()[i], CodeForm::c, true), fmt::format("float{}", i));
    ASSERT_NE(half, nullptr);
    EXPECT_EQ(run_c<float>(half, motion), (expected<float, FloatEvaluator>(formula, motion)));
  }
}

// The exponential has a short way where its power of two is a normal number.
TEST(StateExport, TheExponentialKeepsItsBitsWhereItOverflowsAndUnderflows) {
  if (!has("cc")) GTEST_SKIP() << "no C compiler";
  const std::string text = "z = lag(g, time_constant=0.02); exp(v) + 0*z";
  const StatefulFormula formula = parse_stateful(text, kNames);
  Sampled motion;
  for (int k = -76000; k <= 72000; ++k) {
    motion.v.push_back(0.01 * k);
    motion.g.push_back(0);
    motion.dt.push_back(0.001);
  }
  motion.v.push_back(std::nan(""));
  motion.g.push_back(0);
  motion.dt.push_back(0.001);
  const auto same_bits = [](const auto& found, const auto& wanted) {
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t r = 0; r + 1 < found.size(); ++r) ASSERT_EQ(found[r], wanted[r]) << r;
    EXPECT_TRUE(std::isnan(found.back()) && std::isnan(wanted.back()));
  };
  void* const whole = compile(code_of(text, CodeForm::c), "edges");
  void* const half = compile(code_of(text, CodeForm::c, true), "edges_single");
  ASSERT_TRUE(whole != nullptr && half != nullptr);
  same_bits(run_c<double>(whole, motion), expected<double, Evaluator>(formula, motion));
  same_bits(run_c<float>(half, motion), expected<float, FloatEvaluator>(formula, motion));
}

double nanoseconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
}

// Multiplications with addition, each of which waits for the one before: four cycles of any common
// processor, so that its time says what a nanosecond of a processor at 3 GHz is here, at this
// moment.
constexpr const char* kChain = R"(
double chain(double x, int links) {
  int i;
  for (i = 0; i < links; ++i) x = fma(x, 0.999, 0.1);
  return x;
}
)";

// Both are measured turn about: a shared machine's clock falls by a third for minutes.
TEST(StateExport, AStepOfLuGreTakesFiftyNanosecondsOfAProcessorAtThreeGigahertz) {
  if (!has("cc")) GTEST_SKIP() << "no C compiler";
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("fma")) GTEST_SKIP() << "fma by software";
#endif
  const Sampled motion = make_motion();
  void* const library = compile(code_of(texts()[0], CodeForm::c) + kChain, "time");
  ASSERT_NE(library, nullptr);
  const auto chain = reinterpret_cast<double (*)(double, int)>(dlsym(library, "chain"));
  ASSERT_NE(chain, nullptr);
  const int links = 20000;
  double link = 1e9;
  double step = 1e9;
  for (int round = 0; round < 30; ++round) {
    link = std::min(link, nanoseconds_of([&] { chain(0.3, links); }) / links);
    step = std::min(step, nanoseconds_of([&] { run_c<double>(library, motion); }) /
                              static_cast<double>(motion.v.size()));
  }
  RecordProperty("nanoseconds", fmt::format("{:.1f}", step));
  const double of_a_processor_at_3_ghz = step * (4 / 3.0) / link;
  RecordProperty("at_3_GHz", fmt::format("{:.1f}", of_a_processor_at_3_ghz));
  EXPECT_LT(of_a_processor_at_3_ghz, 50) << step << " ns here, a link " << link;
}

// Runs a script that prints a value a line for the rows of motion.csv.
void expect_close(const std::string& output, const std::vector<double>& wanted) {
  std::istringstream lines(output);
  std::vector<double> found;
  for (double value = 0; lines >> value;) found.push_back(value);
  ASSERT_EQ(found.size(), wanted.size()) << output.substr(0, 400);
  for (std::size_t r = 0; r < wanted.size(); ++r) {
    ASSERT_NEAR(found[r], wanted[r], 1e-9 * (1 + std::abs(wanted[r]))) << r;
  }
}

fs::path folder_with_motion(const std::string& name, const Sampled& motion) {
  const fs::path folder = fresh_folder(name);
  std::string rows;
  for (std::size_t r = 0; r < motion.v.size(); ++r) {
    rows += fmt::format("{},{},{}\n", motion.v[r], motion.g[r], motion.dt[r]);
  }
  write(folder / "motion.csv", rows);
  return folder;
}

TEST(StateExport, PythonAgrees) {
  if (!has("python3")) GTEST_SKIP() << "no Python";
  const Sampled motion = make_motion();
  for (const std::string& text : texts()) {
    const fs::path folder = folder_with_motion("python", motion);
    write(folder / "friction.py", code_of(text, CodeForm::python));
    write(folder / "run.py",
          "from friction import friction\nf = friction()\n"
          "for line in open('motion.csv'):\n"
          "    v, g, dt = (float(x) for x in line.split(','))\n"
          "    print(repr(f.step(v, g, dt)))\n");
    const std::string output = output_of(fmt::format("cd {} && python3 run.py", folder.string()));
    expect_close(output, expected<double, Evaluator>(parse_stateful(text, kNames), motion));
  }
}

TEST(StateExport, MatlabAgreesInOctave) {
  if (!has("octave-cli")) GTEST_SKIP() << "no Octave";
  Sampled motion = make_motion();
  for (std::vector<double>* column : {&motion.v, &motion.g, &motion.dt}) column->resize(400);
  for (const std::string& text : texts()) {
    const fs::path folder = folder_with_motion("matlab", motion);
    write(folder / "friction.m", code_of(text, CodeForm::matlab));
    write(
        folder / "run.m",
        "m = csvread('motion.csv'); s = [];\nfor k = 1:rows(m)\n"
        "  [tau, s] = friction(s, m(k, 1), m(k, 2), m(k, 3));\n  printf('%.17g\\n', tau);\nend\n");
    const std::string output =
        output_of(fmt::format("cd {} && octave-cli --norc -q run.m", folder.string()));
    expect_close(output, expected<double, Evaluator>(parse_stateful(text, kNames), motion));
  }
}

TEST(StateExport, NamesThatTheCodeUsesItselfDoNotClash) {
  if (!has("cc")) GTEST_SKIP() << "no C compiler";
  const std::vector<std::string> names = {"dt", "memory", "t0"};
  const StatefulFormula formula =
      parse_stateful("double = dahl(dt, sliding=0.1); memory*double + t0", names);
  const std::string code = export_stateful(formula, names, CodeForm::c, {});
  EXPECT_NE(compile(code, "names"), nullptr) << code;
}

TEST(StateExport, RefusesWhatHasNoStep) {
  const StatefulFormula formula = parse_stateful(texts()[0], kNames);
  EXPECT_THROW(export_stateful(formula, kNames, CodeForm::latex, {}), Error);
  StatefulExportOptions single;
  single.single = true;
  EXPECT_THROW(export_stateful(formula, kNames, CodeForm::python, single), Error);
  EXPECT_THAT(export_stateful(formula, kNames, CodeForm::c, {}), HasSubstr("friction_init"));
}

}  // namespace
}  // namespace tribench
