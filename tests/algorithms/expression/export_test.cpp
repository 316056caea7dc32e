// SPDX-License-Identifier: MIT
#include "algorithms/expression/export.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/operator_set.hpp"
#include "algorithms/expression/random_formula.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"
#include "foundation/formula_name.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"

namespace tribench {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::output_of;

constexpr int kPoints = 40;
const std::vector<std::string> kNames = {"v", "sgn_v", "g"};

fs::path fresh_folder(const std::string& name) {
  const fs::path folder = testing::scratch_folder() / ("tribench_export_" + name);
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

bool has(const std::string& program) {
  return std::system(fmt::format("command -v {} >/dev/null 2>&1", program).c_str()) == 0;
}

bool runs(const std::string& command) { return std::system(command.c_str()) == 0; }

std::string exported(const std::string& formula, const std::string& form,
                     ExportOptions options = {}) {
  std::vector<std::string> names = kNames;
  return export_code(parse(formula, names), names, find_code_form(form), options);
}

// A point (v, g); the sign of v is the formula's second input.
struct Point {
  double v;
  double g;
};

std::vector<Point> points() {
  RandomStream random(12);
  std::vector<Point> all = {{0, 0}, {-0.0, 1}, {1, -1}};
  while (all.size() < kPoints) all.push_back({random.uniform(-2, 2), random.uniform(-40, 40)});
  return all;
}

double judged(const Expression& formula, const Point& at) {
  const double sign = at.v > 0 ? 1 : (at.v < 0 ? -1 : 0);
  const double inputs[3] = {at.v, sign, at.g};
  return Evaluator().evaluate_at(formula, inputs);
}

struct Case {
  Expression formula;
  bool exact;  // only operations that IEEE 754 rounds the same everywhere
};

bool is_exact(const Expression& formula) {
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const Op op = formula.node(i).op;
    if (op == Op::exp || op == Op::log || op == Op::sin || op == Op::cos || op == Op::tanh ||
        op == Op::atan) {
      return false;
    }
    if (op != Op::pow) continue;
    const Node& exponent = formula.node(i - 1);
    const bool product = exponent.is_constant() && std::abs(exponent.value) <= 64 &&
                         exponent.value == std::floor(exponent.value);
    if (!product) return false;
  }
  return true;
}

// The paper's formulas, the awkward ones, and random ones over every operation.
std::vector<Case> cases() {
  std::vector<Case> all;
  for (const char* text :
       {"8.5*sgn_v + 14.1*v - 4.25*v^3", "(3.66*v + 8.52*sgn_v - 0.44)*exp(-0.78*v^2)",
        "v^-3 + v^0 + v^64 - v^13", "1/(v - 0.25)", "log(v) + sqrt(v) + g^1.5", "1/0 + 0/0",
        "-v^2 - -3*-g", "sgn(v*g)*abs(g)^0.5", "5", "-1e-300*v", "tanh(v)/sin(g) - cos(v*g)"}) {
    all.push_back({parse(text, kNames), false});
  }
  RandomStream random(77);
  const RandomFormulas everything(find_operator_set("full"), kNames.size());
  const RandomFormulas arithmetic({Op::add, Op::sub, Op::mul, Op::div, Op::sqrt}, kNames.size());
  for (int i = 0; i < 40; ++i) {
    all.push_back(
        {(i % 2 == 0 ? everything : arithmetic).grown(5 + random.below(30), random), false});
  }
  for (Case& each : all) each.exact = is_exact(each.formula);
  return all;
}

// Equal bits (any NaN equals any), or near where a library's function differs in its last places.
void expect_same(double code, double judge, const Case& each, const std::string& where) {
  if (std::isnan(judge) || std::isnan(code)) {
    EXPECT_EQ(std::isnan(code), std::isnan(judge)) << where << ": " << code << " " << judge;
  } else if (each.exact || std::isinf(judge)) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(code + 0.0), std::bit_cast<std::uint64_t>(judge + 0.0))
        << where << ": " << code << " " << judge;
  } else {
    EXPECT_NEAR(code, judge, 1e-9 * (1 + std::abs(judge))) << where;
  }
}

