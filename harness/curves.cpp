// SPDX-License-Identifier: MIT
#include "harness/curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"
#include "algorithms/states/state_text.hpp"
#include "foundation/error.hpp"
#include "foundation/order_statistics.hpp"
#include "foundation/output_file.hpp"
#include "foundation/sign.hpp"
#include "harness/category_fit.hpp"
#include "problems/kuka/trials.hpp"
#include "reports/record/record_csv.hpp"

namespace tribench {
namespace {

constexpr int kFrictionPoints = 42;  // even: 0, where friction jumps, is left out
constexpr std::size_t kErrorPoints = 60;
constexpr std::size_t kProfileStep = 10;  // of the profile's 1001 rows

// Which formula, in whose name.
struct Drawn {
  std::string cell;  // these three are empty for the true law
  std::string method;
  std::string operators;
  Expression formula;
};

// Points of one problem's pictures.
class Sampler {
 public:
  Sampler(const Problem& problem, std::vector<CurveRecord>& points)
      : problem_(problem), points_(points) {
    for (std::size_t j = 0; j < problem.inputs.size(); ++j) {
      const Role role = problem.inputs[j].role;
      if (role == Role::velocity && !has_velocity_) {
        velocity_ = j;
        has_velocity_ = true;
      }
      if (role == Role::gravity_torque && !gravity_) gravity_ = j;
      centre_.push_back(median(problem.test.columns[j]));
    }
  }

  void add_friction(const Drawn& drawn) {
    if (!has_velocity_) return;
    const Input& velocity = problem_.inputs[velocity_];
    for (const double part :
         gravity_ ? std::vector<double>{-0.5, 0.02, 0.5} : std::vector<double>{0}) {
      std::vector<double> point = centre_;
      std::string curve = drawn.cell.empty() ? "true law" : "friction";
      if (gravity_) {
        const Input& gravity = problem_.inputs[*gravity_];
        point[*gravity_] = part * std::max(-gravity.low, gravity.high);
        const std::string level =
            fmt::format("{} = {:.3g} {}", gravity.name, point[*gravity_], gravity.unit);
        curve = drawn.cell.empty() ? "true law, " + level : level;
      }
      for (int i = 0; i < kFrictionPoints; ++i) {
        point[velocity_] =
            velocity.low + (velocity.high - velocity.low) * i / (kFrictionPoints - 1);
        add(drawn, "friction", curve, axis(velocity), point[velocity_], value_at(drawn, point));
      }
    }
  }

  void add_measured() {
    if (!has_velocity_) return;
    for (const std::size_t r : thinned_rows()) {
      add({}, "friction", "measured", axis(problem_.inputs[velocity_]),
          problem_.test.columns[velocity_][r], problem_.test.target[r]);
    }
  }

  void add_error(const Drawn& drawn) {
    if (!has_velocity_) return;
    for (const std::size_t r : thinned_rows()) {
      std::vector<double> point;
      for (const auto& column : problem_.test.columns) point.push_back(column[r]);
      const double value = evaluator_.evaluate_at(drawn.formula, point);
      add(drawn, "error", "measured rows", axis(problem_.inputs[velocity_]), point[velocity_],
          value - problem_.test.target[r]);
    }
  }

  // For problems whose inputs are the profile's first columns.
  void add_profile(const Drawn& drawn, const kuka::VelocityProfile& profile) {
    for (std::size_t r = 0; r < profile.time_s.size(); r += kProfileStep) {
      std::vector<double> point;
      for (std::size_t j = 0; j < problem_.inputs.size(); ++j) {
        point.push_back(profile.rows.columns[j][r]);
      }
      add(drawn, "profile", drawn.cell.empty() ? "true law" : "prediction", "time in s",
          profile.time_s[r], evaluator_.evaluate_at(drawn.formula, point));
    }
  }

 private:
  static std::string axis(const Input& input) {
    return fmt::format("{} in {}", input.name, input.unit);
  }

  // Signs follow what they are the signs of.
  double value_at(const Drawn& drawn, std::vector<double> point) {
    for (std::size_t j = 0; j < point.size(); ++j) {
      const Input& input = problem_.inputs[j];
      if (input.sign_of) point[j] = sign(point[*input.sign_of]);
      if (!input.sign_of && input.role == Role::velocity_sign) point[j] = sign(point[velocity_]);
    }
    return evaluator_.evaluate_at(drawn.formula, point);
  }

  std::vector<std::size_t> thinned_rows() const {
    std::vector<std::size_t> rows;
    const std::size_t count = std::min(kErrorPoints, problem_.test.rows());
    for (std::size_t i = 0; i < count; ++i) rows.push_back(i * problem_.test.rows() / count);
    return rows;
  }

