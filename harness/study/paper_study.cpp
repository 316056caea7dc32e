// SPDX-License-Identifier: MIT
#include "harness/study/paper_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "foundation/error.hpp"
#include "harness/study/paper_figures.hpp"
#include "problems/catalogue.hpp"
#include "reports/record_csv.hpp"
#include "reports/statistics/descriptive.hpp"

namespace tribench {
namespace {

constexpr std::array<std::string_view, 3> kSymbolic = {"parfam", "pysr", "udsr"};
constexpr double kNearCeiling = 1.03;
constexpr double kAsGood = 1.05;

// symmetric_as_printed stands for the paper's fit, symmetric for a proper one.
std::string_view paper_name(std::string_view method) {
  constexpr std::string_view kPrinted = "_as_printed";
  return method.ends_with(kPrinted) ? method.substr(0, method.size() - kPrinted.size()) : method;
}

const PaperFigure* find_figure(std::string_view problem, std::string_view method) {
  constexpr std::string_view kUnadapted = "/unadapted";
  if (problem.ends_with(kUnadapted)) return nullptr;
  for (const PaperFigure& figure : kPaperFigures) {
    if (figure.problem == problem && figure.method == paper_name(method)) return &figure;
  }
  return nullptr;
}

int table_of(std::string_view problem) {
  if (problem.starts_with("B/")) return 3;
  return problem.ends_with("no_load") ? 1 : 2;
}

PaperRow make_row(const std::string& problem, const std::vector<Record>& records) {
  PaperRow row;
  row.method = records.front().method;
  row.operators = records.front().operators;
  std::vector<double> errors;
  std::vector<double> complexities;
  for (const Record& record : records) {
    if (record.status != "ok" || std::isnan(record.mae_test)) {
      ++row.failed;
      continue;
    }
    errors.push_back(record.mae_test);
    complexities.push_back(record.complexity_adaptation > 0 ? record.complexity_adaptation
                                                            : record.complexity);
    if (record.singularity == "refuted") ++row.singular;
  }
  row.seeds = errors.size();
  const Spread spread = spread_of(errors);
  row.mae_nm = errors.empty() ? kMissing : spread.middle;
  row.low_nm = errors.empty() ? kMissing : spread.low;
  row.high_nm = errors.empty() ? kMissing : spread.high;
  row.complexity = complexities.empty() ? kMissing : median(complexities);
  if (const PaperFigure* figure = find_figure(problem, row.method)) {
    row.paper_mae_nm = figure->mae_nm;
    row.paper_complexity = figure->complexity;
  }
  return row;
}

double ceiling_of(const std::string& problem, const std::set<std::uint64_t>& seeds) {
  const Catalogue catalogue;
  const ProblemEntry& entry = catalogue.find(problem);
  std::vector<double> ceilings;
  for (const std::uint64_t seed : seeds) {
    const Table test = entry.make(seed).test;
    double sum = 0;
    for (std::size_t r = 0; r < test.rows(); ++r) sum += std::abs(test.target[r] - test.truth[r]);
    ceilings.push_back(sum / static_cast<double>(test.rows()));
  }
  return median(ceilings);
}

// The least error of the methods for which `is_wanted`; nothing where none gave a formula.
template <typename Wanted>
const PaperRow* best_of(const PaperProblem& problem, Wanted is_wanted) {
  for (const PaperRow& row : problem.rows) {
    if (row.seeds > 0 && is_wanted(row)) return &row;
  }
  return nullptr;
}

bool is_symbolic(const PaperRow& row) {
  return std::ranges::find(kSymbolic, row.method) != kSymbolic.end();
}

bool is_printed_baseline(const PaperRow& row) {
  return row.method == "symmetric_as_printed" || row.method == "asymmetric_as_printed";
}

void remark_on_methods(PaperProblem& problem) {
  const PaperRow* symbolic = best_of(problem, is_symbolic);
  if (symbolic == nullptr) return;
  problem.remarks.push_back(fmt::format(
      "Best of ParFam, PySR and uDSR: {} ({}), {:.3f} N m, {:+.1f} % against the noise ceiling{}.",
      symbolic->method, symbolic->operators, symbolic->mae_nm,
      100 * (symbolic->mae_nm / problem.ceiling_nm - 1),
      symbolic->mae_nm <= kNearCeiling * problem.ceiling_nm ? "" : ", not within 3 %"));
  if (const PaperRow* printed = best_of(problem, is_printed_baseline)) {
    for (const std::string_view name : kSymbolic) {
      const PaperRow* row =
          best_of(problem, [&](const PaperRow& candidate) { return candidate.method == name; });
      if (row != nullptr && row->mae_nm >= printed->mae_nm) {
        problem.remarks.push_back(fmt::format("{} ({:.3f}) is not better than {} ({:.3f}).", name,
                                              row->mae_nm, printed->method, printed->mae_nm));
      }
    }
  }
  for (const std::string_view name : {"symmetric", "asymmetric", "branch_polynomial", "linear"}) {
    const PaperRow* row =
        best_of(problem, [&](const PaperRow& candidate) { return candidate.method == name; });
    if (row != nullptr && row->mae_nm <= kAsGood * symbolic->mae_nm) {
      problem.remarks.push_back(
          fmt::format("{} ({:.3f}) is as good as symbolic regression here.", name, row->mae_nm));
    }
  }
}

void remark_on_known_causes(PaperProblem& problem) {
  const auto has = [&](std::string_view method) {
    return std::ranges::any_of(problem.rows,
                               [&](const PaperRow& row) { return row.method == method; });
  };
  if (problem.table == 1 && has("asymmetric") && has("asymmetric_as_printed")) {
    problem.remarks.emplace_back(
        "As printed the baselines degenerate: with v_s far beyond the velocities the Stribeck term "
        "is constant and Coulomb and linear viscous friction are left; the same form, properly "
        "bounded and solved, follows the curvature.");
  }
  if (problem.table == 1 && problem.name == "A/j2/no_load" && has("asymmetric_as_printed")) {
    problem.remarks.emplace_back(
        "The paper prints the symmetric fit for the branch v <= 0 of the asymmetric model; the "
        "error it prints belongs to another branch, about -(9.30 + 14.8 |v|).");
  }
  const auto error_of = [&](std::string_view method) {
    const PaperRow* row =
        best_of(problem, [&](const PaperRow& candidate) { return candidate.method == method; });
    return row == nullptr ? kMissing : row->mae_nm;
  };
  // False where either is missing.
  if (problem.table == 2 && error_of("asymmetric_as_printed") <= error_of("symmetric_as_printed")) {
    problem.remarks.emplace_back(
        "The paper's asymmetric model is worse than its symmetric one on raw data; no stationary "
        "generator gives that, and these data do not.");
  }
}

using Group = std::tuple<std::string, std::string>;  // method, operator set

std::optional<PaperProblem> make_problem(const std::string& name,
                                         const std::map<Group, std::vector<Record>>& groups) {
  PaperProblem problem;
  problem.table = table_of(name);
  problem.name = name;
  std::set<std::uint64_t> seeds;
  for (const auto& [group, records] : groups) {
    for (const Record& record : records) seeds.insert(record.seed);
    problem.rows.push_back(make_row(name, records));
  }
  if (problem.rows.empty()) return std::nullopt;
  // Rows without a formula (NaN) stand last.
  std::ranges::stable_sort(problem.rows, [](const PaperRow& a, const PaperRow& b) {
    return std::pair(a.seeds == 0, a.mae_nm) < std::pair(b.seeds == 0, b.mae_nm);
  });
  problem.ceiling_nm = ceiling_of(name, seeds);
  remark_on_methods(problem);
  remark_on_known_causes(problem);
  return problem;
}

}  // namespace

std::vector<PaperProblem> run_paper_study(const std::filesystem::path& run) {
  std::map<std::string, std::map<Group, std::vector<Record>>> by_problem;
  read_results(run / "results.csv", [&](Record&& record) {
    if (record.dataset != "A" && record.dataset != "B") return;
    if (record.problem.ends_with("/channels")) return;
    by_problem[record.problem][{record.method, record.operators}].push_back(std::move(record));
  });
  std::vector<PaperProblem> problems;
  for (const auto& [name, groups] : by_problem) {
    if (auto problem = make_problem(name, groups)) problems.push_back(std::move(*problem));
  }
  if (problems.empty()) {
    throw_bad_input("the run has no cell of datasets A and B", (run / "results.csv").string(),
                    "run the grid 'paper'");
  }
  std::ranges::stable_sort(problems, {}, &PaperProblem::table);
  return problems;
}

std::string paper_study_markdown(const std::vector<PaperProblem>& problems) {
  const auto number = [](double value) {
    return std::isnan(value) ? std::string("-") : fmt::format("{:.3f}", value);
  };
  std::string text = "# A run beside the paper's tables\n";
  for (const PaperProblem& problem : problems) {
    text += fmt::format("\n## Table {}: {}\n\nNoise ceiling {:.3f} N m.\n\n", problem.table,
                        problem.name, problem.ceiling_nm);
    text +=
        "| method | operators | MAE N m | over the seeds | complexity | paper's MAE | paper's "
        "complexity | seeds | failed | singular |\n"
        "|---|---|--:|---|--:|--:|--:|--:|--:|--:|\n";
    for (const PaperRow& row : problem.rows) {
      text += fmt::format(
          "| {} | {} | {} | {} to {} | {} | {} | {} | {} | {} | {} |\n", row.method, row.operators,
          number(row.mae_nm), number(row.low_nm), number(row.high_nm),
          std::isnan(row.complexity) ? std::string("-") : fmt::format("{:g}", row.complexity),
          number(row.paper_mae_nm),
          row.paper_complexity > 0 ? fmt::format("{}", row.paper_complexity) : std::string("-"),
          row.seeds, row.failed, row.singular);
    }
    if (!problem.remarks.empty()) text += '\n';
    for (const std::string& remark : problem.remarks) text += "- " + remark + "\n";
  }
  return text;
}

}  // namespace tribench
