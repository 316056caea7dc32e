// SPDX-License-Identifier: MIT
#include "harness/study/reference_study.hpp"

#include <Eigen/Core>
#include <cmath>

#include "foundation/pivoted_qr.hpp"
#include "problems/measured/entries.hpp"
#include "problems/measured/manifest.hpp"

namespace tribench {
namespace {

constexpr double kTolerance_percent = 0.1;

// Columns of the EMPS problems: velocity, direction, acceleration.
struct Terms {
  double velocity;
  double direction;
  double acceleration;
};
using Design = Eigen::RowVectorXd (*)(const Terms&);

// M a + Fv v + Fc sign(v) + offset
Eigen::RowVectorXd symmetric(const Terms& x) {
  Eigen::RowVectorXd row(4);
  row << x.acceleration, x.velocity, x.direction, 1.0;
  return row;
}

// M a + Fv+ v + Fc+ forwards, M a + Fv- v - Fc- backwards; the decimated direction shares a row
// between the two where the axis turns.
Eigen::RowVectorXd asymmetric(const Terms& x) {
  const double speed = std::abs(x.velocity);
  Eigen::RowVectorXd row(5);
  row << x.acceleration, (x.velocity + speed) / 2, (x.velocity - speed) / 2, (x.direction + 1) / 2,
      (x.direction - 1) / 2;
  return row;
}

struct System {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd target;
};

void append(const Table& table, Design design, System& system) {
  const Eigen::Index before = system.target.size();
  const auto rows = static_cast<Eigen::Index>(table.rows());
  const Eigen::Index columns = design({}).size();
  system.matrix.conservativeResize(before + rows, columns);
  system.target.conservativeResize(before + rows);
  for (Eigen::Index r = 0; r < rows; ++r) {
    const auto i = static_cast<std::size_t>(r);
    system.matrix.row(before + r) =
        design({table.columns[0][i], table.columns[1][i], table.columns[2][i]});
    system.target[before + r] = table.target[i];
  }
}

ReferenceFigure measure(const measured::ProblemPlan& plan, const Problem& problem,
                        const std::string& model, double published) {
  const bool is_symmetric = model == "symmetric";
  const Design design = is_symmetric ? symmetric : asymmetric;
  System fitted;
  append(problem.stages.front().train, design, fitted);
  System judged;
  append(problem.test, design, judged);
  // Without a file of its own the test is part of the same file: published on the whole of it.
  if (plan.test_file.empty()) {
    append(problem.test, design, fitted);
    judged = fitted;
  }
  const Eigen::VectorXd coefficients = PivotedQr(fitted.matrix).solve(fitted.target);
  ReferenceFigure figure;
  figure.problem = plan.name;
  figure.model = model;
  figure.summary = is_symmetric ? "M a + Fv v + Fc s + offset" : "M a + Fv+- v + Fc+- s";
  figure.published = published;
  figure.ours = 100 * (judged.matrix * coefficients - judged.target).norm() / judged.target.norm();
  figure.rows = static_cast<std::size_t>(judged.target.size());
  figure.within = std::abs(figure.ours - published) <= kTolerance_percent;
  return figure;
}

}  // namespace

std::vector<ReferenceFigure> run_reference_study(const std::optional<std::filesystem::path>& data) {
  std::vector<ReferenceFigure> figures;
  const measured::Manifest& emps = measured::find_manifest(measured::shipped_manifests(), "emps");
  for (const measured::ProblemPlan& plan : emps.problems) {
    const Problem problem = measured::make_measured_problem(emps, plan, data, 1);
    for (const auto& [model, published] : plan.published_percent) {
      figures.push_back(measure(plan, problem, model, published));
    }
  }
  return figures;
}

}  // namespace tribench