std::string where_text(const Case& each, const Point& at) {
  return fmt::format("{} at v={}, g={}", print(each.formula, kNames), at.v, at.g);
}

ExportOptions named(std::size_t i) {
  ExportOptions options;
  options.function = fmt::format("f{}", i);
  options.box = parse_box("v=-2:2,g=-40:40");
  return options;
}

// Formulas in a folder, one file each, that a script evaluates and prints as hexadecimal floats.
void expect_script_agrees(const std::string& output, const std::vector<Case>& all) {
  std::istringstream lines(output);
  std::string line;
  for (const Case& each : all) {
    for (const Point& at : points()) {
      ASSERT_TRUE(std::getline(lines, line));
      expect_same(std::strtod(line.c_str(), nullptr), judged(each.formula, at), each,
                  where_text(each, at));
    }
  }
}

TEST(Export, CGivesTheEvaluatorsValuesWhenCompiled) {
  if (!has("cc")) GTEST_SKIP() << "no C compiler";
  const fs::path folder = fresh_folder("c");
  const std::vector<Case> all = cases();
  std::string sources;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const fs::path file = folder / fmt::format("f{}.c", i);
    write(file, export_code(all[i].formula, kNames, CodeForm::c, named(i)));
    sources += " " + file.string();
  }
  const fs::path library = folder / "formulas.so";
  ASSERT_TRUE(
      runs(fmt::format("cc -std=c99 -O2 -ffp-contract=off -Wall -Wextra -Werror "
                       "-Wno-div-by-zero -shared -fPIC -o {}{} -lm",
                       library.string(), sources)));
  void* handle = dlopen(library.c_str(), RTLD_NOW);
  ASSERT_NE(handle, nullptr) << dlerror();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto function =
        reinterpret_cast<double (*)(double, double)>(dlsym(handle, fmt::format("f{}", i).c_str()));
    ASSERT_NE(function, nullptr);
    for (const Point& at : points()) {
      expect_same(function(at.v, at.g), judged(all[i].formula, at), all[i], where_text(all[i], at));
    }
  }
  const auto in_box = reinterpret_cast<int (*)(double, double)>(dlsym(handle, "f0_in_box"));
  ASSERT_NE(in_box, nullptr);
  EXPECT_EQ(in_box(2, 40), 1);
  EXPECT_EQ(in_box(2.1, 0), 0);
  EXPECT_EQ(in_box(std::nan(""), 0), 0);
  dlclose(handle);
}

TEST(Export, CStatesTheBoxAndHasNoBranchAndNoLoop) {
  ExportOptions options;
  options.box = parse_box("v=-2:2");
  const std::string code = exported("8.5*sgn_v + 14*v^3", "c", options);
  EXPECT_THAT(code, HasSubstr("v in [-2, 2]"));
  EXPECT_THAT(code, HasSubstr("double friction(double v)"));
  for (const char* word : {" if ", "for (", "while", "goto"})
    EXPECT_THAT(code, Not(HasSubstr(word)));
}

// Input 65 536 is none that a formula can name, nor one that comes round to input 0.
TEST(Export, AFormulaNamesNoMoreInputsThanItCan) {
  std::string sum = "x0";
  for (std::size_t j = 1; j <= kMaxInputs; ++j) sum += fmt::format(" + x{}", j);
  std::vector<std::string> names;
  EXPECT_THROW(parse_collecting_names(sum, names), Error);
  names.resize(kMaxInputs);
  for (std::size_t j = 0; j < names.size(); ++j) names[j] = fmt::format("x{}", j);
  const Expression last = parse(fmt::format("1/x{}", kMaxInputs - 1), names);
  EXPECT_THAT(export_code(last, names, CodeForm::c, {}), HasSubstr("1.0 / x65535"));
}

