// SPDX-License-Identifier: MIT
#include "harness/loop/loop_series.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "algorithms/loop_model/smoothers.hpp"
#include "foundation/order_statistics.hpp"

namespace tribench::loop {
namespace {

constexpr double kNormalQuantile = 1.959964;  // of 97.5 %
constexpr std::size_t kResidualRows = 1500;

Eigen::VectorXd base_prediction(const LoopModel& model, const Observations& data) {
  LoopModel base = model;
  while (!base.atoms.empty()) base.remove(base.atoms.size() - 1);
  return predict(base, data);
}

// What the base has of a rigid body: all that is gone where its rigid signals and the acceleration
// are 0. 0 where there are none, or where it is not finite.
Eigen::VectorXd rigid_part(const LoopModel& model, const Observations& data) {
  Observations still = data;
  bool any = false;
  for (Signal& signal : still.signals) {
    const bool rigid = std::ranges::count(data.rigid, signal.name) > 0;
    if (!rigid && signal.role != Role::acceleration) continue;
    std::ranges::fill(signal.values, 0.0);
    any = true;
  }
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(data.rows()));
  if (!any) return zero;
  const Eigen::VectorXd part = base_prediction(model, data) - base_prediction(model, still);
  return part.allFinite() ? part : zero;
}

LoopResidualRows residual_rows(const LoopRows& all) {
  LoopResidualRows out;
  std::vector<std::size_t> rows;
  const std::size_t step = (all.data.rows() + kResidualRows - 1) / kResidualRows;
  for (std::size_t i = 0; i < all.data.rows(); i += step) {
    const bool burst = i < all.diagnosis.masked.size() && all.diagnosis.masked[i] != 0;
    if (!burst) rows.push_back(i);
  }
  const auto some = [&](const Eigen::VectorXd& values) {
    std::vector<double> picked;
    for (const std::size_t i : rows) picked.push_back(values[static_cast<Eigen::Index>(i)]);
    return picked;
  };
  const Eigen::VectorXd y = target_vector(all.data);
  out.before = some(y - all.before);
  out.after = some(y - all.after);
  out.effect = some(all.after - all.before);
  for (const EffectFinding& effect : all.diagnosis.effects) {
    out.effects.push_back({effect.family, some(effect_share(all, effect).value)});
  }
  for (const Signal& signal : all.data.signals) {
    if (!worth_a_look(signal)) continue;
    const Eigen::Map<const Eigen::VectorXd> x(signal.values.data(), y.size());
    out.channels.push_back({input_name(all.data, signal.name), signal.unit, some(x)});
  }
  return out;
}

// Where every movement (or piece of one) was left out in turn, its error then; else
// the errors of the models as they stand.
std::vector<LoopMovementPoint> movement_points(const LoopRows& all) {
  const JudgedDiagnosis& diagnosis = all.diagnosis;
  std::vector<LoopMovementPoint> points;
  if (diagnosis.held_out.empty() && !diagnosis.error.movements.empty()) {
    const bool pieces = diagnosis.error.judged_on == JudgedOn::pieces_of_movements;
    for (const MovementError& one : diagnosis.error.movements) {
      const auto m = static_cast<std::size_t>(one.movement);
      points.push_back({pieces ? "piece " + std::to_string(m + 1) : all.data.movement_names[m],
                        true, one.before, one.after});
    }
    return points;
  }
  const Eigen::VectorXd y = target_vector(all.data);
  const Eigen::VectorXd before = (y - all.before).cwiseAbs();
  const Eigen::VectorXd after = (y - all.after).cwiseAbs();
  for (std::size_t i = 0; i < all.data.rows();) {
    const int movement = all.data.movement[i];
    std::size_t end = i;
    while (end < all.data.rows() && all.data.movement[end] == movement) ++end;
    const auto begin = static_cast<Eigen::Index>(i);
    const auto size = static_cast<Eigen::Index>(end - i);
    points.push_back({all.data.movement_names[static_cast<std::size_t>(movement)],
                      std::ranges::binary_search(diagnosis.held_out, movement),
                      before.segment(begin, size).mean(), after.segment(begin, size).mean()});
    i = end;
  }
  return points;
}

LoopAliasMap alias_map(const AliasMap& map) {
  LoopAliasMap out{map.families, {}};
  for (Eigen::Index i = 0; i < map.correlation.rows(); ++i) {
    std::vector<double> row;
    for (Eigen::Index j = 0; j < map.correlation.cols(); ++j) row.push_back(map.correlation(i, j));
    out.correlation.push_back(std::move(row));
  }
  return out;
}

}  // namespace