  void add(const Drawn& drawn, const char* picture, const std::string& curve, std::string x_name,
           double x, double y) {
    if (!std::isfinite(y)) return;
    points_.push_back({drawn.cell, problem_.name, drawn.method, drawn.operators, picture, curve,
                       std::move(x_name),
                       fmt::format("{} in {}", problem_.target, problem_.target_unit), x, y});
  }

  const Problem& problem_;
  std::vector<CurveRecord>& points_;
  Evaluator evaluator_;
  std::size_t velocity_ = 0;
  bool has_velocity_ = false;
  std::optional<std::size_t> gravity_;
  std::vector<double> centre_;
};

// By problem, then method and operator set: the record with the lower median of the test error.
using Chosen = std::map<std::string, std::vector<const Record*>>;

Chosen choose(const std::vector<Record>& records) {
  std::map<std::tuple<std::string, std::string, std::string>, std::vector<const Record*>> groups;
  for (const Record& record : records) {
    if (!is_ok(record) || !std::isfinite(record.mae_test)) continue;
    groups[{record.problem, record.method, record.operators}].push_back(&record);
  }
  Chosen chosen;
  for (auto& [key, group] : groups) {
    std::ranges::sort(group, [](const Record* a, const Record* b) {
      return std::tie(a->mae_test, a->seed) < std::tie(b->mae_test, b->seed);
    });
    chosen[std::get<0>(key)].push_back(group[(group.size() - 1) / 2]);
  }
  return chosen;
}

bool has_profile(const Problem& problem) {
  return (problem.dataset == "A" || problem.dataset == "B") &&
         (problem.inputs.size() == 2 || problem.inputs.size() == 4);
}

void sample_problem(const ProblemEntry& entry, const std::vector<const Record*>& records,
                    std::vector<CurveRecord>& points) {
  std::map<std::uint64_t, Problem> by_seed;
  const auto problem_of = [&](std::uint64_t seed) -> const Problem& {
    const auto [place, is_new] = by_seed.try_emplace(seed);
    if (is_new) place->second = entry.make(seed);
    return place->second;
  };
  const Problem& first = problem_of(records.front()->seed);
  std::optional<kuka::VelocityProfile> profile;
  if (has_profile(first)) {
    profile = kuka::make_velocity_profile(kuka::make_joint(first.joint, records.front()->seed));
  }
  const auto sample = [&](const Problem& problem, const Drawn& drawn) {
    Sampler sampler(problem, points);
    sampler.add_friction(drawn);
    if (!drawn.cell.empty()) sampler.add_error(drawn);
    if (profile) sampler.add_profile(drawn, *profile);
  };
  Sampler(first, points).add_measured();
  if (const std::string law = first.true_law(); !law.empty()) {
    sample(first, {{}, {}, {}, parse(law, first.input_names())});
  }
  for (const Record* record : records) {
    // No function of one row's inputs.
    if (declares_states(record->formula) || has_categories(record->formula)) continue;
    const Problem& problem = problem_of(record->seed);
    sample(problem, {record->cell, record->method, record->operators,
                     parse(record->formula, problem.input_names())});
  }
}

}  // namespace

Curves sample_curves(const std::vector<Record>& records, const Catalogue& catalogue) {
  Curves curves;
  for (const auto& [problem, chosen] : choose(records)) {
    try {
      sample_problem(catalogue.find(problem), chosen, curves.points);
    } catch (const Error& error) {
      // The run's figures stand without its pictures: measured data may have gone since.
      if (error.kind() != ErrorKind::bad_input) throw;
      curves.not_here.emplace(problem, error.what());
    }
  }
  return curves;
}

std::vector<std::string> write_curves(const std::filesystem::path& folder,
                                      const std::vector<CellResult>& results,
                                      const Catalogue& catalogue) {
  std::vector<Record> records;
  for (const CellResult& result : results) records.push_back(result.record);
  Curves curves = sample_curves(records, catalogue);
  const std::filesystem::path file = folder / "curves.csv";
  std::map<std::string, std::size_t> kept;
  if (!curves.not_here.empty() && std::filesystem::exists(file)) {
    read_curves(file, [&](CurveRecord&& point) {
      if (!curves.not_here.contains(point.problem)) return;
      ++kept[point.problem];
      curves.points.push_back(std::move(point));
    });
  }
  write_file(file, curves_csv(curves.points));
  std::vector<std::string> lines;
  for (const auto& [problem, why] : curves.not_here) {
    lines.push_back(fmt::format("the pictures of {} {}: {}", problem,
                                kept.contains(problem) ? "are those of the run" : "are missing",
                                why));
  }
  return lines;
}

}  // namespace tribench