// A column that is called like a sign and stands without what it would be the sign of.
TEST(Export, ASignWithoutItsInputIsAnArgument) {
  const std::vector<std::string> names = {"sgn_x"};
  ExportOptions options;
  options.box = parse_box("sgn_x=-1:1");
  const Expression formula = parse("0.5*sgn_x + 1.5", names);
  const std::string code = export_code(formula, names, CodeForm::c, options);
  EXPECT_THAT(code, HasSubstr("double friction(double sgn_x)"));
  EXPECT_THAT(code, HasSubstr("sgn_x in [-1, 1]"));
  EXPECT_THAT(code, Not(HasSubstr("sign_of")));
  EXPECT_THAT(export_code(formula, names, CodeForm::c, {}), HasSubstr("double friction(double x)"));
}

TEST(Export, PythonGivesTheEvaluatorsValuesWhenRun) {
  const std::string python = "/usr/bin/python3";
  if (!runs(python + " -c 'import numpy' 2>/dev/null")) GTEST_SKIP() << "no python3-numpy";
  const fs::path folder = fresh_folder("python");
  const std::vector<Case> all = cases();
  std::string script = "import math\n";
  for (std::size_t i = 0; i < all.size(); ++i) {
    write(folder / fmt::format("m{}.py", i),
          export_code(all[i].formula, kNames, CodeForm::python, named(i)));
    script += fmt::format("from m{0} import f{0}\n", i);
  }
  script += "def show(x): print(float(x).hex())\n";
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (const Point& at : points()) {
      script += fmt::format("show(f{}(float('{}'), float('{}')))\n", i, at.v, at.g);
    }
  }
  write(folder / "run.py", script);
  expect_script_agrees(output_of(fmt::format("cd {} && {} run.py", folder.string(), python)), all);
}

TEST(Export, PythonTakesWholeColumns) {
  const std::string python = "/usr/bin/python3";
  if (!runs(python + " -c 'import numpy' 2>/dev/null")) GTEST_SKIP() << "no python3-numpy";
  const fs::path folder = fresh_folder("columns");
  write(folder / "m.py", exported("8*sgn_v + v^2", "python"));
  write(folder / "run.py",
        "from m import friction\nprint(friction([-1, 0, 2]).tolist() == [-7.0, 0.0, 12.0])\n");
  EXPECT_EQ(output_of(fmt::format("cd {} && {} run.py", folder.string(), python)), "True\n");
}

TEST(Export, SymPyGivesTheEvaluatorsValuesWhenRun) {
  const std::string python = "/usr/bin/python3";
  if (!runs(python + " -c 'import sympy' 2>/dev/null")) GTEST_SKIP() << "no python3-sympy";
  const fs::path folder = fresh_folder("sympy");
  std::string script = "import math\nimport sympy as sp\n";
  std::vector<Case> all;
  for (const char* text :
       {"8.5*sgn_v + 14.1*v - 4.25*v^3", "(3.66*v + 8.52*sgn_v - 0.44)*exp(-0.78*v^2)",
        "v/(g^2 + 1) - -2*-v", "sqrt(abs(v*g)) + tanh(v) - 2^v", "sgn(v*g)*abs(g)^0.5"}) {
    all.push_back({parse(text, kNames), false});
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    ExportOptions options = named(i);
    script += export_code(all[i].formula, kNames, CodeForm::sympy, options);
    script += fmt::format("e = sp.lambdify((v, g), f{}, 'math')\n", i);
    script += "for a, b in POINTS: print(float(e(a, b) if True else 0).hex())\n";
  }
  std::string list;
  for (const Point& at : points()) list += fmt::format("(float('{}'), float('{}')),", at.v, at.g);
  write(folder / "run.py",
        "from math import copysign\n"
        "import builtins\nPOINTS = [" +
            list + "]\n" + script);
  expect_script_agrees(output_of(fmt::format("cd {} && {} run.py", folder.string(), python)), all);
}

TEST(Export, MatlabGivesTheEvaluatorsValuesInOctave) {
  if (!has("octave-cli")) GTEST_SKIP() << "no octave";
  const fs::path folder = fresh_folder("matlab");
  const std::vector<Case> all = cases();
  std::string script;
  for (std::size_t i = 0; i < all.size(); ++i) {
    write(folder / fmt::format("f{}.m", i),
          export_code(all[i].formula, kNames, CodeForm::matlab, named(i)));
    for (const Point& at : points()) {
      script += fmt::format("printf('%.17g\\n', f{}({}, {}));\n", i, at.v, at.g);
    }
  }
  write(folder / "all_points.m", script);
  expect_script_agrees(output_of(fmt::format("cd {} && octave-cli --norc all_points.m 2>/dev/null",
                                             folder.string())),
                       all);
}

