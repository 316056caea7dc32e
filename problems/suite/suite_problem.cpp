// SPDX-License-Identifier: MIT
#include "problems/suite/suite_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "foundation/formula_name.hpp"
#include "foundation/number_text.hpp"
#include "foundation/random.hpp"
#include "foundation/text.hpp"
#include "problems/reading/csv.hpp"
#include "problems/reading/csv_cells.hpp"

namespace tribench::suite {
namespace {

constexpr int kMostDraws = 10'000;  // for one row at which the law is finite

double draw_value(const Draw& draw, RandomStream& random) {
  double value = 0;
  switch (draw.kind) {
    case Draw::Kind::log: {
      const double low = elementary::log10(draw.low);
      value = elementary::pow(10.0, random.uniform(low, elementary::log10(draw.high)));
      break;
    }
    case Draw::Kind::whole:
      value = draw.low + static_cast<double>(
                             random.below(static_cast<std::uint64_t>(draw.high - draw.low) + 1));
      break;
    default:
      value = random.uniform(draw.low, draw.high);
  }
  if (draw.sign == Draw::Sign::negative) return -value;
  return draw.sign == Draw::Sign::either ? value * random.sign() : value;
}

void append(Table& table, std::span<const double> point, double value) {
  for (std::size_t j = 0; j < point.size(); ++j) table.columns[j].push_back(point[j]);
  table.target.push_back(value);
  table.movement.push_back(static_cast<int>(table.movement.size()));
}

// Every combination of the lattices; inputs without one are drawn.
Table lattice_table(const SuiteProblem& wanted, const std::vector<const Draw*>& draws,
                    const Law& law, RandomStream& random) {
  Table table;
  table.columns.resize(draws.size());
  std::vector<std::size_t> at(draws.size(), 0);
  std::vector<double> point(draws.size());
  for (bool more = true; more;) {
    for (std::size_t j = 0; j < draws.size(); ++j) {
      const Draw& draw = *draws[j];
      point[j] = draw.kind == Draw::Kind::lattice
                     ? std::min(draw.low + draw.step * static_cast<double>(at[j]), draw.high)
                     : draw_value(draw, random);
    }
    const double value = law(point);
    if (std::isfinite(value)) append(table, point, value);
    more = false;
    for (std::size_t j = 0; j < draws.size() && !more; ++j) {
      if (draws[j]->kind != Draw::Kind::lattice) continue;
      more = static_cast<double>(++at[j]) < lattice_points(*draws[j]);
      if (!more) at[j] = 0;
    }
  }
  if (table.rows() == 0) {
    throw_bad_input(fmt::format("'{}' is finite nowhere on its lattice", wanted.law),
                    wanted.law_place, "check the inputs' ranges");
  }
  return table;
}

Table drawn_table(const SuiteProblem& wanted, const std::vector<const Draw*>& draws,
                  std::size_t rows, const Law& law, RandomStream& random) {
  Table table;
  table.columns.resize(draws.size());
  std::vector<double> point(draws.size());
  for (std::size_t r = 0; r < rows; ++r) {
    double value = std::numeric_limits<double>::quiet_NaN();
    for (int tries = 0; !std::isfinite(value); ++tries) {
      if (tries == kMostDraws) {
        throw_bad_input(fmt::format("'{}' is finite at none of {} points", wanted.law, kMostDraws),
                        wanted.law_place, "check the inputs' ranges");
      }
      for (std::size_t j = 0; j < draws.size(); ++j) point[j] = draw_value(*draws[j], random);
      value = law(point);
    }
    append(table, point, value);
  }
  return table;
}

Table law_table(const SuiteProblem& wanted, bool test, const Law& law, RandomStream random) {
  std::vector<const Draw*> draws;
  for (const SuiteInput& input : wanted.inputs) draws.push_back(test ? &input.test : &input.train);
  const bool lattice = std::ranges::any_of(
      draws, [](const Draw* draw) { return draw->kind == Draw::Kind::lattice; });
  Table table =
      lattice ? lattice_table(wanted, draws, law, random)
              : drawn_table(wanted, draws, test ? wanted.test_rows : wanted.rows, law, random);
  table.truth = table.target;
  return table;
}

Input box_of(const SuiteInput& input) {
  const double low = std::min(input.train.low, input.test.low);
  const double high = std::max(input.train.high, input.test.high);
  Input box{input.name, input.unit, Role::none, low, high, {}};
  if (input.train.sign == Draw::Sign::either) {
    box.high = std::max(std::abs(low), std::abs(high));
    box.low = -box.high;
  }
  if (input.train.sign == Draw::Sign::negative) {
    box.low = -high;
    box.high = -low;
  }
  return box;
}

Problem blank_problem(const Suite& suite, const SuiteProblem& wanted) {
  Problem problem;
  problem.name = fmt::format("{}/{}", suite.name, wanted.name);
  problem.summary = wanted.law.empty() ? wanted.note : wanted.law;
  problem.dataset = suite.name;
  problem.target = std::string("f");
  problem.target_unit = wanted.unit;
  return problem;
}

void add_stage(Problem& problem, Table train, std::string law) {
  Stage stage;
  stage.name = "fit";
  for (std::size_t j = 0; j < problem.inputs.size(); ++j) stage.inputs.push_back(j);
  stage.train = std::move(train);
  stage.law = std::move(law);
  problem.stages.push_back(std::move(stage));
}

Problem make_law_problem(const Suite& suite, const SuiteProblem& wanted, const LawReader& laws,
                         RandomStream random) {
  Problem problem = blank_problem(suite, wanted);
  for (const SuiteInput& input : wanted.inputs) problem.inputs.push_back(box_of(input));
  const Law law = read_law_of(wanted, laws);
  add_stage(problem, law_table(wanted, false, law, random.split("train")), wanted.law);
  problem.test = law_table(wanted, true, law, random.split("test"));
  return problem;
}

std::filesystem::path data_file(const std::string& file,
                                const std::optional<std::filesystem::path>& data) {
  if (!data || !std::filesystem::exists(*data / file)) {
    throw_bad_input("the table is not there", data ? (*data / file).string() : file,
                    "name the folder that holds it with --data or TRIBENCH_DATA");
  }
  return *data / file;
}

// The rows that test: those a file of splits names for its seed-th seed (from 1, round and round),
// else a share drawn with the seed.
std::vector<char> test_rows_of(const Suite& suite, const SuiteProblem& wanted, std::size_t rows,
                               const std::optional<std::filesystem::path>& data,
                               std::uint64_t seed) {
  std::vector<char> test(rows, 0);
  if (wanted.splits.empty()) {
    std::vector<std::size_t> order(rows);
    for (std::size_t r = 0; r < rows; ++r) order[r] = r;
    RandomStream random =
        RandomStream(key_of(fmt::format("{}/{}", suite.name, wanted.name))).split(seed);
    random.shuffle(std::span(order));
    const auto count =
        static_cast<std::size_t>(std::ceil(suite.test_share * static_cast<double>(rows)));
    for (std::size_t i = 0; i < count; ++i) test[order[i]] = 1;
    return test;
  }
  const std::filesystem::path file = data_file(wanted.splits, data);
  std::vector<std::string> splits;
  for (const CsvLine& line : split_csv(read_file(file), file.string()).lines) {
    if (line.cells.size() == 3 && line.cells[0] == wanted.name) splits.push_back(line.cells[2]);
  }
  if (splits.empty()) {
    throw_bad_input(fmt::format("no split of '{}'", wanted.name), file.string(),
                    "a line dataset,seed,test_rows");
  }
  const std::string& chosen = splits[(seed + splits.size() - 1) % splits.size()];
  for (std::size_t begin = 0; begin < chosen.size();) {
    const std::size_t end = std::min(chosen.find(' ', begin), chosen.size());
    const auto row = read_number<std::size_t>(chosen.substr(begin, end - begin));
    if (!row || *row >= rows) {
      throw_bad_input(
          fmt::format("'{}' is no row of {} rows", chosen.substr(begin, end - begin), rows),
          file.string());
    }
    test[*row] = 1;
    begin = end + 1;
  }
  return test;
}

// To mean 0 and variance 1 of the training rows.
void standardise(std::vector<double>& train, std::vector<double>& test) {
  const auto n = static_cast<double>(train.size());
  double mean = 0;
  for (const double x : train) mean += x / n;
  double variance = 0;
  for (const double x : train) variance += (x - mean) * (x - mean) / n;
  const double spread = variance > 0 ? std::sqrt(variance) : 1;
  for (std::vector<double>* values : {&train, &test}) {
    for (double& x : *values) x = (x - mean) / spread;
  }
}

Table rows_of(const Dataset& data, const std::string& target, const std::vector<char>& marks,
              char wanted) {
  Table table;
  for (const Channel& channel : data.channels) {
    std::vector<double> values;
    for (std::size_t r = 0; r < marks.size(); ++r) {
      if (marks[r] == wanted) values.push_back(channel.values[r]);
    }
    if (channel.name == target) {
      table.target = std::move(values);
    } else {
      table.columns.push_back(std::move(values));
    }
  }
  for (std::size_t r = 0; r < table.rows(); ++r) table.movement.push_back(static_cast<int>(r));
  return table;
}

Problem make_table_problem(const Suite& suite, const SuiteProblem& wanted,
                           const std::optional<std::filesystem::path>& data, std::uint64_t seed) {
  CsvOptions options;
  options.names_tell = false;
  const Dataset rows = read_csv(data_file(wanted.file, data), options).data;
  rows.at(wanted.target);  // throws with the nearest name
  const std::vector<char> marks = test_rows_of(suite, wanted, rows.rows(), data, seed);
  const auto tested = static_cast<std::size_t>(std::ranges::count(marks, 1));
  if (tested == 0 || tested == marks.size()) {
    throw_bad_input(fmt::format("{} of {} rows test", tested, marks.size()), wanted.file,
                    "some rows have to train and some to test: more rows, or another split");
  }
  Table train = rows_of(rows, wanted.target, marks, 0);
  Table test = rows_of(rows, wanted.target, marks, 1);
  if (suite.standardise) {
    for (std::size_t j = 0; j < train.columns.size(); ++j) {
      standardise(train.columns[j], test.columns[j]);
    }
    standardise(train.target, test.target);
  }
  Problem problem = blank_problem(suite, wanted);
  for (const Channel& channel : rows.channels) {
    if (channel.name == wanted.target) continue;
    require_formula_name(channel.name, wanted.file);
    const std::vector<double>& values = train.columns[problem.inputs.size()];
    const auto [low, high] = std::ranges::minmax(values);
    const auto known = std::ranges::find(wanted.inputs, channel.name, &SuiteInput::name);
    problem.inputs.push_back({channel.name,
                              known == wanted.inputs.end() ? "-" : known->unit,
                              Role::none,
                              low,
                              high,
                              {}});
  }
  // A law of standardised columns would be another formula.
  add_stage(problem, std::move(train), suite.standardise ? std::string() : wanted.law);
  problem.test = std::move(test);
  return problem;
}

std::vector<std::filesystem::path> suite_files(const std::optional<std::filesystem::path>& data) {
  std::vector<std::filesystem::path> files;
  if (!data || !std::filesystem::is_directory(*data / "suites")) return files;
  for (const auto& file : std::filesystem::directory_iterator(*data / "suites")) {
    if (file.path().extension() == ".toml") files.push_back(file.path());
  }
  std::ranges::sort(files);
  return files;
}

}  // namespace

Law read_law_of(const SuiteProblem& wanted, const LawReader& laws) {
  std::vector<std::string> names;
  for (const SuiteInput& input : wanted.inputs) names.push_back(input.name);
  return at_place(wanted.law_place, [&] { return laws(wanted.law, names); });
}

Problem make_suite_problem(const Suite& suite, const SuiteProblem& wanted, const LawReader& laws,
                           const std::optional<std::filesystem::path>& data, std::uint64_t seed) {
  if (!wanted.file.empty()) return make_table_problem(suite, wanted, data, seed);
  if (!laws) throw Error(ErrorKind::failed, "no reader of laws was handed in", suite.name);
  const std::string name = fmt::format("{}/{}", suite.name, wanted.name);
  return make_law_problem(suite, wanted, laws, RandomStream(key_of(name)).split(seed));
}

std::vector<Suite> known_suites(const std::optional<std::filesystem::path>& data) {
  static const std::vector<Suite> kShipped = [] {  // a worker asks for them again and again
    std::vector<Suite> suites;
    for (const ShippedSuite& shipped : shipped_suites()) {
      suites.push_back(read_suite(shipped.toml, std::string(shipped.name) + ".toml"));
    }
    return suites;
  }();
  std::vector<Suite> suites = kShipped;
  for (const std::filesystem::path& file : suite_files(data)) {
    Suite own = read_suite(read_file(file), file.string());
    const auto same = std::ranges::find(suites, own.name, &Suite::name);
    if (same == suites.end()) {
      suites.push_back(std::move(own));
    } else {
      *same = std::move(own);
    }
  }
  for (Suite& suite : suites) {
    const std::string& file = suite.published.file;
    if (file.empty() || !data || !std::filesystem::exists(*data / file)) continue;
    suite.results = read_published_results(suite.published, *data);
  }
  return suites;
}

void add_entries(std::vector<ProblemEntry>& entries, const Suite& suite, const LawReader& laws,
                 const std::optional<std::filesystem::path>& data) {
  const auto kept = std::make_shared<const Suite>(suite);
  for (const SuiteProblem& one : kept->problems) {
    const std::string name = one.name;
    const auto make = [kept, name, laws, data](std::uint64_t seed) {
      return make_suite_problem(*kept, kept->find(name), laws, data, seed);
    };
    const std::string summary = !one.law.empty()    ? one.law
                                : !one.note.empty() ? one.note
                                                    : fmt::format("the table {}", one.file);
    entries.push_back({fmt::format("{}/{}", kept->name, name), summary, make, {}, kept->source});
  }
}

}  // namespace tribench::suite
