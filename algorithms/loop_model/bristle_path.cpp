// SPDX-License-Identifier: MIT
#include "algorithms/loop_model/bristle_path.hpp"

#include <algorithm>
#include <cmath>

#include "foundation/elementary.hpp"
#include "foundation/sign.hpp"

namespace tribench::loop {
namespace {

double moved(BristleLaw law, double z, double sliding, double way) {
  if (way == 0) return z;
  if (law == BristleLaw::maxwell_slip) return std::clamp(z + way, -sliding, sliding);
  const double end = way > 0 ? sliding : -sliding;
  return end + (z - end) * elementary::exp(-std::abs(way) / sliding);
}

}  // namespace

std::vector<PathStep> path_of(const Observations& data) {
  const std::vector<double>& v = data.find("v")->values;
  const std::vector<double>& d = data.find("d")->values;
  const Signal* q = data.find("q");
  std::vector<PathStep> path(data.rows());
  for (std::size_t i = 0; i < path.size(); ++i) {
    PathStep& step = path[i];
    step.sign = sign(v[i]);
    step.starts = i == 0 || data.movement[i] != data.movement[i - 1];
    if (step.sign == 0 && !step.starts) step.sign = path[i - 1].sign;
    const bool turned = step.starts || step.sign != path[i - 1].sign || d[i] < d[i - 1];
    if (!turned) {
      const double way =
          q != nullptr ? step.sign * (q->values[i] - q->values[i - 1]) : d[i] - d[i - 1];
      step.on = step.sign * std::max(0.0, way);
      continue;
    }
    step.on = step.sign * d[i];
    if (step.starts || q == nullptr) continue;
    const double turning_point = q->values[i] - step.on;
    step.back = -step.sign * std::max(0.0, step.sign * (q->values[i - 1] - turning_point));
  }
  return path;
}

Eigen::VectorXd deflection(BristleLaw law, BristleStart start, double sliding,
                           const std::vector<PathStep>& path) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(path.size()));
  double z = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const PathStep& step = path[i];
    if (step.starts && start == BristleStart::relaxed) z = 0;
    if (step.starts && start == BristleStart::bent) z = step.sign * sliding;
    z = moved(law, moved(law, z, sliding, step.back), sliding, step.on);
    out[static_cast<Eigen::Index>(i)] = z;
  }
  return out;
}

Eigen::VectorXd deflection_rate(const Eigen::VectorXd& z, double sliding,
                                const Observations& data) {
  const Eigen::VectorXd v =
      Eigen::Map<const Eigen::VectorXd>(data.find("v")->values.data(), z.size());
  return v - v.cwiseAbs().cwiseProduct(z) / sliding;
}

}  // namespace tribench::loop