TEST(Export, MatlabRaisesWholeColumnsElementByElement) {
  if (!has("octave-cli")) GTEST_SKIP() << "no octave";
  const fs::path folder = fresh_folder("matlab_columns");
  const auto function = [&](const char* formula, const char* name) {
    write(folder / fmt::format("{}.m", name), exported(formula, "matlab", {.function = name}));
  };
  function("v^g", "power");
  function("(-2)^g", "of_two");
  write(folder / "run.m",
        "printf('%g ', power([-2;-2;-2;-3;2;-0;-0], [3;2.5;-1;2;0.5;-1;-2]));\n"
        "printf('%g ', of_two([3;2.5;2]));\n");
  EXPECT_EQ(output_of(fmt::format("cd {} && octave-cli --norc run.m 2>/dev/null", folder.string())),
            "-8 NaN -0.5 9 1.41421 -Inf Inf -8 NaN 4 ");
}

// The few words of LaTeX that the exporter writes, back to the grammar of formulas.
std::string from_latex(std::string text) {
  const auto replace = [&](const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
      text.replace(at, from.size(), to);
    }
  };
  replace("\\left|", "abs(");
  replace("\\right|", ")");
  replace("\\left(", "(");
  replace("\\right)", ")");
  replace("\\operatorname{sgn}", "sgn");
  replace("\\cdot", "*");
  replace("\\frac{", "((");
  replace("}{", ")/(");  // only a fraction has two groups in a row
  replace("\\sqrt{", "sqrt((");
  replace("^{", "^((");
  for (const char* name : {"exp", "log", "sin", "cos", "tanh"})
    replace(fmt::format("\\{}", name), name);
  replace("}", "))");
  return text;
}

TEST(Export, LatexReadsBackToTheSameValues) {
  for (const char* text :
       {"8.5*sgn_v + 14.1*v - 4.25*v^3", "(3.66*v - 0.44)*exp(-0.78*v^2)", "v/(g^2 + 1)",
        "-v^2 - -3*-g", "(v/g)^2", "2^-v", "(v^2)^3", "v - (g - 1)", "v*(g*2)", "v/(g/2)",
        "sqrt(abs(v*g)) + 1e-05*g", "(1e-05)^v", "-(v + g)*2", "(-v)^2"}) {
    const Expression formula = parse(text, kNames);
    std::string back = from_latex(exported(text, "latex"));
    back.pop_back();
    const Case approximate{formula, false};
    const Expression reread = parse(back, kNames);
    for (const Point& at : points()) {
      expect_same(judged(reread, at), judged(formula, at), approximate, back);
    }
  }
}

TEST(Export, LatexIsForPeople) {
  EXPECT_EQ(exported("8.5123*sgn_v*v^2/g", "latex", {.digits = 3}),
            "\\frac{8.51 \\cdot \\operatorname{sgn}\\left(v\\right) \\cdot v^{2}}{g}\n");
  std::vector<std::string> names = {"qd", "tau_g"};
  EXPECT_EQ(export_code(parse("qd*tau_g", names), names, CodeForm::latex, {}),
            "\\dot{q} \\cdot \\tau_{\\mathrm{g}}\n");
}

TEST(Export, RenamesWhatALanguageReserves) {
  std::vector<std::string> names = {"lambda", "friction", "t0"};
  const Expression formula = parse("lambda + friction*t0", names);
  const std::string code = export_code(formula, names, CodeForm::c, {});
  EXPECT_THAT(code, HasSubstr("double friction(double lambda_, double friction_, double t0)"));
  EXPECT_THAT(code, HasSubstr("const double t_0 = friction_ * t0;"));
}