LoopRows loop_rows(const JudgedDiagnosis& diagnosis, const Observations& data) {
  LoopRows all{diagnosis,
               data,
               {},
               predict(diagnosis.before, data),
               predict(diagnosis.after, data),
               rigid_part(diagnosis.after, data)};
  all.has_rigid = !all.rigid.isZero();
  all.rows_of_noise = std::max(1.0, diagnosis.correlation_rows);
  for (std::size_t i = 0; i < data.rows(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const bool burst = i < diagnosis.masked.size() && diagnosis.masked[i] != 0;
    if (!burst && std::isfinite(all.before[row]) && std::isfinite(all.after[row])) {
      all.rows.push_back(i);
    }
  }
  return all;
}

Eigen::VectorXd direction(const Observations& data) {
  const auto n = static_cast<Eigen::Index>(data.rows());
  const Signal* v = data.find("v");
  if (v == nullptr) return Eigen::VectorXd::Ones(n);
  return Eigen::Map<const Eigen::VectorXd>(v->values.data(), n).unaryExpr([](double x) {
    return x < 0 ? -1.0 : 1.0;
  });
}

EffectShare effect_share(const LoopRows& all, const EffectFinding& effect) {
  const LoopModel& model = all.diagnosis.after;
  const auto n = static_cast<Eigen::Index>(all.data.rows());
  EffectShare share{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  std::size_t parameter = 0;  // coefficients and shapes, atom by atom
  for (std::size_t k = 0; k < model.atoms.size(); ++k) {
    const Atom& atom = model.atoms[k];
    if (all.diagnosis.families[atom.family].name != effect.family) continue;
    const Eigen::MatrixXd columns = evaluate_columns(atom.columns, all.data);
    for (Eigen::Index c = 0; c < columns.cols(); ++c, ++parameter) {
      const auto j = static_cast<Eigen::Index>(model.first_column(k)) + c;
      share.value += columns.col(c) * model.coefficients[j];
      if (parameter >= effect.parameters.size()) continue;
      const ParameterFinding& p = effect.parameters[parameter];
      share.half += (columns.col(c) * ((p.high - p.low) / 2)).cwiseAbs2();
    }
    parameter += atom.shapes.size();
  }
  share.half = share.half.cwiseSqrt();
  return share;
}

double friction_rms(const LoopRows& all) {
  double sum = 0;
  for (const std::size_t i : all.rows) {
    const double y = all.data.target[i] - all.rigid[static_cast<Eigen::Index>(i)];
    sum += y * y;
  }
  return all.rows.empty() ? kNoFigure : std::sqrt(sum / static_cast<double>(all.rows.size()));
}

bool worth_a_look(const Signal& signal) {
  return !signal.name.starts_with("sgn_") && signal.name != "a2" && !signal.is_variant();
}

LoopAxis axis_of(const Observations& data, std::string_view signal) {
  const Signal* found = data.find(signal);
  return {input_name(data, signal), found == nullptr ? "" : found->unit};
}

Bins equal_counts(std::vector<std::size_t> rows, const Eigen::VectorXd& x, std::size_t most,
                  std::size_t fewest) {
  Bins bins;
  if (rows.size() < fewest) return bins;
  std::ranges::stable_sort(rows, {},
                           [&](std::size_t i) { return x[static_cast<Eigen::Index>(i)]; });
  const std::size_t wanted = std::clamp<std::size_t>(rows.size() / fewest, 1, most);
  std::size_t begin = 0;
  for (std::size_t b = 0; b < wanted && begin < rows.size(); ++b) {
    std::size_t end = std::max(begin + 1, rows.size() * (b + 1) / wanted);
    while (end < rows.size() &&
           x[static_cast<Eigen::Index>(rows[end])] == x[static_cast<Eigen::Index>(rows[end - 1])]) {
      ++end;
    }
    if (end - begin >= fewest) {
      bins.rows.emplace_back(rows.begin() + static_cast<std::ptrdiff_t>(begin),
                             rows.begin() + static_cast<std::ptrdiff_t>(end));
      begin = end;
    }
  }
  return bins;
}

Bins equal_widths(const std::vector<std::size_t>& rows, const Eigen::VectorXd& x, std::size_t most,
                  std::size_t fewest) {
  Bins bins;
  if (rows.empty()) return bins;
  double low = x[static_cast<Eigen::Index>(rows[0])];
  double high = low;
  for (const std::size_t i : rows) {
    low = std::min(low, x[static_cast<Eigen::Index>(i)]);
    high = std::max(high, x[static_cast<Eigen::Index>(i)]);
  }
  if (!(high > low)) return bins;
  bins.rows.resize(most);
  for (const std::size_t i : rows) {
    const double place = (x[static_cast<Eigen::Index>(i)] - low) / (high - low);
    const auto bin = static_cast<std::size_t>(place * static_cast<double>(most));
    bins.rows[std::min(bin, most - 1)].push_back(i);
  }
  std::erase_if(bins.rows, [&](const auto& bin) { return bin.size() < fewest; });
  return bins;
}

std::vector<double> means(const Bins& bins, const Eigen::VectorXd& values) {
  std::vector<double> out;
  for (const auto& rows : bins.rows) {
    double sum = 0;
    for (const std::size_t i : rows) sum += values[static_cast<Eigen::Index>(i)];
    out.push_back(sum / static_cast<double>(rows.size()));
  }
  return out;
}

std::vector<double> deviations(const Bins& bins, const Eigen::VectorXd& values) {
  const std::vector<double> mean = means(bins, values);
  std::vector<double> out;
  for (std::size_t b = 0; b < bins.rows.size(); ++b) {
    double sum = 0;
    for (const std::size_t i : bins.rows[b]) {
      const double off = values[static_cast<Eigen::Index>(i)] - mean[b];
      sum += off * off;
    }
    const auto n = static_cast<double>(bins.rows[b].size());
    out.push_back(std::sqrt(sum / std::max(1.0, n - 1)));
  }
  return out;
}

std::vector<double> counts(const Bins& bins) {
  std::vector<double> out;
  for (const auto& rows : bins.rows) out.push_back(static_cast<double>(rows.size()));
  return out;
}

std::vector<double> mean_errors(const Bins& bins, const Eigen::VectorXd& values,
                                double rows_of_noise) {
  std::vector<double> out = deviations(bins, values);
  for (std::size_t b = 0; b < out.size(); ++b) {
    const auto n = static_cast<double>(bins.rows[b].size());
    out[b] *= kNormalQuantile * std::sqrt(std::min(rows_of_noise, n) / n);
  }
  return out;
}

void add_series(LoopRecord& record, const JudgedDiagnosis& diagnosis, const Observations& data) {
  const LoopRows all = loop_rows(diagnosis, data);
  record.friction_rms = friction_rms(all);
  LoopPictures& pictures = record.pictures;
  pictures.friction = friction_picture(all);
  for (const EffectFinding& effect : diagnosis.effects) {
    pictures.effects.push_back(effect_picture(all, effect));
  }
  pictures.inputs = input_pictures(all);
  pictures.maps = leftover_maps(all);
  pictures.traces = traces(all);
  pictures.movements = movement_points(all);
  pictures.aliases = alias_map(diagnosis.alias_map);
  pictures.residuals = residual_rows(all);
}

}  // namespace tribench::loop
