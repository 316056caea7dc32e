// SPDX-License-Identifier: MIT
#include "harness/study/external_torque_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <tuple>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"
#include "foundation/order_statistics.hpp"
#include "problems/kuka/trials.hpp"
#include "reports/record/record_csv.hpp"

namespace tribench {
namespace {

using Friction = std::function<double(std::span<const double> point)>;

struct TrialError {
  double mae_nm = 0;
  double outside_share = 0;
  double mae_outside_nm = 0;
};

TrialError judge(const kuka::ExternalTorqueTrial& trial, const Friction& friction) {
  TrialError error;
  double outside = 0;
  const std::size_t rows = trial.rows.rows();
  for (std::size_t r = 0; r < rows; ++r) {
    std::vector<double> point;
    for (const auto& column : trial.rows.columns) point.push_back(column[r]);
    const double miss = std::abs(trial.rows.target[r] - friction(point) - trial.rows.truth[r]);
    error.mae_nm += miss / static_cast<double>(rows);
    if (trial.outside_fitted_range[r] != 0) {
      outside += 1;
      error.mae_outside_nm += miss;
    }
  }
  if (outside > 0) error.mae_outside_nm /= outside;
  error.outside_share = outside / static_cast<double>(rows);
  return error;
}

// Trials are made once a joint and seed.
class Trials {
 public:
  const kuka::ExternalTorqueTrial& at(int joint, std::uint64_t seed) {
    const auto [place, is_new] = trials_.try_emplace({joint, seed});
    if (is_new) {
      place->second = kuka::make_external_torque_trial(kuka::make_joint(joint, seed), seed);
    }
    return place->second;
  }
  const std::map<std::pair<int, std::uint64_t>, kuka::ExternalTorqueTrial>& all() const {
    return trials_;
  }

 private:
  std::map<std::pair<int, std::uint64_t>, kuka::ExternalTorqueTrial> trials_;
};

// Joint, model, problem, operator set.
using Key = std::tuple<int, std::string, std::string, std::string>;

ExternalTorqueFigure summarise(const Key& key, const std::vector<TrialError>& errors) {
  std::vector<double> mae;
  std::vector<double> outside;
  ExternalTorqueFigure figure;
  std::tie(figure.joint, figure.model, figure.problem, figure.operators) = key;
  for (const TrialError& error : errors) {
    mae.push_back(error.mae_nm);
    if (error.outside_share > 0) outside.push_back(error.mae_outside_nm);
    figure.outside_share += error.outside_share / static_cast<double>(errors.size());
  }
  figure.seeds = errors.size();
  figure.mae_nm = median(mae);
  std::tie(figure.low_nm, figure.high_nm) =
      std::pair(*std::ranges::min_element(mae), *std::ranges::max_element(mae));
  if (!outside.empty()) figure.mae_outside_nm = median(outside);
  return figure;
}

bool is_loaded_b(const Record& record) {
  return record.dataset == "B" && record.load && is_ok(record);
}

void add_yardsticks(const Trials& trials, std::map<Key, std::vector<TrialError>>& errors) {
  for (const auto& [place, trial] : trials.all()) {
    const auto& [number, seed] = place;
    const kuka::Joint joint = kuka::make_joint(number, seed);
    errors[{number, "(no friction model)", "", ""}].push_back(
        judge(trial, [](std::span<const double>) { return 0.0; }));
    errors[{number, "(true law and shift)", "", ""}].push_back(
        judge(trial, [&joint](std::span<const double> point) {
          return joint.law.at(point[0], point[2]) + joint.shift_at(point[0], point[2]);
        }));
  }
}

}  // namespace

std::vector<ExternalTorqueFigure> run_external_torque_study(const std::filesystem::path& run) {
  const std::vector<std::string> names = {"qd", "sgn_qd", "g", "sgn_g"};
  Trials trials;
  Evaluator evaluator;
  std::map<Key, std::vector<TrialError>> errors;
  read_results(run / "results.csv", [&](Record&& record) {
    if (!is_loaded_b(record)) return;
    const Expression formula = parse(record.formula, names);
    errors[{record.joint, record.method, record.problem, record.operators}].push_back(judge(
        trials.at(record.joint, record.seed),
        [&](std::span<const double> point) { return evaluator.evaluate_at(formula, point); }));
  });
  if (errors.empty()) {
    throw_bad_input("the run has no cell of B with load that ended well",
                    (run / "results.csv").string(), "run a grid with the problems B/*load");
  }
  add_yardsticks(trials, errors);
  std::vector<ExternalTorqueFigure> figures;
  for (const auto& [key, list] : errors) figures.push_back(summarise(key, list));
  std::ranges::stable_sort(figures, [](const auto& a, const auto& b) {
    return std::tie(a.joint, a.mae_nm) < std::tie(b.joint, b.mae_nm);
  });
  return figures;
}

std::string external_torque_markdown(const std::vector<ExternalTorqueFigure>& figures) {
  std::string text =
      "External torque in B with load, estimated with each friction model of the run.\n"
      "MAE in N m: median over the seeds and range; outside: rows whose load is beyond what the "
      "adaptation has seen.\n\n"
      "| joint | model | fitted as | operators | seeds | MAE | range | outside | MAE there |\n"
      "|--:|---|---|---|--:|--:|---|--:|--:|\n";
  for (const ExternalTorqueFigure& figure : figures) {
    text +=
        fmt::format("| {} | {} | {} | {} | {} | {:.3f} | {:.3f} to {:.3f} | {:.1f} % | {} |\n",
                    figure.joint, figure.model, figure.problem, figure.operators, figure.seeds,
                    figure.mae_nm, figure.low_nm, figure.high_nm, 100 * figure.outside_share,
                    figure.outside_share > 0 ? fmt::format("{:.3f}", figure.mae_outside_nm) : "-");
  }
  return text;
}

std::string external_torque_section(const std::filesystem::path& run) {
  try {
    return "\n## External torque\n\n" + external_torque_markdown(run_external_torque_study(run));
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::bad_input) throw;
    return {};
  }
}

}  // namespace tribench