TEST(Export, GivesArgumentsThatCollideWhenMendedNamesOfTheirOwn) {
  std::vector<std::string> names = {"if_", "if", "_v", "x_v", "lambda_", "lambda", "lambda__"};
  const Expression formula = parse("if_ + if*_v - x_v*lambda_ + lambda*lambda__", names);
  const std::vector<std::string> called = export_arguments(formula, names);
  EXPECT_EQ(std::set<std::string>(called.begin(), called.end()).size(), names.size());
  EXPECT_EQ(called[0], "if_");  // whoever needs no mend keeps its name
  EXPECT_EQ(called[1], "if__");
  EXPECT_EQ(called[3], "x_v");
}

TEST(Export, CompilesWithEveryWordOfTheLanguagesAsAnInput) {
  // What the compilers themselves define beside keywords, and what they cannot define.
  std::string words = output_of(
      "for c in 'cc -std=gnu17' 'cc -std=c99' 'c++ -std=gnu++20 -x c++'; do "
      "printf '#include <math.h>\n' | $c -dM -E -; done | sed 's/^#define //; s/[ (].*//'");
  words +=
      " _Bool _Complex _Imaginary _Noreturn _Static_assert _Thread_local _Atomic _Generic bool true"
      " false typeof asm auto register restrict class new this template operator NAN M_PI signgam"
      " y0 j1 fabs sqrt exp2 cosf tanhl lambda None True match type np sp sign_of float tau end pi"
      " I complex errno EOF stdin assert DBL_MAX";
  std::istringstream in(words);
  std::set<std::string> names;
  for (std::string word; in >> word;) {
    if (is_formula_name(word)) names.insert(word);
  }
  ASSERT_GT(names.size(), 40U);
  const std::vector<std::string> all(names.begin(), names.end());
  std::string sum = "sqrt(abs(sgn(" + all.front() + ")))";
  for (const std::string& name : all) sum += " + " + name;
  std::vector<std::string> used = all;
  const Expression formula = parse(sum, used);
  const fs::path folder = fresh_folder("words");
  // As a part of a larger file, too.
  write(folder / "f.c",
        "#include <assert.h>\n#include <errno.h>\n#include <float.h>\n"
        "#include <stdio.h>\n#ifndef __cplusplus\n#include <complex.h>\n#endif\n" +
            export_code(formula, all, CodeForm::c, {}));
  for (const char* compiler :
       {"cc -std=gnu17 -x c", "cc -std=c99 -pedantic -x c", "c++ -std=gnu++20 -x c++"}) {
    EXPECT_TRUE(
        runs(fmt::format("{} -Werror -fsyntax-only {}", compiler, (folder / "f.c").string())))
        << compiler;
  }
  if (!has("python3")) return;
  write(folder / "f.py", export_code(formula, all, CodeForm::python, {}));
  write(folder / "s.py", export_code(formula, all, CodeForm::sympy, {}));
  for (const char* file : {"f.py", "s.py"}) {
    EXPECT_TRUE(runs(fmt::format("python3 -m py_compile {}", (folder / file).string()))) << file;
  }
}

TEST(Export, LetsNoTextFromOutsideIntoTheCode) {
  const std::vector<std::string> names = {"x\"); import os; os.system(\"id\") #"};
  const Expression formula = Expression::variable(0);
  for (const std::string& form : code_form_names()) {
    EXPECT_THROW(export_code(formula, names, find_code_form(form), {}), Error) << form;
    ExportOptions options;
    options.box = NamedBox{names, {{0, 1}}};
    EXPECT_THROW(export_code(Expression::constant(1), {}, find_code_form(form), options), Error);
  }
  EXPECT_THROW(parse_box("x;system(\"id\")=0:1"), Error);
}

TEST(Export, RefusesUnknownFormsAndBadNames) {
  EXPECT_THROW(find_code_form("pyton"), Error);
  EXPECT_THROW(exported("v", "c", {.function = "2x"}), Error);
  for (const char* word :
       {"while", "_Bool", "NAN", "M_PI", "asm", "linux", "cosf", "__x", "y0", "NULL", "I"}) {
    EXPECT_THROW(exported("v", "c", {.function = word}), Error) << word;
  }
}

}  // namespace
}  // namespace tribench
