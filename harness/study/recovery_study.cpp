// SPDX-License-Identifier: MIT
#include "harness/study/recovery_study.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "foundation/error.hpp"
#include "foundation/order_statistics.hpp"
#include "reports/record/record_csv.hpp"

namespace tribench {
namespace {

constexpr double kExactNmse = 1e-12;

struct Cells {
  std::uint64_t recovered = 0;
  std::vector<double> cpu_s;
};

// "nguyen/10" -> 10
int number_of(const std::string& problem) {
  return std::stoi(problem.substr(problem.find('/') + 1));
}

}  // namespace

bool is_recovered(const Record& record) { return is_ok(record) && 1 - record.r2_test < kExactNmse; }

std::vector<RecoveryFigure> run_recovery_study(const std::filesystem::path& run) {
  std::map<std::tuple<std::string, std::string, int>, Cells> cells;
  read_results(run / "results.csv", [&cells](Record&& record) {
    if (record.dataset != "nguyen") return;
    Cells& each = cells[{record.method, record.operators, number_of(record.problem)}];
    each.recovered += is_recovered(record) ? 1 : 0;
    each.cpu_s.push_back(record.fit_cpu_s);
  });
  if (cells.empty()) {
    throw_bad_input("the run has no problem of the Nguyen set", run.string(),
                    "make one with: tribench run grids/nguyen.toml --out DIR");
  }
  std::vector<RecoveryFigure> figures;
  for (auto& [key, each] : cells) {
    const auto& [method, operators, number] = key;
    const std::uint64_t runs = each.cpu_s.size();
    std::erase_if(each.cpu_s, [](double seconds) { return !(seconds >= 0); });
    figures.push_back({"nguyen/" + std::to_string(number), method, operators, each.recovered, runs,
                       median(std::move(each.cpu_s))});
  }
  return figures;
}

}  // namespace tribench
